use super::transform::{lerp, rotation_f32, unit_rotation};
use super::{JointId, RigError, Transform};
use crate::geometry::{Slerp, round_to_f32};

/// The local transform of every joint of a skeleton, in joint order.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pose {
    /// One transform per joint, relative to its parent.
    pub transforms: Vec<Transform>,
}

impl Pose {
    /// Blends `self` (at weight 0) with `other` (at weight 1): translations and scales linearly, rotations along
    /// the shorter arc. A transform that is equal in both poses stays as it is, bit for bit. Weights outside 0 to 1
    /// are clamped.
    ///
    /// # Errors
    /// [`RigError::JointCount`] if the poses differ in length. [`RigError::NotFinite`] if the weight is NaN, a
    /// transform is not finite, or a rotation has length zero.
    pub fn blend(&self, other: &Self, weight: f64) -> Result<Self, RigError> {
        let mut blended = self.clone();
        blended.blend_in(other, weight)?;
        Ok(blended)
    }

    pub(super) fn check_joint_count(&self, expected: usize) -> Result<(), RigError> {
        let found = self.transforms.len();
        if found == expected {
            Ok(())
        } else {
            Err(RigError::JointCount { expected, found })
        }
    }

    /// [`Pose::blend`] in place: `self` moves towards `other`. Allocates nothing.
    ///
    /// # Errors
    /// As [`Pose::blend`]; then `self` is unchanged.
    pub fn blend_in(&mut self, other: &Self, weight: f64) -> Result<(), RigError> {
        other.check_joint_count(self.transforms.len())?;
        if weight.is_nan() {
            return Err(RigError::NotFinite {
                what: "the blend weight".into(),
            });
        }
        self.validate()?;
        other.validate()?;
        let t = weight.clamp(0.0, 1.0);
        let slerp = Slerp::new(t);
        for (mine, theirs) in self.transforms.iter_mut().zip(&other.transforms) {
            if mine == theirs {
                continue;
            }
            mine.translation = round_to_f32(lerp(mine.translation, theirs.translation, t));
            mine.scale = round_to_f32(lerp(mine.scale, theirs.scale, t));
            let from = unit_rotation(mine.rotation);
            let to = unit_rotation(theirs.rotation);
            mine.rotation = rotation_f32(slerp.between(from, to));
        }
        Ok(())
    }

    /// Rejects transforms that are not finite or whose rotation has length zero.
    pub(crate) fn validate(&self) -> Result<(), RigError> {
        match self.transforms.iter().position(|t| !t.is_valid()) {
            None => Ok(()),
            Some(joint) => Err(RigError::NotFinite {
                what: format!("the transform of joint {}", JointId(joint as u32)),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{rotation_from_axis_angle, rotation_vector};
    use crate::rig::rotation_f64;
    use glam::{DVec3, Quat, Vec3};

    fn pose(angle: f64, x: f32) -> Pose {
        Pose {
            transforms: vec![Transform {
                translation: Vec3::new(x, 0.0, 0.0),
                rotation: rotation_f32(rotation_from_axis_angle(DVec3::Z, angle)),
                scale: Vec3::ONE,
            }],
        }
    }

    #[test]
    fn a_blend_is_right_at_its_ends_and_in_the_middle() {
        let (a, b) = (pose(0.2, 1.0), pose(1.0, 3.0));
        assert_eq!(a.blend(&b, 0.0).unwrap().transforms[0].translation.x, 1.0);
        assert_eq!(a.blend(&b, 7.0).unwrap(), a.blend(&b, 1.0).unwrap());
        assert_eq!(a.blend(&a, 0.3).unwrap(), a);
        let middle = a.blend(&b, 0.5).unwrap().transforms[0];
        assert_eq!(middle.translation.x, 2.0);
        let turned = rotation_vector(rotation_f64(middle.rotation));
        assert!((turned - DVec3::Z * 0.6).length() < 1e-6, "{turned}");
    }

    #[test]
    fn bad_input_changes_nothing() {
        let mut a = pose(0.2, 1.0);
        let before = a.clone();
        let longer = Pose {
            transforms: vec![Transform::IDENTITY; 2],
        };
        let (expected, found) = (1, 2);
        let refused = RigError::JointCount { expected, found };
        assert_eq!(a.blend_in(&longer, 0.5), Err(refused));
        assert!(a.blend_in(&before.clone(), f64::NAN).is_err());
        let mut broken = pose(0.0, 0.0);
        broken.transforms[0].rotation = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
        assert!(a.blend_in(&broken, 0.5).is_err());
        assert_eq!(a, before);
    }
}
