//! Joint rotations of poses, read and stored in f64.

use clamber_surface::rig::Transform;
use glam::DQuat;

/// The rotation of a transform as a unit quaternion, to 4e-13.
///
/// A quaternion that f32 has rounded is nearly unit: one Newton step of the inverse square root, without division or
/// square root, normalises it.
pub(crate) fn rotation_of(transform: &Transform) -> DQuat {
    let q = transform.rotation.as_dquat();
    let beyond = q.length_squared() - 1.0;
    if beyond.abs() < 1e-6 {
        q * (1.0 - 0.5 * beyond)
    } else {
        q.normalize()
    }
}

/// Stores a rotation in a transform, rounded to f32.
pub(crate) fn store_rotation(transform: &mut Transform, rotation: DQuat) {
    transform.rotation = rotation.as_quat();
}
