use clamber_surface::geometry::rotation_from_axis_angle;
use glam::{DQuat, DVec3};

use super::IkError;

/// Limits of a ball joint's rotation from rest: a cone for the direction of its bone, and a range for the twist about
/// the bone.
///
/// A rotation is split into a twist about the bone, and a swing after it, whose axis is perpendicular to the bone
/// (Dobrowolski 2015, "Swing-twist decomposition in Clifford algebra").
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SwingTwist {
    /// Unit vector along the bone, in the joint's own space.
    axis: DVec3,
    /// Sine and cosine of half the largest swing.
    half_swing: [f64; 2],
    /// Least and largest twist, radians.
    twist: [f64; 2],
}

impl SwingTwist {
    /// Limits for a bone along `axis` in the joint's own space. `swing` is the bone's largest angle from rest, `twist`
    /// the range of angles about the bone: radians, -pi to pi.
    ///
    /// # Errors
    /// [`IkError::BadSetUp`] if the axis has no length, the swing is not from 0 to pi, or the range is not within -pi
    /// to pi or does not contain 0.
    pub fn new(axis: DVec3, swing: f64, twist: [f64; 2]) -> Result<Self, IkError> {
        use core::f64::consts::PI;
        let axis = axis.try_normalize();
        let axis = axis.ok_or(IkError::BadSetUp("a bone's axis has no length"))?;
        if !(0.0..=PI).contains(&swing) {
            return Err(IkError::BadSetUp("a swing is not from 0 to pi, in radians"));
        }
        if !((-PI..=0.0).contains(&twist[0]) && (0.0..=PI).contains(&twist[1])) {
            return Err(IkError::BadSetUp(
                "a range of twist is not within -pi to pi around 0, in radians",
            ));
        }
        Ok(Self {
            axis,
            half_swing: [libm::sin(swing * 0.5), libm::cos(swing * 0.5)],
            twist,
        })
    }

    /// Clamps swing and twist to the limits. Returns the rotation, and whether a limit changed it. `rotation` is a unit
    /// quaternion, relative to the joint's rest rotation, in its rest space.
    pub fn clamp(&self, rotation: DQuat) -> (DQuat, bool) {
        let q = if rotation.w < 0.0 {
            -rotation
        } else {
            rotation
        };
        let along = DVec3::new(q.x, q.y, q.z).dot(self.axis);
        let twist = DQuat::from_xyzw(
            self.axis.x * along,
            self.axis.y * along,
            self.axis.z * along,
            q.w,
        );
        // With a swing of half a turn, the twist is undefined.
        let twist = if twist.length_squared() > 1e-20 {
            twist.normalize()
        } else {
            DQuat::IDENTITY
        };
        let swing = q * twist.conjugate();
        let [sin, cos] = self.half_swing;
        let (swing, swing_is_limited) = if swing.w.abs() >= cos - 1e-12 {
            (swing, false)
        } else {
            let axis = DVec3::new(swing.x, swing.y, swing.z) * swing.w.signum();
            let axis = axis.normalize_or(self.axis.any_orthonormal_vector()) * sin;
            (DQuat::from_xyzw(axis.x, axis.y, axis.z, cos), true)
        };
        let angle = 2.0 * libm::atan2(along, q.w);
        let allowed = angle.clamp(self.twist[0], self.twist[1]);
        let twist_is_limited = (allowed - angle).abs() > 1e-12;
        let twist = if twist_is_limited {
            rotation_from_axis_angle(self.axis, allowed)
        } else {
            twist
        };
        (
            (swing * twist).normalize(),
            swing_is_limited || twist_is_limited,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spring::rotation_from_vector;
    use clamber_surface::geometry::rotation_vector;

    #[test]
    fn rotations_come_within_the_limits_and_stay_if_they_are() {
        let mut rng = fastrand::Rng::with_seed(8);
        let mut unit = |size: f64| DVec3::from([(); 3].map(|()| (rng.f64() * 2.0 - 1.0) * size));
        let axis = DVec3::new(1.0, 2.0, -0.5).normalize();
        let limits = SwingTwist::new(axis, 0.9, [-0.4, 1.1]).unwrap();
        let (mut changed, mut kept) = (0, 0);
        for k in 0..20_000 {
            let size = if k % 2 == 0 { 0.5 } else { 3.0 };
            let q = rotation_from_vector(unit(size));
            let (limited, is_limited) = limits.clamp(q);
            let bone = limited * axis;
            assert!(bone.dot(axis) >= libm::cos(0.9) - 1e-9, "{q}");
            // Within the limits nothing changes; clamping twice is the same as clamping once.
            let (again, is_limited_again) = limits.clamp(limited);
            assert!(!is_limited_again, "{q}: {limited}");
            assert!(rotation_vector(again * limited.conjugate()).length() < 1e-9);
            let same = rotation_vector(limited * q.conjugate()).length() < 1e-9;
            assert_eq!(same, !is_limited, "{q}");
            if is_limited {
                changed += 1;
            } else {
                kept += 1;
            }
        }
        assert!(changed > 5_000 && kept > 1_000, "{changed} {kept}");
    }

    #[test]
    fn limits_out_of_range_are_refused() {
        assert!(SwingTwist::new(DVec3::ZERO, 1.0, [0.0, 0.0]).is_err());
        assert!(SwingTwist::new(DVec3::X, -1.0, [0.0, 0.0]).is_err());
        assert!(SwingTwist::new(DVec3::X, f64::NAN, [0.0, 0.0]).is_err());
        assert!(SwingTwist::new(DVec3::X, 1.0, [0.5, 1.0]).is_err());
    }
}
