use glam::Vec3;
use parry3d::query::{PointProjection, PointQuery, Ray as ParryRay, RayCast, RayIntersection};
use parry3d::shape::FeatureId;

use crate::geometry::Ray;
use crate::surface::SkinnedSurface;

/// A surface at its current pose, as parry's queries see it, in model space: what
/// [`SkinnedSurface::cast_ray`] and [`SkinnedSurface::closest_point`] answer, with parry's words for it.
///
/// A surface is not solid: `solid` makes no difference, and no point is ever inside. As in parry's own
/// meshes, triangles are met from both sides, normals are turned towards the ray, `subshape` is the
/// triangle's id, and the feature its face: 0 in front, 1 behind. Edges and corners count as the face.
///
/// Where there is nothing to answer (no triangles; a point or ray that is not finite), rays meet nothing
/// and a point is its own projection.
///
/// ```
/// # use std::sync::Arc;
/// # use clamber_surface::mesh::{BuildOptions, ColliderMesh, Influence, MeshSource};
/// # use clamber_surface::rig::JointId;
/// # use clamber_surface::surface::SkinnedSurface;
/// # use glam::Vec3;
/// use clamber_surface::parry::PosedSurface;
/// use clamber_surface::parry::parry3d::query::{PointQuery, Ray, RayCast};
/// # let source = MeshSource {
/// #     positions: &[Vec3::ZERO, Vec3::X, Vec3::Y],
/// #     triangles: &[[0, 1, 2]],
/// #     influences: &[Influence { joint: JointId(0), weight: 1.0 }; 3],
/// #     joint_count: 1,
/// #     ..MeshSource::default()
/// # };
/// # let surface = SkinnedSurface::new(Arc::new(ColliderMesh::build(&source, &BuildOptions::default())?.0));
///
/// let ray = Ray::new(Vec3::new(0.2, 0.2, 3.0), Vec3::NEG_Z * 2.0);
/// assert_eq!(PosedSurface(&surface).cast_local_ray(&ray, 10.0, true), Some(1.5));
/// let near = PosedSurface(&surface).project_local_point(Vec3::new(-1.0, 0.0, 0.0), true);
/// assert_eq!(near.point, Vec3::ZERO);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PosedSurface<'a>(pub &'a SkinnedSurface);

/// parry's directions may have any length; times are in units of it.
struct Scaled {
    ray: Ray,
    limit: f32,
    length: f64,
}

impl Scaled {
    fn new(ray: &ParryRay, max_time_of_impact: f32) -> Option<Self> {
        let length = ray.dir.as_dvec3().length();
        let limit = f64::from(max_time_of_impact) * length;
        Some(Self {
            ray: Ray::new(ray.origin, ray.dir)?,
            limit: limit as f32,
            length,
        })
    }
}

impl RayCast for PosedSurface<'_> {
    fn cast_local_ray_and_get_normal(
        &self,
        ray: &ParryRay,
        max_time_of_impact: f32,
        _solid: bool,
    ) -> Option<RayIntersection> {
        let scaled = Scaled::new(ray, max_time_of_impact)?;
        let hit = self.0.cast_ray(&scaled.ray, scaled.limit).ok()??;
        let behind = hit.normal.dot(ray.dir) > 0.0;
        let time = (f64::from(hit.distance) / scaled.length) as f32;
        let normal = if behind { -hit.normal } else { hit.normal };
        let feature = FeatureId::Face(behind.into());
        // At the limit rounding may have made it a little more.
        let time = time.min(max_time_of_impact);
        Some(RayIntersection::new(time, normal, feature).with_subshape(hit.triangle.0))
    }

    fn intersects_local_ray(&self, ray: &ParryRay, max_time_of_impact: f32) -> bool {
        let scaled = Scaled::new(ray, max_time_of_impact);
        scaled.is_some_and(|scaled| {
            let met = self.0.intersects_ray(&scaled.ray, scaled.limit);
            met.unwrap_or(false)
        })
    }
}

impl PointQuery for PosedSurface<'_> {
    fn project_local_point_with_max_dist(
        &self,
        pt: Vec3,
        _solid: bool,
        max_dist: f32,
    ) -> Option<PointProjection> {
        let hit = self.0.closest_point(pt, max_dist).ok()??;
        Some(PointProjection::new(false, hit.point).with_subshape(hit.triangle.0))
    }

    fn project_local_point(&self, pt: Vec3, solid: bool) -> PointProjection {
        let nearest = self.project_local_point_with_max_dist(pt, solid, f32::INFINITY);
        nearest.unwrap_or(PointProjection::new(false, pt))
    }

    fn project_local_point_and_get_feature(&self, pt: Vec3) -> (PointProjection, FeatureId) {
        let Ok(Some(hit)) = self.0.closest_point(pt, f32::INFINITY) else {
            return (PointProjection::new(false, pt), FeatureId::Unknown);
        };
        let behind = hit.normal.dot(pt - hit.point) < 0.0;
        let projection = PointProjection::new(false, hit.point).with_subshape(hit.triangle.0);
        (projection, FeatureId::Face(behind.into()))
    }
}

#[cfg(test)]
mod tests;
