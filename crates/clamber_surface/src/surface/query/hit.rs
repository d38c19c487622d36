use std::cmp::Ordering;

use glam::{DVec3, Vec3};

use crate::geometry::triangle::{TrianglePoint, point_at, scaled_normal};
use crate::geometry::{round_to_f32, widen};
use crate::mesh::{PartId, SurfaceTag, TriangleId};
use crate::surface::SkinnedSurface;

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

/// A triangle with its point that a query found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::surface) struct Nearest {
    pub(in crate::surface) triangle: TriangleId,
    pub(in crate::surface) found: TrianglePoint,
}

impl Nearest {
    /// By distance, equal ones by triangle id: the order of every query that finds several triangles.
    pub(in crate::surface) fn compare(&self, other: &Self) -> Ordering {
        by_length(self.found.distance, other.found.distance)
            .then_with(|| self.triangle.cmp(&other.triangle))
    }
}

/// The order of lengths, none of which is NaN. -0 equals 0: which of them a distance of zero comes out as
/// depends on the order of a triangle's corners.
pub(in crate::surface) fn by_length(a: f64, b: f64) -> Ordering {
    a.partial_cmp(&b).unwrap_or(Ordering::Equal)
}

/// The nearest triangle so far. Of equal distances the smaller triangle id wins, so the order in
/// which triangles are tested does not matter.
#[derive(Clone, Copy, Debug)]
pub(in crate::surface) struct Best {
    nearest: Option<Nearest>,
    limit: f64,
}

impl Best {
    /// Nothing yet, and nothing farther than `limit` ever.
    pub(in crate::surface) fn within(limit: f64) -> Self {
        Self {
            nearest: None,
            limit,
        }
    }

    /// What is farther than this does not matter; what is as far may.
    pub(in crate::surface) fn limit(&self) -> f64 {
        self.limit
    }

    pub(in crate::surface) fn offer(&mut self, candidate: Nearest) {
        let nearer = match &self.nearest {
            Some(best) => candidate.compare(best).is_lt(),
            None => candidate.found.distance <= self.limit,
        };
        if nearer {
            self.limit = candidate.found.distance;
            self.nearest = Some(candidate);
        }
    }

    /// The best as a hit; `origin` is where the query looked from.
    pub(in crate::surface) fn hit(
        &self,
        surface: &SkinnedSurface,
        origin: Vec3,
    ) -> Option<SurfaceHit> {
        let nearest = self.nearest?;
        let part = surface.mesh.part_of(nearest.triangle)?;
        Some(surface.hit(nearest, part, surface.corners(nearest.triangle), origin))
    }
}

impl SkinnedSurface {
    /// The outward unit normal of a posed triangle; `None` if it has no area.
    pub(in crate::surface) fn outward_normal(
        &self,
        corners: [Vec3; 3],
        part: PartId,
    ) -> Option<DVec3> {
        let normal = scaled_normal(corners).try_normalize()?;
        Some(if self.is_mirrored(part) {
            -normal
        } else {
            normal
        })
    }

    /// True if the joint of a part mirrors.
    pub(in crate::surface) fn is_mirrored(&self, part: PartId) -> bool {
        let joint = self.mesh.parts()[part.index()].joint;
        self.current.palette()[joint.0 as usize].is_mirrored()
    }

    /// Completes a hit on a triangle with the given posed corners. `origin` is where the query looked
    /// from.
    pub(in crate::surface) fn hit(
        &self,
        nearest: Nearest,
        part: PartId,
        corners: [Vec3; 3],
        origin: Vec3,
    ) -> SurfaceHit {
        let Nearest { triangle, found } = nearest;
        let point = point_at(corners, found.barycentric);
        let normal = self
            .outward_normal(corners, part)
            .unwrap_or_else(|| (widen(origin) - point).try_normalize().unwrap_or(DVec3::Y));
        SurfaceHit {
            triangle,
            barycentric: round_to_f32(found.barycentric).to_array(),
            point: round_to_f32(point),
            normal: round_to_f32(normal),
            distance: (found.distance as f32).min(f32::MAX),
            part,
            tag: self.mesh.tags()[triangle.index()],
        }
    }
}
