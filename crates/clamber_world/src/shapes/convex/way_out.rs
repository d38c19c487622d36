//! The minimum translation that moves a segment out of a convex core that it meets.
//!
//! Along any direction, a translation by the core's extent minus the extent of the segment's rear end leads out. If
//! core and segment have only faces and edges, the shortest one is along the normal of a face, or perpendicular to an
//! edge and the segment; all of these are tried. For rims the directions are searched. Every result leads out. It is
//! the shortest within the steps of the search, and within a fiftieth for polyhedra, since parry drops edges between
//! nearly coplanar faces.

use glam::DVec3;

use super::{Convex, Core, MovingConvex};
use crate::shapes::ShapeContact;

/// Number of directions tried around the segment if the core has rims.
const AROUND: u32 = 48;

/// How often the step between these directions is halved around the best one.
const HALVINGS: u32 = 30;

/// First step, in radians, and number of rounds to refine the best direction on a rim. The step is about the angle
/// between the directions tried. Each round takes a step or halves it.
const OF_RIMS: (f64, u32) = (0.13, 96);

/// First step, in radians, and number of rounds for polyhedra, where parry merges faces whose normals are up to 1.4
/// degrees apart.
const OF_FACES: (f64, u32) = (0.025, 32);

struct Search<'a> {
    convex: &'a Convex<'a>,
    ends: [DVec3; 2],
    /// Least depth so far, and its direction.
    best: (f64, DVec3),
}

impl Search<'_> {
    fn depth(&self, direction: DVec3) -> f64 {
        let behind = self.ends.map(|end| direction.dot(end));
        self.convex.extent(direction) - behind[0].min(behind[1])
    }

    /// Tries a direction of any length and its opposite; of equal depths the first stays.
    fn offer(&mut self, direction: DVec3) {
        if let Some(unit) = direction.try_normalize() {
            for direction in [unit, -unit] {
                let depth = self.depth(direction);
                if depth < self.best.0 {
                    self.best = (depth, direction);
                }
            }
        }
    }

    /// Tries the direction perpendicular to an edge and to the segment.
    fn offer_edge(&mut self, edge: DVec3) {
        self.offer(edge.cross(self.ends[1] - self.ends[0]));
    }

    /// Tries all directions perpendicular to the segment. There both ends are equally deep: a ridge that the steps of
    /// [`Search::refine`] do not follow.
    fn offer_circle(&mut self, along: DVec3) {
        let (u, v) = along.any_orthonormal_pair();
        let at = |angle: f64| u * libm::cos(angle) + v * libm::sin(angle);
        let mut step = core::f64::consts::PI / f64::from(AROUND);
        let mut best = (f64::INFINITY, 0.0);
        let try_angle = |angle: f64, best: &mut (f64, f64)| {
            let depth = self.depth(at(angle)).min(self.depth(-at(angle)));
            if depth < best.0 {
                *best = (depth, angle);
            }
        };
        for k in 0..AROUND {
            try_angle(f64::from(k) * step, &mut best);
        }
        for _ in 0..HALVINGS {
            step *= 0.5;
            let middle = best.1;
            try_angle(middle - step, &mut best);
            try_angle(middle + step, &mut best);
        }
        self.offer(at(best.1));
    }

    fn refine(&mut self, (mut step, times): (f64, u32)) {
        for _ in 0..times {
            let (depth, at) = self.best;
            let (u, v) = at.any_orthonormal_pair();
            for aside in [u, v, u + v, u - v] {
                self.offer(at + aside * step);
                self.offer(at - aside * step);
            }
            if self.best.0 >= depth {
                step *= 0.5;
            }
        }
    }
}

impl Convex<'_> {
    /// The contact of a segment that meets the core, at the minimum translation. Its distance is negative or zero.
    pub(in crate::shapes) fn way_out(&self, ends: [DVec3; 2]) -> ShapeContact {
        let mut search = Search {
            convex: self,
            ends,
            best: (f64::INFINITY, DVec3::Y),
        };
        self.offer_all(&mut search);
        let (depth, normal) = search.best;
        let behind = ends.map(|end| normal.dot(end));
        let deepest = ends[usize::from(behind[1] < behind[0])];
        // If the segment leaves the core beside a face, take the face's nearest point.
        let out = deepest + normal * depth;
        let on_core = MovingConvex::still(self).nearest(0.0, [out; 2], normal);
        let on_core = on_core.map_or(out, |nearest| nearest.on_core);
        ShapeContact {
            point: on_core + normal * self.round,
            normal,
            distance: -(depth.max(0.0) + self.round),
        }
    }

    fn offer_all(&self, search: &mut Search<'_>) {
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        let along = search.ends[1] - search.ends[0];
        match &self.core {
            Core::Few(points, _) => {
                let [a, b, c] = *points;
                search.offer((b - a).cross(c - a));
                for edge in [b - a, c - b, a - c] {
                    search.offer_edge(edge);
                    // For flat cores, for edges parallel to the segment, and for points.
                    search.offer(edge.any_orthogonal_vector());
                }
                search.offer(along.any_orthogonal_vector());
                for axis in axes {
                    search.offer(axis);
                }
            }
            Core::Cuboid { .. } => {
                for axis in axes {
                    search.offer(axis);
                    search.offer_edge(axis);
                }
            }
            Core::Polyhedron(polyhedron) => {
                for face in polyhedron.faces() {
                    search.offer(face.normal.as_dvec3());
                }
                for edge in polyhedron.edges() {
                    search.offer_edge(edge.dir.as_dvec3());
                }
                search.refine(OF_FACES);
            }
            Core::Cylinder { .. } => self.offer_around(DVec3::ZERO, search),
            Core::Cone {
                half_height,
                radius,
            } => self.offer_around(DVec3::Y * (*radius / (2.0 * *half_height)), search),
            Core::Custom(_) => self.offer_around(DVec3::ZERO, search),
        }
    }

    /// For cores that are round about Y. `rise` is the Y part of the normal of their sides for each unit outwards.
    fn offer_around(&self, rise: DVec3, search: &mut Search<'_>) {
        for axis in [DVec3::Y, DVec3::X, DVec3::Z] {
            search.offer(axis);
        }
        let [a, b] = search.ends;
        let along = b - a;
        let level = |v: DVec3| DVec3::new(v.x, 0.0, v.z);
        let share = -level(a).dot(level(along)) / level(along).length_squared();
        let nearest_to_axis = a + along
            * if share.is_finite() {
                share.clamp(0.0, 1.0)
            } else {
                0.0
            };
        for point in [a, b, nearest_to_axis] {
            search.offer(level(point).normalize_or(DVec3::X) + rise);
        }
        search.offer_edge(DVec3::Y);
        if let Some(unit) = along.try_normalize() {
            search.offer_circle(unit);
        }
        search.refine(OF_RIMS);
    }
}
