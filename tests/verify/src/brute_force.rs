//! Queries that test triangles one by one in f64, in closed form: an independent reference for other implementations.
//! Where rounding decides the answer, it is no more exact than they are; see `exact` for such cases.
//!
//! ```
//! use clamber_verify::brute_force::Triangles;
//! use clamber_verify::glam::DVec3;
//!
//! let one = Triangles(vec![[DVec3::ZERO, DVec3::X, DVec3::Z]]);
//! let above = DVec3::new(0.25, 2.0, 0.25);
//! assert_eq!(one.distance(above), 2.0);
//! assert_eq!(one.cast_ray(above, DVec3::NEG_Y, 5.0), Some(2.0));
//! // A ball of 0.5 m that falls by 3 m touches after 1.5 m.
//! assert_eq!(one.cast_sphere(above, 0.5, DVec3::Y * -3.0), Some(0.5));
//! ```

use glam::DVec3;

/// The corners of a triangle.
pub type Corners = [DVec3; 3];

/// A ray that passes outside an edge still hits the triangle if the barycentric coordinate of its crossing is less than
/// this below 0. It is larger than the rounding of f64, so that no ray slips through an edge.
const EDGE: f64 = 1e-12;

/// Triangles that are queried together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles(pub Vec<Corners>);

impl Triangles {
    /// Distance along a ray to the first triangle, from either side. `direction` has length 1.
    pub fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<f64> {
        let all = self.0.iter();
        let met = all.filter_map(|corners| ray(origin, direction, corners));
        let met = met.filter(|crossing| crossing.border >= -EDGE && crossing.distance >= 0.0);
        let nearest = met.fold(f64::INFINITY, |nearest, met| nearest.min(met.distance));
        (nearest <= max_distance).then_some(nearest)
    }

    /// Distance of a point from the nearest triangle; infinite without triangles.
    pub fn distance(&self, point: DVec3) -> f64 {
        let distances = self.0.iter().map(|corners| distance(point, corners));
        distances.fold(f64::INFINITY, f64::min)
    }

    /// Distance of a segment from the nearest triangle; infinite without triangles.
    pub fn segment_distance(&self, ends: [DVec3; 2]) -> f64 {
        let distances = self.0.iter().map(|corners| segment_distance(ends, corners));
        distances.fold(f64::INFINITY, f64::min)
    }

    /// Two numbers of triangles: those that certainly touch a ball, and those for which rounding decides, since
    /// distance and radius differ by at most `unsure`.
    pub fn within(&self, center: DVec3, radius: f64, unsure: f64) -> [usize; 2] {
        let mut counts = [0; 2];
        for corners in &self.0 {
            let distance = distance(center, corners);
            if (distance - radius).abs() <= unsure {
                counts[1] += 1;
            } else if distance < radius {
                counts[0] += 1;
            }
        }
        counts
    }

    /// The share of a sphere's motion until it touches a triangle, 0 to 1: 0 if it touches one at the start, `None` if
    /// it touches none. All lengths are in the unit of the corners.
    pub fn cast_sphere(&self, center: DVec3, radius: f64, motion: DVec3) -> Option<f64> {
        let low = center.min(center + motion) - DVec3::splat(radius);
        let high = center.max(center + motion) + DVec3::splat(radius);
        let near = self.0.iter().filter(|[a, b, c]| {
            let apart = a.min(*b).min(*c).cmpgt(high) | a.max(*b).max(*c).cmplt(low);
            !apart.any()
        });
        let times = near.filter_map(|corners| touch(center, radius, motion, corners));
        let first = times.fold(f64::INFINITY, f64::min);
        (first <= 1.0).then_some(first)
    }
}

/// The point at which a ray's line crosses the plane of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Distance along the ray; negative behind its origin.
    pub distance: f64,
    /// The smallest barycentric coordinate: negative outside the triangle.
    pub border: f64,
}

/// The point at which a ray's line crosses the plane of a triangle (Möller and Trumbore 1997); `None` if they are
/// parallel. `direction` has length 1.
pub fn ray(origin: DVec3, direction: DVec3, &[a, b, c]: &Corners) -> Option<Crossing> {
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
    Some(Crossing {
        distance: ac.dot(along) / determinant,
        border: u.min(v).min(1.0 - u - v),
    })
}

/// The point of a triangle that is nearest to `p`. The triangle may have collapsed.
pub fn closest_point(p: DVec3, &[a, b, c]: &Corners) -> DVec3 {
    let sides = [[a, b], [b, c], [c, a]].map(|side| on_segment(p, side));
    let nearer = |x: DVec3, y: DVec3| {
        if y.distance_squared(p) < x.distance_squared(p) {
            y
        } else {
            x
        }
    };
    let best = sides.into_iter().fold(a, nearer);
    let normal = (b - a).cross(c - a);
    let area_sq = normal.length_squared();
    if area_sq > 0.0 {
        let weight = |from: DVec3, to: DVec3| (to - from).cross(p - from).dot(normal) / area_sq;
        let [u, v] = [weight(b, c), weight(c, a)];
        if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
            return nearer(best, a * u + b * v + c * (1.0 - u - v));
        }
    }
    best
}

/// Distance of a point from a triangle.
pub fn distance(p: DVec3, corners: &Corners) -> f64 {
    closest_point(p, corners).distance(p)
}

/// Distance of a segment from a triangle; either may have collapsed.
pub fn segment_distance(ends: [DVec3; 2], corners: &Corners) -> f64 {
    let along = ends[1] - ends[0];
    let length = along.length();
    if length > 0.0
        && let Some(crossing) = ray(ends[0], along / length, corners)
        && crossing.border >= 0.0
        && (0.0..=length).contains(&crossing.distance)
    {
        return 0.0;
    }
    let [a, b, c] = *corners;
    let edges = [[a, b], [b, c], [c, a]].map(|edge| between_segments(ends, edge));
    let ends = ends.map(|end| distance(end, corners));
    edges.into_iter().chain(ends).fold(f64::INFINITY, f64::min)
}

/// The point of a segment that is nearest to `p`.
fn on_segment(p: DVec3, [from, to]: [DVec3; 2]) -> DVec3 {
    let way = to - from;
    let along = (p - from).dot(way) / way.length_squared();
    // For a segment of length 0, `along` is NaN; its beginning is the nearest point.
    let along = if along > 0.0 { along.min(1.0) } else { 0.0 };
    from + way * along
}

/// Distance of two segments: the least distance of an end from the other segment, or the distance of the lines if that
/// is less and both nearest points are inside the segments.
fn between_segments(a: [DVec3; 2], b: [DVec3; 2]) -> f64 {
    let ends = [(a[0], b), (a[1], b), (b[0], a), (b[1], a)];
    let distances = ends.map(|(end, other)| on_segment(end, other).distance(end));
    let mut best = distances.into_iter().fold(f64::INFINITY, f64::min);
    let (u, v, w) = (a[1] - a[0], b[1] - b[0], b[0] - a[0]);
    let normal = u.cross(v);
    let size = normal.length_squared();
    if size > 0.0 {
        let s = w.cross(v).dot(normal) / size;
        let t = w.cross(u).dot(normal) / size;
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            best = best.min((a[0] + u * s).distance(b[0] + v * t));
        }
    }
    best
}

/// The time at which a moving sphere touches a triangle: its face, an edge or a corner, each in closed form.
fn touch(center: DVec3, radius: f64, motion: DVec3, corners: &Corners) -> Option<f64> {
    if distance(center, corners) <= radius {
        return Some(0.0);
    }
    let [a, b, c] = *corners;
    let mut first = f64::INFINITY;
    if let Some(normal) = (b - a).cross(c - a).try_normalize() {
        let height = (center - a).dot(normal);
        let closing = -motion.dot(normal) * height.signum();
        let time = (height.abs() - radius) / closing;
        if closing > 0.0 && time >= 0.0 {
            let foot = center + motion * time - normal * (radius * height.signum());
            if distance(foot, corners) <= 1e-9 * (1.0 + foot.length()) {
                first = time;
            }
        }
    }
    for (from, to) in [(a, b), (b, c), (c, a)] {
        first = first.min(touch_edge(center, radius, motion, from, to));
    }
    for corner in corners {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The minimum of a distance over a parameter from 0 to 1, by ternary search. Distances of convex shapes have one
    /// minimum.
    fn search(distance: impl Fn(f64) -> f64) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..80 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if distance(a) < distance(b) {
                high = b;
            } else {
                low = a;
            }
        }
        distance((low + high) * 0.5)
    }

    fn point(rng: &mut fastrand::Rng) -> DVec3 {
        let mut coordinate = || rng.f64() * 2.0 - 1.0;
        DVec3::new(coordinate(), coordinate(), coordinate())
    }

    #[test]
    fn distances_are_those_of_a_search() {
        let mut rng = fastrand::Rng::with_seed(1);
        for _ in 0..2_000 {
            let corners = [(); 3].map(|()| point(&mut rng));
            let p = point(&mut rng) * 2.0;
            let [a, b, c] = corners;
            let inside =
                |u: f64| search(|v| (a + (b - a) * u + (c - a) * ((1.0 - u) * v)).distance(p));
            let wanted = search(inside);
            let found = distance(p, &corners);
            assert!(
                (found - wanted).abs() < 1e-9,
                "{found} {wanted} {p} {corners:?}"
            );

            let q = p + point(&mut rng);
            let wanted = search(|t| distance(p + (q - p) * t, &corners));
            let found = segment_distance([p, q], &corners);
            assert!(
                (found - wanted).abs() < 1e-7,
                "{found} {wanted} {p} {q} {corners:?}"
            );
        }
    }

    #[test]
    fn a_sphere_touches_when_its_distance_is_its_radius() {
        let mut rng = fastrand::Rng::with_seed(2);
        let mut touched = 0;
        for _ in 0..5_000 {
            let one = Triangles(vec![[(); 3].map(|()| point(&mut rng))]);
            let center = point(&mut rng) * 3.0;
            let motion = (point(&mut rng) - center) * 1.5;
            let radius = 0.02 + 0.4 * rng.f64();
            let nearest = one.segment_distance([center, center + motion]);
            match one.cast_sphere(center, radius, motion) {
                None => assert!(nearest > radius - 1e-9, "{nearest} {radius}"),
                Some(0.0) => assert!(one.distance(center) <= radius),
                Some(time) => {
                    let there = one.distance(center + motion * time);
                    assert!((there - radius).abs() < 1e-7, "{there} {radius} at {time}");
                    let before = one.segment_distance([center, center + motion * (time - 1e-6)]);
                    assert!(before >= radius - 1e-7, "{before} {radius} before {time}");
                    touched += 1;
                }
            }
        }
        assert!(touched > 500, "{touched}");
    }

    #[test]
    fn collapsed_triangles_are_segments_and_points() {
        let (a, b) = (DVec3::ZERO, DVec3::X);
        assert_eq!(distance(DVec3::Y, &[a, b, a]), 1.0);
        assert_eq!(distance(DVec3::Y, &[a; 3]), 1.0);
        assert_eq!(segment_distance([DVec3::Y; 2], &[a, b, b]), 1.0);
        let one = Triangles(vec![[a; 3]]);
        assert_eq!(one.cast_sphere(DVec3::Y, 0.5, DVec3::Y * -2.0), Some(0.25));
        assert_eq!(one.cast_ray(DVec3::Y, DVec3::NEG_Y, 5.0), None);
    }
}
