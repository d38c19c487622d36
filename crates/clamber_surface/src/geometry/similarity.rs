mod from_affine;

pub use from_affine::SimilarityError;

use glam::{DAffine3, DQuat, DVec3, Vec3};

use super::{round_to_f32, widen};

/// Largest deviation from 1 of the length of a rotation that [`Similarity::is_valid`] accepts: an order of magnitude
/// above the error left by composing rotations in f32.
const UNIT_TOLERANCE: f64 = 1e-5;

/// A map that preserves shapes: uniform scale, then rotation, then translation, in f64.
///
/// A surface's `world_from_model` is a similarity. Its translation is in f64, and all surface arithmetic happens in the
/// creature's own model space, so a creature 100 km away is as exact as one at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Similarity {
    /// Unit quaternion.
    pub rotation: DQuat,
    /// Length in the target space of one unit of the source space, positive. For `world_from_model`: metres per model
    /// unit.
    pub scale: f64,
    /// The image of the source's origin, in the target space.
    pub translation: DVec3,
}

impl Similarity {
    /// Maps every point to itself.
    pub const IDENTITY: Self = Self {
        rotation: DQuat::IDENTITY,
        scale: 1.0,
        translation: DVec3::ZERO,
    };

    /// A pure translation.
    pub fn from_translation(translation: DVec3) -> Self {
        Self {
            translation,
            ..Self::IDENTITY
        }
    }

    /// A pure rotation by a unit quaternion, which is not checked: see [`Similarity::is_valid`].
    pub fn from_rotation(rotation: DQuat) -> Self {
        Self {
            rotation,
            ..Self::IDENTITY
        }
    }

    /// A pure scale by a positive factor, which is not checked: see [`Similarity::is_valid`].
    pub fn from_scale(scale: f64) -> Self {
        Self {
            scale,
            ..Self::IDENTITY
        }
    }

    /// True if all parts are finite, the scale is positive and normal, and the rotation has length one to within 1e-5.
    pub fn is_valid(&self) -> bool {
        self.scale.is_normal()
            && self.scale > 0.0
            && self.translation.is_finite()
            && self.rotation.is_finite()
            && (self.rotation.length() - 1.0).abs() <= UNIT_TOLERANCE
    }

    /// The image of a point.
    pub fn transform_point(&self, p: DVec3) -> DVec3 {
        self.rotation * (p * self.scale) + self.translation
    }

    /// The image of a vector: rotated and scaled, not translated.
    pub fn transform_vector(&self, v: DVec3) -> DVec3 {
        self.rotation * (v * self.scale)
    }

    /// The source point whose image is `p`.
    pub fn inverse_transform_point(&self, p: DVec3) -> DVec3 {
        self.rotation.conjugate() * (p - self.translation) / self.scale
    }

    /// The source vector whose image is `v`.
    pub fn inverse_transform_vector(&self, v: DVec3) -> DVec3 {
        self.rotation.conjugate() * v / self.scale
    }

    /// The image of a point given in f32.
    pub fn transform_point_f32(&self, p: Vec3) -> DVec3 {
        self.transform_point(widen(p))
    }

    /// The source point whose image is `p`, rounded once to f32.
    pub fn inverse_transform_point_f32(&self, p: DVec3) -> Vec3 {
        round_to_f32(self.inverse_transform_point(p))
    }

    /// Converts to a general affine map. `Similarity::try_from` converts back.
    pub fn to_affine(&self) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(
            DVec3::splat(self.scale),
            self.rotation,
            self.translation,
        )
    }

    /// The map `inverse(self) * other`, from `other`'s source space to the source space of `self`. The translations are
    /// subtracted first, so their common size costs no precision.
    pub fn relative(&self, other: &Self) -> DAffine3 {
        let rotation = self.rotation.conjugate();
        DAffine3::from_scale_rotation_translation(
            DVec3::splat(other.scale / self.scale),
            (rotation * other.rotation).normalize(),
            rotation * (other.translation - self.translation) / self.scale,
        )
    }

    /// The same map with its rotation normalised.
    pub(crate) fn normalized(&self) -> Self {
        Self {
            rotation: self.rotation.normalize(),
            ..*self
        }
    }
}

impl Default for Similarity {
    fn default() -> Self {
        Self::IDENTITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::rotation_from_axis_angle;

    #[test]
    fn inverse_and_relative_agree_with_composition() {
        let a = Similarity {
            rotation: rotation_from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.7),
            scale: 3.0,
            translation: DVec3::new(1e5, -2.0, 4.0),
        };
        let b = Similarity {
            rotation: rotation_from_axis_angle(DVec3::Y, -1.1),
            scale: 2.0,
            translation: DVec3::new(1e5 + 1.0, 2.0, 5.0),
        };
        let p = DVec3::new(0.3, -0.2, 0.9);
        let round_trip = a.inverse_transform_point(a.transform_point(p));
        assert!((round_trip - p).length() < 1e-10, "{round_trip}");
        let direct = a.relative(&b).transform_point3(p);
        let composed = a.inverse_transform_point(b.transform_point(p));
        assert!((direct - composed).length() < 1e-10, "{direct} {composed}");
    }

    #[test]
    fn bad_scales_rotations_and_translations_are_not_valid() {
        let ok = Similarity::IDENTITY;
        assert!(ok.is_valid());
        for scale in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-320] {
            assert!(!Similarity { scale, ..ok }.is_valid(), "{scale}");
        }
        let rotation = DQuat::from_xyzw(0.0, 0.0, 0.0, 1.1);
        assert!(!Similarity { rotation, ..ok }.is_valid());
        let translation = DVec3::new(0.0, f64::NAN, 0.0);
        assert!(!Similarity { translation, ..ok }.is_valid());
    }
}
