//! The true answers of queries: all triangles, one by one, in f64, at the positions that f32 skinning gives.

use glam::DVec3;

pub(crate) type Corners = [DVec3; 3];

/// All triangles of a posed skin, in world space.
pub(crate) struct Truth(pub(crate) Vec<Corners>);

impl Truth {
    /// Distance along a ray to the first triangle, from either side.
    pub(crate) fn ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<f64> {
        let met = self.0.iter().filter_map(|t| ray(origin, direction, t));
        let nearest = met.fold(f64::INFINITY, f64::min);
        (nearest <= max_distance).then_some(nearest)
    }

    /// Distance of the nearest point.
    pub(crate) fn distance(&self, point: DVec3) -> f64 {
        let distances = self.0.iter().map(|t| closest(point, t).distance(point));
        distances.fold(f64::INFINITY, f64::min)
    }

    /// Number of triangles that surely touch a sphere, and of those so near its border, within `unsure`, that f32 may
    /// not tell.
    pub(crate) fn within(&self, center: DVec3, radius: f64, unsure: f64) -> [usize; 2] {
        let mut counts = [0; 2];
        for triangle in &self.0 {
            let distance = closest(center, triangle).distance(center);
            if (distance - radius).abs() <= unsure {
                counts[1] += 1;
            } else if distance < radius {
                counts[0] += 1;
            }
        }
        counts
    }

    /// The share of its motion that a sphere makes until it touches; `None` if it does not touch.
    pub(crate) fn cast(&self, center: DVec3, radius: f64, motion: DVec3) -> Option<f64> {
        let low = center.min(center + motion) - DVec3::splat(radius);
        let high = center.max(center + motion) + DVec3::splat(radius);
        let near = self.0.iter().filter(|[a, b, c]| {
            let apart = a.min(*b).min(*c).cmpgt(high) | a.max(*b).max(*c).cmplt(low);
            !apart.any()
        });
        let times = near.filter_map(|triangle| touch(center, radius, motion, triangle));
        let first = times.fold(f64::INFINITY, f64::min);
        (first <= 1.0).then_some(first)
    }
}

/// Distance along a ray to a triangle (Möller and Trumbore 1997).
fn ray(origin: DVec3, direction: DVec3, &[a, b, c]: &Corners) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(ac);
    let determinant = ab.dot(across);
    if determinant == 0.0 {
        return None;
    }
    let from = origin - a;
    let u = from.dot(across) / determinant;
    let along = from.cross(ab);
    let v = direction.dot(along) / determinant;
    let t = ac.dot(along) / determinant;
    // Wider by more than f64 rounds, so that no ray slips through an edge.
    const EDGE: f64 = 1e-12;
    (u >= -EDGE && v >= -EDGE && u + v <= 1.0 + EDGE && t >= 0.0).then_some(t)
}

/// The point of a triangle closest to `p`: inside, or on the nearest edge.
fn closest(p: DVec3, &[a, b, c]: &Corners) -> DVec3 {
    let normal = (b - a).cross(c - a);
    let area = normal.length_squared();
    if area > 0.0 {
        let weight = |from: DVec3, to: DVec3| (to - from).cross(p - from).dot(normal);
        let weights = [weight(b, c), weight(c, a), weight(a, b)];
        if weights.iter().all(|weight| *weight >= 0.0) {
            return p - normal * ((p - a).dot(normal) / area);
        }
    }
    let on_edges = [(a, b), (b, c), (c, a)].map(|(from, to)| on_segment(p, from, to));
    let nearer = |x: DVec3, y: DVec3| {
        if y.distance_squared(p) < x.distance_squared(p) {
            y
        } else {
            x
        }
    };
    on_edges.into_iter().reduce(nearer).unwrap_or(a)
}

fn on_segment(p: DVec3, from: DVec3, to: DVec3) -> DVec3 {
    let along = to - from;
    let length = along.length_squared();
    if length == 0.0 {
        return from;
    }
    from + along * ((p - from).dot(along) / length).clamp(0.0, 1.0)
}

/// The time at which a moving sphere touches a triangle: its face, an edge or a corner, each in closed form.
fn touch(center: DVec3, radius: f64, motion: DVec3, triangle: &Corners) -> Option<f64> {
    if closest(center, triangle).distance(center) <= radius {
        return Some(0.0);
    }
    let [a, b, c] = *triangle;
    let mut first = f64::INFINITY;
    if let Some(normal) = (b - a).cross(c - a).try_normalize() {
        let height = (center - a).dot(normal);
        let closing = -motion.dot(normal) * height.signum();
        let time = (height.abs() - radius) / closing;
        if closing > 0.0 && time >= 0.0 {
            let foot = center + motion * time - normal * (radius * height.signum());
            if closest(foot, triangle).distance(foot) <= 1e-9 * (1.0 + foot.length()) {
                first = time;
            }
        }
    }
    for (from, to) in [(a, b), (b, c), (c, a)] {
        first = first.min(touch_edge(center, radius, motion, from, to));
    }
    for corner in triangle {
        let to = center - *corner;
        first = first.min(root(
            motion.length_squared(),
            to.dot(motion),
            to.length_squared() - radius * radius,
        ));
    }
    first.is_finite().then_some(first)
}

/// The time at which a moving sphere touches an edge between the edge's ends; infinite if never.
fn touch_edge(center: DVec3, radius: f64, motion: DVec3, from: DVec3, to: DVec3) -> f64 {
    let Some(along) = (to - from).try_normalize() else {
        return f64::INFINITY;
    };
    let across = |v: DVec3| v - along * v.dot(along);
    let (start, way) = (across(center - from), across(motion));
    let constant = start.length_squared() - radius * radius;
    let time = root(way.length_squared(), start.dot(way), constant);
    let at = (center + motion * time - from).dot(along);
    if (0.0..=(to - from).length()).contains(&at) {
        time
    } else {
        f64::INFINITY
    }
}

/// The first time at which `a t^2 + 2 b t + c` falls to 0; infinite if never.
fn root(a: f64, b: f64, c: f64) -> f64 {
    let discriminant = b * b - a * c;
    if b >= 0.0 || discriminant < 0.0 || c < 0.0 {
        return f64::INFINITY;
    }
    c / (-b + discriminant.sqrt())
}
