//! Rotations with libm's trigonometry, so that their bits do not depend on the platform.

use glam::{DQuat, DVec3};

/// Below this distance of the cosine from 1 (an angle of 1.4e-4 rad) the arc is replaced by its
/// chord: the two differ by less than 1e-13 there, while `sin` of the angle loses digits.
const SMALL_ANGLE: f64 = 1e-8;

/// Rotation by `angle` radians about the unit vector `axis`, right-handed.
pub fn rotation_from_axis_angle(axis: DVec3, angle: f64) -> DQuat {
    let s = libm::sin(angle * 0.5);
    DQuat::from_xyzw(axis.x * s, axis.y * s, axis.z * s, libm::cos(angle * 0.5))
}

/// Axis times angle (radians, at most pi) of a unit quaternion; zero for the identity.
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

/// Spherical interpolation along the shorter arc (Shoemake 1985), from `a` at 0 to `b` at 1.
/// Both must be unit quaternions; the result is one.
pub fn slerp(a: DQuat, b: DQuat, t: f64) -> DQuat {
    let mut cos = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
    let mut b = b;
    if cos < 0.0 {
        b = -b;
        cos = -cos;
    }
    if cos > 1.0 - SMALL_ANGLE {
        return (a * (1.0 - t) + b * t).normalize();
    }
    let angle = libm::acos(cos);
    let (wa, wb) = (libm::sin((1.0 - t) * angle), libm::sin(t * angle));
    (a * wa + b * wb).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slerp_takes_the_shorter_arc_at_constant_speed() {
        let a = DQuat::IDENTITY;
        let b = rotation_from_axis_angle(DVec3::Y, 1.2);
        for (end, sign) in [(b, 1.0), (-b, 1.0)] {
            for k in 0..=8 {
                let t = f64::from(k) / 8.0;
                let turned = rotation_vector(slerp(a, end, t));
                assert!(
                    (turned - DVec3::Y * (1.2 * t * sign)).length() < 1e-12,
                    "t {t}: {turned}"
                );
            }
        }
    }

    #[test]
    fn slerp_is_continuous_where_arc_becomes_chord() {
        for angle in [1e-9, 1.3e-4, 1.5e-4, 1e-3] {
            let b = rotation_from_axis_angle(DVec3::X, angle);
            let half = rotation_vector(slerp(DQuat::IDENTITY, b, 0.5)).length();
            // The input itself carries the rounding of cos(angle / 2): about 1e-16 / angle.
            assert!((half - angle * 0.5).abs() < 1e-12, "angle {angle}: {half}");
        }
    }

    #[test]
    fn rotation_vector_of_half_a_turn_and_of_none() {
        let half = rotation_from_axis_angle(DVec3::Z, core::f64::consts::PI);
        assert!((rotation_vector(half).length() - core::f64::consts::PI).abs() < 1e-12);
        assert_eq!(rotation_vector(DQuat::IDENTITY), DVec3::ZERO);
    }
}
