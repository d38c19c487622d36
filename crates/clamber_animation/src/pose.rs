//! Rotations of poses in f64.

use clamber_surface::rig::Transform;
use glam::DQuat;

/// The rotation of a transform, normalised.
pub(crate) fn rotation_of(transform: &Transform) -> DQuat {
    transform.rotation.as_dquat().normalize()
}

/// Stores a rotation, rounded once.
pub(crate) fn store_rotation(transform: &mut Transform, rotation: DQuat) {
    transform.rotation = rotation.as_quat();
}
