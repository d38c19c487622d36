//! The positions of a posed surface, which checks use without its queries.

use clamber_surface::mesh::{TriangleId, VertexId};
use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, Vec3};

/// A surface with all its vertices skinned.
pub(super) struct Posed<'a> {
    pub(super) surface: &'a SkinnedSurface,
    /// Current positions, in model space.
    pub(super) positions: Vec<Vec3>,
    /// Positions a tick ago, in the current model frame.
    pub(super) previous: Vec<Vec3>,
    /// Approximate size of the creature at rest, in model units.
    pub(super) extent: f32,
    /// Largest absolute coordinate, now or a tick ago.
    pub(super) farthest: f32,
}

impl<'a> Posed<'a> {
    pub(super) fn new(surface: &'a SkinnedSurface, extent: f64) -> Self {
        let mut positions = Vec::new();
        surface.skin_all(&mut positions);
        let all = 0..positions.len() as u32;
        let space = surface.in_model();
        let before = |v| space.previous_position(VertexId(v));
        let previous: Vec<Vec3> = all.filter_map(before).collect();
        assert_eq!(previous.len(), positions.len());
        let both = positions.iter().chain(&previous);
        let farthest = both.map(|p| p.abs().max_element()).fold(0.0, f32::max);
        assert!(both_finite(&positions, &previous), "a vertex is not finite");
        Self {
            surface,
            positions,
            previous,
            extent: extent as f32,
            farthest,
        }
    }

    /// The current corners of a triangle.
    pub(super) fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.corner_ids(triangle).map(|v| self.positions[v])
    }

    pub(super) fn corner_ids(&self, triangle: usize) -> [usize; 3] {
        self.surface.mesh().triangles()[triangle].map(|v| v.index())
    }

    /// The corners of a triangle at a time of the tick, 0 to 1. They move on straight lines.
    pub(super) fn corners_at(&self, triangle: usize, time: f64) -> [DVec3; 3] {
        self.corner_ids(triangle).map(|v| {
            let (from, to) = (self.previous[v].as_dvec3(), self.positions[v].as_dvec3());
            from + (to - from) * time
        })
    }

    pub(super) fn any_triangle(&self, rng: &mut fastrand::Rng) -> usize {
        rng.usize(0..self.surface.mesh().triangles().len())
    }

    /// Description of a triangle for messages.
    pub(super) fn name(&self, triangle: usize) -> String {
        let corners = self.corners(triangle);
        format!("triangle {} at {corners:?}", TriangleId(triangle as u32))
    }
}

fn both_finite(a: &[Vec3], b: &[Vec3]) -> bool {
    a.iter().chain(b).all(|p| p.is_finite())
}

/// Barycentric weights of a random point of a triangle.
pub(super) fn random_weights(rng: &mut fastrand::Rng) -> [f32; 3] {
    let (u, v) = (rng.f32(), rng.f32());
    let (u, v) = if u + v > 1.0 {
        (1.0 - u, 1.0 - v)
    } else {
        (u, v)
    };
    [u, v, 1.0 - u - v]
}

/// The point of a triangle with the given weights, computed in f64 and rounded.
pub(super) fn point_of([a, b, c]: [Vec3; 3], [u, v, w]: [f32; 3]) -> Vec3 {
    let sum =
        a.as_dvec3() * f64::from(u) + b.as_dvec3() * f64::from(v) + c.as_dvec3() * f64::from(w);
    sum.as_vec3()
}

/// A point of the triangle that is nearest to `p` but for rounding, in f64: its distance is at least the true one, and
/// hardly more.
pub(super) fn nearest_in([a, b, c]: [DVec3; 3], p: DVec3) -> DVec3 {
    let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| {
        let way = to - from;
        let along = (p - from).dot(way) / way.length_squared();
        // For a side without length, its beginning: `along` is NaN then.
        let along = if along > 0.0 { along.min(1.0) } else { 0.0 };
        from + way * along
    });
    let mut best = sides[0];
    for side in &sides[1..] {
        if (*side - p).length_squared() < (best - p).length_squared() {
            best = *side;
        }
    }
    let normal = (b - a).cross(c - a);
    let area_sq = normal.length_squared();
    if area_sq > 0.0 {
        let weight = |from: DVec3, to: DVec3| (to - from).cross(p - from).dot(normal) / area_sq;
        let [u, v] = [weight(b, c), weight(c, a)];
        if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
            let inside = a * u + b * v + c * (1.0 - u - v);
            if (inside - p).length_squared() < (best - p).length_squared() {
                best = inside;
            }
        }
    }
    best
}
