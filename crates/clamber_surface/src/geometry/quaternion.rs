//! Rotations with libm's trigonometry, so that their bits do not depend on the platform.

use glam::{DQuat, DVec3};

/// Rotation by `angle` radians about the unit vector `axis`, right-handed. Unlike glam's `from_axis_angle`, it has the
/// same bits on every platform.
pub fn rotation_from_axis_angle(axis: DVec3, angle: f64) -> DQuat {
    let (s, c) = libm::sincos(angle * 0.5);
    DQuat::from_xyzw(axis.x * s, axis.y * s, axis.z * s, c)
}

/// The rotation vector of a unit quaternion: its axis times its angle in radians, at most pi; zero for the identity.
pub fn rotation_vector(rotation: DQuat) -> DVec3 {
    // q and -q are the same rotation; the one with w >= 0 turns by at most half a turn.
    let q = if rotation.w < 0.0 {
        -rotation
    } else {
        rotation
    };
    let v = DVec3::new(q.x, q.y, q.z);
    let s = v.length();
    if s < 1e-30 {
        return v * 2.0;
    }
    v * (2.0 * libm::atan2(s, q.w) / s)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotation_vector_of_half_a_turn_and_of_none() {
        let half = rotation_from_axis_angle(DVec3::Z, core::f64::consts::PI);
        assert!((rotation_vector(half).length() - core::f64::consts::PI).abs() < 1e-12);
        assert_eq!(rotation_vector(DQuat::IDENTITY), DVec3::ZERO);
    }
}
