//! What queries are compared with: every vertex skinned plainly, every triangle tested.

use glam::Vec3;

use super::pose::Pose;
use super::query::{
    Best, Earliest, First, Nearest, Region, Sweep, capsule_hit, check_length, check_point, reach,
    sort_by_time,
};
use super::{CapsuleHit, MovingTriangle, SkinnedSurface, SurfaceError, SurfaceHit, SweepHit};
use crate::geometry::triangle::ShearedRay;
use crate::geometry::{Capsule, Ray, Sphere};
use crate::mesh::{PartId, TriangleId};
use crate::skin::skin_vertex;

/// The queries of a surface by brute force: slow and plain, for tests.
///
/// Skins every vertex in scalar code when it is made, knows no bounds, and tests all enabled
/// triangles one by one. The surface must answer with the same bits; but for sweeps among coordinates that
/// differ by some 2^50 in size, where bounds may rule out what the exact test leaves
/// [`undecided`](SweepHit::undecided).
///
/// ```
/// # use std::sync::Arc;
/// # use clamber_surface::mesh::{BuildOptions, ColliderMesh, Influence, MeshSource};
/// # use clamber_surface::rig::JointId;
/// # use clamber_surface::surface::{BruteForce, SkinnedSurface};
/// # use glam::Vec3;
/// # let source = MeshSource {
/// #     positions: &[Vec3::ZERO, Vec3::X, Vec3::Y],
/// #     triangles: &[[0, 1, 2]],
/// #     influences: &[Influence { joint: JointId(0), weight: 1.0 }; 3],
/// #     joint_count: 1,
/// #     ..MeshSource::default()
/// # };
/// # let mesh = ColliderMesh::build(&source, &BuildOptions::default())?.0;
/// let surface = SkinnedSurface::new(Arc::new(mesh));
/// let brute_force = BruteForce::new(&surface);
/// let point = Vec3::new(0.3, 0.2, 5.0);
/// let found = surface.closest_point(point, f32::INFINITY)?;
/// assert_eq!(found, brute_force.closest_point(point, f32::INFINITY)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct BruteForce<'a> {
    surface: &'a SkinnedSurface,
    positions: Vec<Vec3>,
}

impl<'a> BruteForce<'a> {
    /// Of the surface as it is posed now.
    pub fn new(surface: &'a SkinnedSurface) -> Self {
        let vertices = 0..surface.mesh.positions().len();
        let palette = surface.current.palette();
        Self {
            surface,
            positions: vertices
                .map(|vertex| skin_vertex(&surface.mesh, palette, vertex))
                .collect(),
        }
    }

    /// Every vertex, skinned in scalar code, in model space.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// As [`SkinnedSurface::cast_ray`].
    ///
    /// # Errors
    /// As that one; so do the others.
    pub fn cast_ray(
        &self,
        ray: &Ray,
        max_distance: f32,
    ) -> Result<Option<SurfaceHit>, SurfaceError> {
        let sheared = ShearedRay::new(ray);
        let mut best = Best::within(check_length("the ray's maximum distance", max_distance)?);
        for (triangle, _, corners) in self.triangles() {
            if let Some(found) = sheared.intersect(corners, best.limit()) {
                best.offer(Nearest { triangle, found });
            }
        }
        Ok(best.hit(self.surface, ray.origin()))
    }

    /// As [`SkinnedSurface::intersects_ray`].
    ///
    /// # Errors
    /// As that one.
    pub fn intersects_ray(&self, ray: &Ray, max_distance: f32) -> Result<bool, SurfaceError> {
        Ok(self.cast_ray(ray, max_distance)?.is_some())
    }

    /// As [`SkinnedSurface::cast_ray_all`].
    ///
    /// # Errors
    /// As that one.
    pub fn cast_ray_all(
        &self,
        ray: &Ray,
        max_distance: f32,
        hits: &mut Vec<SurfaceHit>,
    ) -> Result<(), SurfaceError> {
        let limit = check_length("the ray's maximum distance", max_distance)?;
        let sheared = ShearedRay::new(ray);
        let mut met: Vec<(Nearest, SurfaceHit)> = Vec::new();
        for (triangle, part, corners) in self.triangles() {
            if let Some(found) = sheared.intersect(corners, limit) {
                let nearest = Nearest { triangle, found };
                let hit = self.surface.hit(nearest, part, corners, ray.origin());
                met.push((nearest, hit));
            }
        }
        met.sort_by(|(a, _), (b, _)| a.compare(b));
        hits.clear();
        hits.extend(met.into_iter().map(|(_, hit)| hit));
        Ok(())
    }

    /// As [`SkinnedSurface::closest_point`].
    ///
    /// # Errors
    /// As that one.
    pub fn closest_point(
        &self,
        point: Vec3,
        max_distance: f32,
    ) -> Result<Option<SurfaceHit>, SurfaceError> {
        let point = Sphere {
            center: point,
            radius: 0.0,
        };
        self.closest(&point, max_distance)
    }

    /// As [`SkinnedSurface::closest_to_capsule`].
    ///
    /// # Errors
    /// As that one.
    pub fn closest_to_capsule(
        &self,
        capsule: &Capsule,
        max_distance: f32,
    ) -> Result<Option<CapsuleHit>, SurfaceError> {
        let surface = self.closest(capsule, max_distance)?;
        Ok(surface.map(|surface| capsule_hit(capsule, surface)))
    }

    fn closest(
        &self,
        region: &impl Region,
        max_distance: f32,
    ) -> Result<Option<SurfaceHit>, SurfaceError> {
        let mut best = Best::within(reach(region, max_distance)?);
        for (triangle, _, corners) in self.triangles() {
            best.offer(Nearest {
                triangle,
                found: region.closest(corners),
            });
        }
        Ok(best.hit(self.surface, region.middle()))
    }

    /// As [`SkinnedSurface::overlap_sphere`].
    ///
    /// # Errors
    /// As that one.
    pub fn overlap_sphere(
        &self,
        sphere: &Sphere,
        hits: &mut Vec<SurfaceHit>,
    ) -> Result<(), SurfaceError> {
        self.overlap(sphere, hits)
    }

    /// As [`SkinnedSurface::overlap_capsule`].
    ///
    /// # Errors
    /// As that one.
    pub fn overlap_capsule(
        &self,
        capsule: &Capsule,
        hits: &mut Vec<SurfaceHit>,
    ) -> Result<(), SurfaceError> {
        self.overlap(capsule, hits)
    }

    fn overlap(
        &self,
        region: &impl Region,
        hits: &mut Vec<SurfaceHit>,
    ) -> Result<(), SurfaceError> {
        let radius = region.check()?;
        hits.clear();
        for (triangle, part, corners) in self.triangles() {
            let found = region.closest(corners);
            if found.distance <= radius {
                let nearest = Nearest { triangle, found };
                hits.push(self.surface.hit(nearest, part, corners, region.middle()));
            }
        }
        Ok(())
    }

    /// As [`SkinnedSurface::cast_sphere`].
    ///
    /// # Errors
    /// As that one.
    pub fn cast_sphere(
        &self,
        sphere: &Sphere,
        motion: Vec3,
        tolerance: f32,
    ) -> Result<Option<SweepHit>, SurfaceError> {
        let sweep = Sweep::of_sphere(sphere, motion, tolerance)?;
        Ok(self.first_contact([&self.surface.current; 2], &sweep))
    }

    /// As [`SkinnedSurface::cast_capsule`].
    ///
    /// # Errors
    /// As that one.
    pub fn cast_capsule(
        &self,
        capsule: &Capsule,
        motions: [Vec3; 2],
        tolerance: f32,
    ) -> Result<Option<SweepHit>, SurfaceError> {
        let sweep = Sweep::of_capsule(capsule, motions, tolerance)?;
        Ok(self.first_contact([&self.surface.current; 2], &sweep))
    }

    /// As [`SkinnedSurface::sweep_sphere`].
    ///
    /// # Errors
    /// As that one.
    pub fn sweep_sphere(
        &self,
        sphere: &Sphere,
        motion: Vec3,
        tolerance: f32,
    ) -> Result<Option<SweepHit>, SurfaceError> {
        let sweep = Sweep::of_sphere(sphere, motion, tolerance)?;
        Ok(self.first_contact(self.motion(), &sweep))
    }

    /// As [`SkinnedSurface::sweep_capsule`].
    ///
    /// # Errors
    /// As that one.
    pub fn sweep_capsule(
        &self,
        capsule: &Capsule,
        motions: [Vec3; 2],
        tolerance: f32,
    ) -> Result<Option<SweepHit>, SurfaceError> {
        let sweep = Sweep::of_capsule(capsule, motions, tolerance)?;
        Ok(self.first_contact(self.motion(), &sweep))
    }

    /// As [`SkinnedSurface::sweep_sphere_all`].
    ///
    /// # Errors
    /// As that one.
    pub fn sweep_sphere_all(
        &self,
        sphere: &Sphere,
        motion: Vec3,
        tolerance: f32,
        hits: &mut Vec<SweepHit>,
    ) -> Result<(), SurfaceError> {
        let sweep = Sweep::of_sphere(sphere, motion, tolerance)?;
        self.all_contacts(self.motion(), &sweep, hits);
        Ok(())
    }

    /// As [`SkinnedSurface::sweep_capsule_all`].
    ///
    /// # Errors
    /// As that one.
    pub fn sweep_capsule_all(
        &self,
        capsule: &Capsule,
        motions: [Vec3; 2],
        tolerance: f32,
        hits: &mut Vec<SweepHit>,
    ) -> Result<(), SurfaceError> {
        let sweep = Sweep::of_capsule(capsule, motions, tolerance)?;
        self.all_contacts(self.motion(), &sweep, hits);
        Ok(())
    }

    /// As [`SkinnedSurface::visit_box`], by ascending id.
    ///
    /// # Errors
    /// As that one.
    pub fn visit_box(
        &self,
        low: Vec3,
        high: Vec3,
        mut visit: impl FnMut(&MovingTriangle),
    ) -> Result<(), SurfaceError> {
        check_point(low)?;
        check_point(high)?;
        for (triangle, _, _) in self.triangles() {
            let moving = MovingTriangle {
                triangle,
                previous: self.surface.previous_corners(triangle),
                current: self.surface.corners(triangle),
            };
            if low.cmple(high).all() && moving.meets_box(low, high) {
                visit(&moving);
            }
        }
        Ok(())
    }

    fn motion(&self) -> [&Pose; 2] {
        [&self.surface.previous, &self.surface.current]
    }

    fn first_contact<const N: usize>(
        &self,
        poses: [&Pose; 2],
        sweep: &Sweep<N>,
    ) -> Option<SweepHit> {
        let mut earliest = Earliest::NONE;
        for first in self.contacts(poses, sweep) {
            earliest.offer(first);
        }
        earliest.hit(self.surface, sweep)
    }

    fn all_contacts<const N: usize>(
        &self,
        poses: [&Pose; 2],
        sweep: &Sweep<N>,
        hits: &mut Vec<SweepHit>,
    ) {
        hits.clear();
        let contacts = self.contacts(poses, sweep);
        hits.extend(contacts.filter_map(|first| self.surface.sweep_hit(sweep, first)));
        sort_by_time(hits);
    }

    /// The first contact of every triangle that has one.
    fn contacts<const N: usize>(
        &self,
        poses: [&Pose; 2],
        sweep: &Sweep<N>,
    ) -> impl Iterator<Item = First> {
        let mesh = &self.surface.mesh;
        self.triangles().filter_map(move |(triangle, _, _)| {
            let vertices = mesh.triangles()[triangle.index()];
            let corners =
                poses.map(|pose| vertices.map(|vertex| pose.position(mesh, vertex.index())));
            let contact = sweep.advance(corners, 1.0)?;
            Some(First {
                triangle,
                corners,
                contact,
            })
        })
    }

    /// All enabled triangles, by ascending id, with their parts and posed corners.
    fn triangles(&self) -> impl Iterator<Item = (TriangleId, PartId, [Vec3; 3])> {
        let mesh = &self.surface.mesh;
        let all = mesh.triangles().iter().enumerate();
        all.filter_map(|(index, corners)| {
            let triangle = TriangleId(index as u32);
            let part = mesh.part_of(triangle)?;
            self.surface
                .is_enabled(triangle)
                .then(|| (triangle, part, corners.map(|v| self.positions[v.index()])))
        })
    }
}
