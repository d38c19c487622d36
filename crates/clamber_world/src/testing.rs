//! Helpers that the unit tests share: surfaces of few triangles, and casts of capsules.

use std::fmt::Display;
use std::sync::Arc;

use clamber_surface::geometry::Affine;
use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, MeshSource};
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, Vec3};

use crate::{Obstacle, SweepContact, TargetMotion, WorldCapsule};

pub(crate) fn surface_of(source: &MeshSource<'_>) -> SkinnedSurface {
    let (mesh, _) = ColliderMesh::build(source, &ColliderBuildOptions::default()).unwrap();
    SkinnedSurface::new(Arc::new(mesh))
}

/// A surface of triangles on one joint.
pub(crate) fn rigid(positions: &[Vec3], triangles: &[[u32; 3]]) -> SkinnedSurface {
    surface_of(&MeshSource::rigid(positions, triangles))
}

/// The palette of one joint at rest.
pub(crate) fn rest() -> Palette {
    Palette::from_matrices([Affine::IDENTITY])
}

/// A random point in the cube from `-size` to `size` along each axis.
pub(crate) fn point(rng: &mut fastrand::Rng, size: f64) -> DVec3 {
    DVec3::new(rng.f64() - 0.5, rng.f64() - 0.5, rng.f64() - 0.5) * 2.0 * size
}

/// Casts a capsule against an obstacle where it stands now.
pub(crate) fn cast(
    obstacle: &dyn Obstacle,
    capsule: &WorldCapsule,
    by: DVec3,
) -> Option<SweepContact> {
    obstacle.cast_capsule(capsule, [by; 2], TargetMotion::Still)
}

/// Casts a capsule against an obstacle as it moves over the tick.
pub(crate) fn sweep(
    obstacle: &dyn Obstacle,
    capsule: &WorldCapsule,
    by: DVec3,
) -> Option<SweepContact> {
    obstacle.cast_capsule(capsule, [by; 2], TargetMotion::Moving)
}

/// Asserts that two vectors are less than a distance apart.
#[track_caller]
pub(crate) fn assert_near(found: DVec3, expected: DVec3, within: f64, told: impl Display) {
    let apart = (found - expected).length();
    assert!(apart < within, "{told}: {found} against {expected}");
}
