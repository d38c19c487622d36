//! Where triangle and core are nearest, in f64: a guess that certificates start from. Nothing is proved
//! by it.

use glam::DVec3;

/// Of triangle and core at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    /// About.
    pub(super) distance: f64,
    /// Unit vector from the triangle to the core; right-angled to the features that are nearest,
    /// so that it stays a separating direction however near they come. Zero if there is none.
    pub(super) direction: DVec3,
}

impl Nearest {
    fn offer(&mut self, distance: f64, direction: DVec3) {
        // What touches in a corner has no direction; one that has is better.
        let is_better = distance < self.distance
            || (distance == self.distance && self.direction == DVec3::ZERO);
        if is_better && direction.is_finite() {
            *self = Self {
                distance,
                direction,
            };
        }
    }
}

/// Of a triangle and a segment; either may have collapsed.
pub(super) fn nearest(corners: [DVec3; 3], ends: [DVec3; 2]) -> Nearest {
    let mut best = Nearest {
        distance: f64::INFINITY,
        direction: DVec3::ZERO,
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
    if share > 0.0 && share < 1.0 {
        let axis = axis.normalize_or_zero();
        direction = (direction - axis * direction.dot(axis)).normalize_or_zero();
    }
    best.offer(apart.length(), direction * sign);
}

fn above_face(best: &mut Nearest, corners: [DVec3; 3], p: DVec3) {
    let [a, b, c] = corners;
    let n = (b - a).cross(c - a).normalize_or_zero();
    if n != DVec3::ZERO && is_inside(corners, n, p) {
        let height = n.dot(p - a);
        best.offer(height.abs(), if height < 0.0 { -n } else { n });
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
        best.offer(height.abs(), if height < 0.0 { -n } else { n });
    }
}

fn through_face(best: &mut Nearest, corners: [DVec3; 3], [p, q]: [DVec3; 2]) {
    let [a, b, c] = corners;
    let n = (b - a).cross(c - a).normalize_or_zero();
    let (from, to) = (n.dot(p - a), n.dot(q - a));
    if from * to < 0.0 && is_inside(corners, n, p + (q - p) * (from / (from - to))) {
        best.offer(0.0, n);
    }
}
