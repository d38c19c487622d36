//! The nearest features of triangle and core, in f64: an approximation that certificates start from, and that proves
//! nothing by itself.

use glam::DVec3;

/// The nearest features of triangle and core at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    /// Approximate distance.
    pub(super) distance: f64,
    /// Unit vector from the triangle to the core. It is perpendicular to the nearest features, so that it stays a
    /// separating direction however near they come. Zero if no direction is known.
    pub(super) direction: DVec3,
    features: Features,
}

/// The nearest features, ordered by the number of their dimensions that are perpendicular to the direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Features {
    /// No direction is known.
    None,
    /// A corner and an end.
    Points,
    /// A point and the inside of an edge or of the core.
    PointAndLine,
    /// A face, or edge and core.
    Plane,
}

/// Distances that differ by less than this share count as equal: more than f64 rounds, so that rounding does not choose
/// the features.
const EQUAL: f64 = 1e-13;

impl Nearest {
    /// Takes new features if they are nearer. Among equally near features, the higher kind wins: if a point is almost
    /// above a line's end, only the line gives a direction that separates the whole line from the point.
    fn offer(&mut self, distance: f64, direction: DVec3, features: Features) {
        let features = if direction == DVec3::ZERO {
            Features::None
        } else {
            features
        };
        let is_nearer = distance < self.distance * (1.0 - EQUAL);
        let is_as_near = distance <= self.distance * (1.0 + EQUAL) && features > self.features;
        if (is_nearer || is_as_near) && direction.is_finite() {
            *self = Self {
                distance,
                direction,
                features,
            };
        }
    }
}

/// The nearest features of a triangle and a segment; either may have collapsed.
pub(super) fn nearest(corners: [DVec3; 3], ends: [DVec3; 2]) -> Nearest {
    let mut best = Nearest {
        distance: f64::INFINITY,
        direction: DVec3::ZERO,
        features: Features::None,
    };
    let [a, b, c] = corners;
    let edges = [[a, b], [b, c], [c, a]];
    for end in ends {
        for edge in edges {
            point_and_segment(&mut best, edge, end, 1.0);
        }
        above_face(&mut best, corners, end);
    }
    if ends[0] != ends[1] {
        for corner in corners {
            point_and_segment(&mut best, ends, corner, -1.0);
        }
        for edge in edges {
            lines(&mut best, edge, ends);
        }
        through_face(&mut best, corners, ends);
    }
    best
}

/// `sign` is 1 if the segment belongs to the triangle, else -1.
fn point_and_segment(best: &mut Nearest, [a, b]: [DVec3; 2], p: DVec3, sign: f64) {
    let axis = b - a;
    let share = (p - a).dot(axis) / axis.length_squared();
    let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
    let apart = p - (a + axis * share);
    let mut direction = apart.normalize_or_zero();
    let mut features = Features::Points;
    if share > 0.0 && share < 1.0 {
        let axis = axis.normalize_or_zero();
        direction = (direction - axis * direction.dot(axis)).normalize_or_zero();
        features = Features::PointAndLine;
    }
    best.offer(apart.length(), direction * sign, features);
}

fn above_face(best: &mut Nearest, corners: [DVec3; 3], p: DVec3) {
    let [a, b, c] = corners;
    let n = (b - a).cross(c - a).normalize_or_zero();
    if n != DVec3::ZERO && is_inside(corners, n, p) {
        let height = n.dot(p - a);
        let outward = if height < 0.0 { -n } else { n };
        best.offer(height.abs(), outward, Features::Plane);
    }
}

fn is_inside([a, b, c]: [DVec3; 3], n: DVec3, p: DVec3) -> bool {
    let left_of = |a: DVec3, b: DVec3| (b - a).cross(p - a).dot(n) >= 0.0;
    left_of(a, b) && left_of(b, c) && left_of(c, a)
}

fn lines(best: &mut Nearest, [a, b]: [DVec3; 2], [p, q]: [DVec3; 2]) {
    let (u, v, apart) = (b - a, q - p, p - a);
    let n = u.cross(v);
    let n_sq = n.length_squared();
    let s = apart.cross(v).dot(n) / n_sq;
    let t = apart.cross(u).dot(n) / n_sq;
    if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
        let n = n.normalize_or_zero();
        let height = n.dot(apart);
        let outward = if height < 0.0 { -n } else { n };
        best.offer(height.abs(), outward, Features::Plane);
    }
}

fn through_face(best: &mut Nearest, corners: [DVec3; 3], [p, q]: [DVec3; 2]) {
    let [a, b, c] = corners;
    let n = (b - a).cross(c - a).normalize_or_zero();
    let (from, to) = (n.dot(p - a), n.dot(q - a));
    if from * to < 0.0 && is_inside(corners, n, p + (q - p) * (from / (from - to))) {
        best.offer(0.0, n, Features::Plane);
    }
}
