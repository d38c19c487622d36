use glam::DVec3;

/// A point of the Minkowski difference of core and segment, with the core's point at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Corner {
    pub(super) apart: DVec3,
    pub(super) on_core: DVec3,
}

/// Up to four corners, and the weights of the point between them that is nearest to the origin.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Simplex {
    corners: [Corner; 4],
    weights: [f64; 4],
    count: usize,
}

impl Simplex {
    pub(super) fn new(corner: Corner) -> Self {
        Self {
            corners: [corner; 4],
            weights: [1.0, 0.0, 0.0, 0.0],
            count: 1,
        }
    }

    pub(super) fn has(&self, corner: &Corner) -> bool {
        let mut corners = self.corners[..self.count].iter();
        corners.any(|known| known.apart == corner.apart)
    }

    /// Adds a corner and keeps those that support the point nearest to the origin. `None` if the origin is inside. This
    /// is not tested if `apart` says that it is outside: four corners on a rim are nearly flat.
    pub(super) fn with(&self, corner: Corner, apart: bool) -> Option<Self> {
        let mut all = *self;
        all.corners[all.count] = corner;
        all.count += 1;
        let p = all.corners.map(|corner| corner.apart);
        let nearest = match all.count {
            2 => ClosestPoint::of_segment(p, [0, 1]),
            3 => ClosestPoint::of_triangle(p, [0, 1, 2]),
            _ => {
                if !apart && is_inside(p) {
                    return None;
                }
                let faces = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
                let [first, others @ ..] = faces.map(|face| ClosestPoint::of_triangle(p, face));
                others.into_iter().fold(first, ClosestPoint::or_nearer)
            }
        };
        let mut kept = Self::default();
        for (corner, weight) in all.corners.into_iter().zip(nearest.weights) {
            if weight > 0.0 {
                kept.corners[kept.count] = corner;
                kept.weights[kept.count] = weight;
                kept.count += 1;
            }
        }
        Some(kept)
    }

    /// The point nearest to the origin.
    pub(super) fn nearest(&self) -> Corner {
        let mut sum = Corner::default();
        for (corner, weight) in self.corners.iter().zip(self.weights).take(self.count) {
            sum.apart += corner.apart * weight;
            sum.on_core += corner.on_core * weight;
        }
        sum
    }
}

/// Weights of four corners, and the distance of the weighted point from the origin.
#[derive(Clone, Copy)]
struct ClosestPoint {
    weights: [f64; 4],
    distance: f64,
}

impl ClosestPoint {
    fn new(p: [DVec3; 4], weights: [f64; 4]) -> Self {
        let sum = p.into_iter().zip(weights).map(|(p, weight)| p * weight);
        Self {
            weights,
            distance: sum.fold(DVec3::ZERO, |sum, p| sum + p).length(),
        }
    }

    fn or_nearer(self, other: Self) -> Self {
        if other.distance < self.distance {
            other
        } else {
            self
        }
    }

    fn of_segment(p: [DVec3; 4], [i, j]: [usize; 2]) -> Self {
        let along = p[j] - p[i];
        let length_sq = along.length_squared();
        let share = if length_sq > 0.0 {
            (-p[i].dot(along) / length_sq).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let mut weights = [0.0; 4];
        weights[i] = 1.0 - share;
        weights[j] = share;
        Self::new(p, weights)
    }

    /// The nearest point on an edge or, where it is inside, the foot of the perpendicular. Each of these is a point of
    /// the triangle and its distance is measured, so that no sign decides alone.
    fn of_triangle(p: [DVec3; 4], [i, j, k]: [usize; 3]) -> Self {
        let edges = Self::of_segment(p, [i, j])
            .or_nearer(Self::of_segment(p, [j, k]))
            .or_nearer(Self::of_segment(p, [k, i]));
        let normal = (p[j] - p[i]).cross(p[k] - p[i]);
        let shares = [
            normal.dot(p[j].cross(p[k])),
            normal.dot(p[k].cross(p[i])),
            normal.dot(p[i].cross(p[j])),
        ];
        let sum = shares[0] + shares[1] + shares[2];
        if sum > 0.0 && shares.iter().all(|share| *share >= 0.0) {
            let mut weights = [0.0; 4];
            weights[i] = shares[0] / sum;
            weights[j] = shares[1] / sum;
            weights[k] = shares[2] / sum;
            edges.or_nearer(Self::new(p, weights))
        } else {
            edges
        }
    }
}

/// True if the origin is inside a tetrahedron that is not flat, on the same side of each face as the opposite corner.
fn is_inside(p: [DVec3; 4]) -> bool {
    let same_side = |[a, b, c]: [DVec3; 3], opposite: DVec3| {
        let normal = (b - a).cross(c - a);
        let (of_origin, of_opposite) = (normal.dot(-a), normal.dot(opposite - a));
        of_origin * of_opposite > 0.0
    };
    let [a, b, c, d] = p;
    same_side([a, b, c], d)
        && same_side([a, b, d], c)
        && same_side([a, c, d], b)
        && same_side([b, c, d], a)
}
