use glam::{DVec3, Vec3};

use super::SkinnedSurface;
use crate::geometry::triangle::{TrianglePoint, point_at, scaled_normal};
use crate::geometry::{round_to_f32, widen};
use crate::mesh::{PartId, SurfaceTag, TriangleId};

/// A material point that a query found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceHit {
    /// The triangle.
    pub triangle: TriangleId,
    /// Weights of its corners: not negative, sum 1 up to rounding.
    pub barycentric: [f32; 3],
    /// The point, in model space.
    pub point: Vec3,
    /// Outward unit normal of the deformed triangle, in model space. Where the triangle has
    /// collapsed: towards the query's origin.
    pub normal: Vec3,
    /// From the ray's origin or the query's point, in units of model space.
    pub distance: f32,
    /// The part that the triangle belongs to.
    pub part: PartId,
    /// The triangle's tag.
    pub tag: SurfaceTag,
}

/// The nearest triangle so far. Of equal distances the smaller triangle id wins, so the order in
/// which triangles are tested does not matter.
#[derive(Clone, Copy)]
pub(super) struct Nearest {
    pub(super) triangle: TriangleId,
    pub(super) found: TrianglePoint,
}

impl Nearest {
    pub(super) fn closer(
        best: Option<Self>,
        triangle: TriangleId,
        found: TrianglePoint,
    ) -> Option<Self> {
        let candidate = Self { triangle, found };
        match best {
            Some(best) if !candidate.precedes(&best) => Some(best),
            _ => Some(candidate),
        }
    }

    fn precedes(&self, other: &Self) -> bool {
        self.found.distance < other.found.distance
            || (self.found.distance == other.found.distance && self.triangle < other.triangle)
    }
}

impl SkinnedSurface {
    /// The outward unit normal of a posed triangle; `None` if it has no area.
    pub(in crate::surface) fn outward_normal(
        &self,
        triangle: TriangleId,
        part: PartId,
    ) -> Option<DVec3> {
        let normal = scaled_normal(self.corners(triangle)).try_normalize()?;
        Some(if self.mirrored[part.index()] {
            -normal
        } else {
            normal
        })
    }

    /// Completes a hit. `origin` is where the query looked from.
    pub(super) fn hit(&self, nearest: Nearest, origin: Vec3) -> Option<SurfaceHit> {
        let Nearest { triangle, found } = nearest;
        let part = self.mesh.part_of(triangle)?;
        let point = point_at(self.corners(triangle), found.barycentric);
        let normal = self
            .outward_normal(triangle, part)
            .unwrap_or_else(|| (widen(origin) - point).try_normalize().unwrap_or(DVec3::Y));
        Some(SurfaceHit {
            triangle,
            barycentric: round_to_f32(found.barycentric).to_array(),
            point: round_to_f32(point),
            normal: round_to_f32(normal),
            distance: found.distance as f32,
            part,
            tag: self.mesh.tags()[triangle.index()],
        })
    }
}
