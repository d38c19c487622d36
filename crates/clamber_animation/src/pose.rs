//! Rotations of poses in f64.

use clamber_surface::rig::Transform;
use glam::DQuat;

/// The rotation of a transform, normalised to 4e-13: one step of Newton's method for the inverse root, without division
/// or root, where it is nearly unit, which is where f32 rounds rotations to.
pub(crate) fn rotation_of(transform: &Transform) -> DQuat {
    let q = transform.rotation.as_dquat();
    let beyond = q.length_squared() - 1.0;
    if beyond.abs() < 1e-6 {
        q * (1.0 - 0.5 * beyond)
    } else {
        q.normalize()
    }
}

/// Stores a rotation, rounded once.
pub(crate) fn store_rotation(transform: &mut Transform, rotation: DQuat) {
    transform.rotation = rotation.as_quat();
}
