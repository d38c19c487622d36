use std::sync::Arc;

use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::{
    ColliderBuildOptions, ColliderMesh, MeshError, MeshSource, SurfaceTag,
};
use clamber_surface::rig::Palette;
use clamber_surface::surface::{SkinnedSurface, SurfaceError};
use glam::{DVec3, Vec3};
use thiserror::Error;

use crate::{
    Contact, MaterialPoint, Obstacle, PointMotion, SweepContact, TargetMotion, WorldCapsule,
    WorldPath,
};

/// Terrain of plain triangles, without a physics engine: a level, a height field, a rock.
///
/// The terrain does not move. Like skin it is a sheet: a body that is put behind it is not pushed out. Positions are
/// relative to an origin of its own in f64, so that a level far from the world's origin is as exact as one near it.
///
/// ```
/// use clamber_world::{Obstacle, SurfaceTag, TriangleTerrain};
/// use glam::{DVec3, Vec3};
///
/// let corners = [Vec3::ZERO, Vec3::new(0.0, 0.0, 8.0), Vec3::new(8.0, 0.0, 8.0), Vec3::new(8.0, 0.0, 0.0)];
/// let level = TriangleTerrain::new(&corners, &[[0, 1, 2], [0, 2, 3]], &[], DVec3::ZERO)?;
/// let hit = level.cast_ray(DVec3::new(2.0, 5.0, 3.0), DVec3::NEG_Y, 10.0).ok_or("missed")?;
/// assert_eq!(hit.point, DVec3::new(2.0, 0.0, 3.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct TriangleTerrain {
    surface: SkinnedSurface,
}

/// Why triangles cannot be terrain.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TerrainError {
    /// The triangles cannot be a mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Positions or origin are too large.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
}

impl TriangleTerrain {
    /// Terrain of triangles, which are given by indices of their corners, counter-clockwise seen from outside. `tags`
    /// has one tag for each triangle, or none at all for [`SurfaceTag::default`]. `origin` is where the positions'
    /// origin is in the world.
    ///
    /// # Errors
    /// [`TerrainError`] if an index is out of range, a number is not finite, or the number of tags is wrong.
    pub fn new(
        positions: &[Vec3],
        triangles: &[[u32; 3]],
        tags: &[SurfaceTag],
        origin: DVec3,
    ) -> Result<Self, TerrainError> {
        let source = MeshSource {
            tags,
            ..MeshSource::rigid(positions, triangles)
        };
        let (mesh, _) = ColliderMesh::build(&source, &ColliderBuildOptions::default())?;
        let mut surface = SkinnedSurface::new(Arc::new(mesh));
        let still = Palette::from_matrices([Affine::IDENTITY]);
        surface.teleport(&still, Similarity::from_translation(origin))?;
        surface.advance(&still, Similarity::from_translation(origin))?;
        // A sleeping surface is known to be at rest, so its points do not count as teleported.
        surface.sleep();
        Ok(Self { surface })
    }
}

impl Obstacle for TriangleTerrain {
    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        self.surface.overlap_capsule(capsule, contacts);
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        Obstacle::cast_capsule(&self.surface, capsule, displacements, target)
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        self.surface.motion(point, dt)
    }

    fn path(&self, point: &MaterialPoint, dt: f64) -> Option<WorldPath> {
        self.surface.path(point, dt)
    }

    fn rests(&self, _: &MaterialPoint) -> bool {
        true
    }

    fn bounds(&self) -> Option<(DVec3, f64)> {
        self.surface.bounds()
    }

    fn cast_capsule_where(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
        counts: &mut dyn FnMut(&SweepContact) -> bool,
    ) -> Option<SweepContact> {
        Obstacle::cast_capsule_where(&self.surface, capsule, displacements, target, counts)
    }

    fn cast_capsule_past_overlaps(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
        counts: &mut dyn FnMut(&SweepContact) -> bool,
    ) -> Option<SweepContact> {
        self.surface
            .cast_capsule_past_overlaps(capsule, displacements, target, counts)
    }

    fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<Contact> {
        Obstacle::cast_ray(&self.surface, origin, direction, max_distance)
    }

    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        Obstacle::closest_point(&self.surface, point, max_distance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::HalfSpace;

    /// A level square of 20 m at a height, in cells of 1 m.
    fn level(height: f32, origin: DVec3) -> TriangleTerrain {
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for row in 0..=20 {
            for column in 0..=20 {
                positions.push(Vec3::new(column as f32 - 10.0, height, row as f32 - 10.0));
            }
        }
        for row in 0..20 {
            for column in 0..20 {
                let a = row * 21 + column;
                triangles.extend([[a, a + 21, a + 22], [a, a + 22, a + 1]]);
            }
        }
        TriangleTerrain::new(&positions, &triangles, &[], origin).unwrap()
    }

    #[test]
    fn level_triangles_answer_as_a_half_space_does() {
        let mut rng = fastrand::Rng::with_seed(4);
        let origin = DVec3::new(1e5, 20.0, -3e5);
        let (triangles, half) = (level(1.5, origin), HalfSpace::below(21.5));
        let mut overlapped = 0;
        for _ in 0..500 {
            let mut lot = |size: f64| (2.0 * rng.f64() - 1.0) * size;
            let at = origin + DVec3::new(lot(8.0), 2.0 + lot(0.3), lot(8.0));
            let ball = WorldCapsule::ball(at, 0.4);
            let way = DVec3::new(lot(1.0), -1.0 + lot(0.2), lot(1.0));
            let (a, b) = (
                triangles.cast_capsule(&ball, [way; 2], TargetMotion::Moving),
                half.cast_capsule(&ball, [way; 2], TargetMotion::Moving),
            );
            let time = |hit: &Option<SweepContact>| hit.map_or(2.0, |hit| hit.fraction);
            assert!((time(&a) - time(&b)).abs() < 1e-3, "{a:?} {b:?}");
            // Some balls overlap the ground at the start.
            let target = [TargetMotion::Moving, TargetMotion::Still][usize::from(lot(1.0) > 0.0)];
            let sunk = ball.moved(DVec3::Y * lot(1.0));
            let mut none_inside = |contact: &SweepContact| !contact.started_inside;
            let wanted = triangles.cast_capsule_where(&sunk, [way; 2], target, &mut none_inside);
            let past = triangles.cast_capsule_past_overlaps(&sunk, [way; 2], target, &mut |_| true);
            assert_eq!(past, wanted);
            overlapped += usize::from(past != triangles.cast_capsule(&sunk, [way; 2], target));
            let [p, q] = [
                triangles.closest_point(at, 5.0),
                half.closest_point(at, 5.0),
            ]
            .map(|contact| contact.unwrap());
            assert!(p.point.distance(q.point) < 1e-5, "{p:?} {q:?}");
            let motion = triangles.motion(&p.material, 1.0 / 60.0).unwrap();
            assert!(
                motion.velocity == DVec3::ZERO && !motion.was_teleported,
                "{motion:?}"
            );
        }
        assert!(overlapped > 50, "{overlapped}");
    }

    #[test]
    fn what_is_no_mesh_is_refused() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Z];
        let made = |triangles: &[[u32; 3]], origin| {
            TriangleTerrain::new(&corners, triangles, &[], origin).is_ok()
        };
        assert!(made(&[[0, 2, 1]], DVec3::ZERO));
        assert!(!made(&[[0, 2, 3]], DVec3::ZERO));
        assert!(!made(&[[0, 2, 1]], DVec3::NAN));
        let nan = [Vec3::NAN, Vec3::X, Vec3::Z];
        assert!(TriangleTerrain::new(&nan, &[[0, 2, 1]], &[], DVec3::ZERO).is_err());
    }
}
