use glam::Vec3;

use super::hit::Nearest;
use super::{SLACK, SkinnedSurface, SurfaceError, SurfaceHit, check_length};
use crate::geometry::triangle::closest_point;
use crate::geometry::{Sphere, widen};
use crate::mesh::TriangleId;

impl SkinnedSurface {
    /// The material point nearest to `point`, no farther than `max_distance` (may be infinite).
    ///
    /// # Errors
    /// [`SurfaceError::Point`] if `point` is not finite, [`SurfaceError::Query`] if `max_distance`
    /// is negative or NaN.
    pub fn closest_point(
        &self,
        point: Vec3,
        max_distance: f32,
    ) -> Result<Option<SurfaceHit>, SurfaceError> {
        let max_distance = check(point, max_distance)?;
        let near = self.triangles_near(move |sphere| within_reach(sphere, point, max_distance));
        Ok(self.closest_among(near, point, max_distance))
    }

    /// [`SkinnedSurface::closest_point`] over all triangles: slow and plain, for tests.
    ///
    /// # Errors
    /// As [`SkinnedSurface::closest_point`].
    pub fn closest_point_reference(
        &self,
        point: Vec3,
        max_distance: f32,
    ) -> Result<Option<SurfaceHit>, SurfaceError> {
        let max_distance = check(point, max_distance)?;
        Ok(self.closest_among(self.all_triangles(), point, max_distance))
    }

    fn closest_among(
        &self,
        triangles: impl Iterator<Item = TriangleId>,
        point: Vec3,
        max_distance: f64,
    ) -> Option<SurfaceHit> {
        let mut best: Option<Nearest> = None;
        for triangle in triangles {
            let found = closest_point(self.corners(triangle), point);
            if found.distance <= max_distance {
                best = Nearest::closer(best, triangle, found);
            }
        }
        self.hit(best?, point)
    }
}

pub(super) fn check(point: Vec3, length: f32) -> Result<f64, SurfaceError> {
    if !point.is_finite() {
        return Err(SurfaceError::Point);
    }
    check_length("the distance of a query", length)
}

/// False only if no point of the sphere is within `distance` of `point`.
pub(super) fn within_reach(sphere: &Sphere, point: Vec3, distance: f64) -> bool {
    let apart = (widen(sphere.center) - widen(point)).length();
    apart <= (f64::from(sphere.radius) + distance) * (1.0 + SLACK)
}
