use super::hit::Nearest;
use super::{SLACK, SkinnedSurface, SurfaceError, SurfaceHit, check_length};
use crate::geometry::triangle::ShearedRay;
use crate::geometry::{Ray, Sphere, widen};
use crate::mesh::TriangleId;

impl SkinnedSurface {
    /// The first triangle along a ray, from either side, up to `max_distance` (may be infinite).
    ///
    /// Watertight across edges and corners that triangles share by index.
    ///
    /// # Errors
    /// [`SurfaceError::Query`] if `max_distance` is negative or NaN.
    pub fn cast_ray(
        &self,
        ray: &Ray,
        max_distance: f32,
    ) -> Result<Option<SurfaceHit>, SurfaceError> {
        let max_distance = check_length("the ray's maximum distance", max_distance)?;
        let near = self.triangles_near(|sphere| may_meet(ray, max_distance, sphere));
        Ok(self.cast_among(near, ray, max_distance))
    }

    /// [`SkinnedSurface::cast_ray`] over all triangles: slow and plain, for tests.
    ///
    /// # Errors
    /// As [`SkinnedSurface::cast_ray`].
    pub fn cast_ray_reference(
        &self,
        ray: &Ray,
        max_distance: f32,
    ) -> Result<Option<SurfaceHit>, SurfaceError> {
        let max_distance = check_length("the ray's maximum distance", max_distance)?;
        Ok(self.cast_among(self.all_triangles(), ray, max_distance))
    }

    fn cast_among(
        &self,
        triangles: impl Iterator<Item = TriangleId>,
        ray: &Ray,
        max_distance: f64,
    ) -> Option<SurfaceHit> {
        let sheared = ShearedRay::new(ray);
        let mut best: Option<Nearest> = None;
        for triangle in triangles {
            // As far as the best one inclusive: an equal distance may belong to a smaller id.
            let limit = best.map_or(max_distance, |best| best.found.distance);
            if let Some(found) = sheared.intersect(self.corners(triangle), limit) {
                best = Nearest::closer(best, triangle, found);
            }
        }
        self.hit(best?, ray.origin())
    }
}

/// False only if no triangle inside the sphere can be met. By the perpendicular from the centre
/// to the ray, which keeps its digits far out where the usual discriminant loses them.
fn may_meet(ray: &Ray, max_distance: f64, sphere: &Sphere) -> bool {
    let direction = widen(ray.direction());
    let to_center = widen(sphere.center) - widen(ray.origin());
    // The direction is of unit length only up to f32 rounding.
    let along = to_center.dot(direction) / direction.length();
    let perpendicular = to_center - direction * (along / direction.length());
    let radius = f64::from(sphere.radius);
    let reach = radius + SLACK * (to_center.length() + radius);
    perpendicular.length() <= reach && along >= -reach && along - reach <= max_distance
}
