//! The positions of a posed surface, for checks that do not use the surface's queries.

use crate::agreement::Aims;
use clamber_surface::mesh::{TriangleId, VertexId};
use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, Vec3};

/// A surface with all its vertices skinned.
pub(super) struct Posed<'a> {
    pub(super) surface: &'a SkinnedSurface,
    /// Current positions, in model space.
    pub(super) positions: Vec<Vec3>,
    /// Current corners of the triangles.
    pub(super) triangles: Vec<[Vec3; 3]>,
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
        assert!(
            both.clone().all(|p| p.is_finite()),
            "a vertex is not finite"
        );
        let farthest = both.map(|p| p.abs().max_element()).fold(0.0, f32::max);
        let triangles = surface.mesh().triangles().iter();
        Self {
            surface,
            triangles: triangles
                .map(|corners| corners.map(|v| positions[v.index()]))
                .collect(),
            positions,
            previous,
            extent: extent as f32,
            farthest,
        }
    }

    pub(super) fn corner_ids(&self, triangle: usize) -> [usize; 3] {
        self.surface.mesh().triangles()[triangle].map(|v| v.index())
    }

    /// The corners of a triangle at a time of the tick, 0 to 1. They move on straight lines over the tick.
    pub(super) fn corners_at(&self, triangle: usize, time: f64) -> [DVec3; 3] {
        self.corner_ids(triangle).map(|v| {
            let (from, to) = (self.previous[v].as_dvec3(), self.positions[v].as_dvec3());
            from + (to - from) * time
        })
    }

    /// Targets on the skin in its current pose.
    pub(super) fn aims<'b>(&'b self, rng: &'b mut fastrand::Rng) -> Aims<'b> {
        Aims::new(&self.triangles, self.extent, rng)
    }

    pub(super) fn any_triangle(&self, rng: &mut fastrand::Rng) -> usize {
        rng.usize(0..self.triangles.len())
    }

    /// Description of a triangle for messages.
    pub(super) fn name(&self, triangle: usize) -> String {
        let corners = self.triangles[triangle];
        format!("triangle {} at {corners:?}", TriangleId(triangle as u32))
    }
}
