use glam::{DAffine3, DQuat, DVec3, Quat, Vec3};

use crate::geometry::widen;

/// Translation, rotation and scale of a joint relative to its parent: glTF's node transform.
/// A point is scaled first, then rotated, then translated.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Transform {
    /// Translation in the space of the parent.
    pub translation: Vec3,
    /// Rotation. The quaternion may have any finite length except zero, since it is normalised where it is used.
    pub rotation: Quat,
    /// Scale per axis; may be negative or zero.
    pub scale: Vec3,
}

impl Transform {
    /// The identity: maps every point to itself.
    pub const IDENTITY: Self = Self {
        translation: Vec3::ZERO,
        rotation: Quat::IDENTITY,
        scale: Vec3::ONE,
    };

    /// A pure translation.
    pub fn from_translation(translation: Vec3) -> Self {
        Self {
            translation,
            ..Self::IDENTITY
        }
    }

    /// True if every number is finite and the rotation does not have length zero.
    pub fn is_valid(&self) -> bool {
        let rotation = rotation_f64(self.rotation).length_squared();
        self.translation.is_finite()
            && self.scale.is_finite()
            && rotation.is_finite()
            && rotation > 0.0
    }

    /// The transform as a matrix in f64, with the rotation normalised.
    pub fn to_affine(self) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(
            widen(self.scale),
            unit_rotation(self.rotation),
            widen(self.translation),
        )
    }
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

/// Largest difference from 1 of the squared length of a quaternion that counts as nearly unit.
const NEARLY_UNIT: f64 = 1e-6;

/// Widens a quaternion; exact.
pub(crate) fn rotation_f64(q: Quat) -> DQuat {
    q.as_dquat()
}

/// Normalises a rotation. The result is not finite if the length is zero.
///
/// A nearly unit quaternion, the usual case, takes a single step of Newton's method for the inverse root of its
/// squared length, without division or root. The remaining error is 3/8 of the square of the squared length's
/// difference from 1: below 4e-13.
pub(crate) fn unit_rotation(q: Quat) -> DQuat {
    let q = rotation_f64(q);
    let beyond = q.length_squared() - 1.0;
    if beyond.abs() < NEARLY_UNIT {
        q * (1.0 - 0.5 * beyond)
    } else {
        q.normalize()
    }
}

/// Rounds a quaternion's components once.
pub(crate) fn rotation_f32(q: DQuat) -> Quat {
    q.as_quat()
}

/// Linear interpolation in f64: `a` at `t` = 0, `b` at `t` = 1.
pub(crate) fn lerp(a: Vec3, b: Vec3, t: f64) -> DVec3 {
    widen(a) * (1.0 - t) + widen(b) * t
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec4;

    /// Covers the lengths for which the step is used, and some beyond them.
    #[test]
    fn normalised_rotations_keep_the_stated_error() {
        let direction = DVec4::new(0.3, -0.5, 0.1, 0.8).normalize();
        for step in -400..=400 {
            let length = 1.0 + f64::from(step) * 2e-9;
            let q = DQuat::from_vec4(direction * length).as_quat();
            let unit = unit_rotation(q);
            let off = (unit.length() - 1.0).abs();
            assert!(off < 4e-13, "{length}: {off:e}");
            let apart = unit - rotation_f64(q).normalize();
            assert!(apart.length() < 4e-13, "{length}: {apart}");
        }
        assert!(!unit_rotation(Quat::from_xyzw(0.0, 0.0, 0.0, 0.0)).is_finite());
    }
}
