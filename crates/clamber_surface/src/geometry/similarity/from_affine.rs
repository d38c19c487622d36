//! Conversion of an affine map to a [`Similarity`].

use glam::{DAffine3, DMat3, DQuat};
use thiserror::Error;

use super::{Similarity, UNIT_TOLERANCE};

/// The reason why an affine map is not a [`Similarity`].
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SimilarityError {
    /// An element is infinite or NaN.
    #[error("the map has an element that is not finite")]
    NotFinite,
    /// The scale is zero, or too small or too large for a normal number.
    #[error("the map's scale must be a normal number, found {0}")]
    Scale(f64),
    /// The images of the axes differ in length, or are not at right angles: the map stretches or shears.
    #[error("the map stretches or shears: its axes deviate by {found}, more than {limit}")]
    NotUniform {
        /// Largest deviation, after the map is scaled so that its axes have a mean squared length of 1: of the squared
        /// length of an axis from 1, or of the scalar product of two axes from 0.
        found: f64,
        /// Largest deviation that counts as rounding.
        limit: f64,
    },
    /// The determinant is negative.
    #[error("the map mirrors")]
    Mirrored,
}

/// Splits an affine map into a uniform scale, a rotation and a translation. Its axes may deviate from equal lengths and
/// right angles by 1e-5, so a similarity that was rounded to f32 is accepted.
///
/// ```
/// use clamber_surface::geometry::{Similarity, SimilarityError};
/// use glam::{DAffine3, DVec3};
///
/// let doubled = DAffine3::from_scale(DVec3::splat(2.0));
/// assert_eq!(Similarity::try_from(doubled)?, Similarity::from_scale(2.0));
/// let mirrored = DAffine3::from_scale(DVec3::splat(-2.0));
/// assert_eq!(Similarity::try_from(mirrored), Err(SimilarityError::Mirrored));
/// # Ok::<(), SimilarityError>(())
/// ```
impl TryFrom<DAffine3> for Similarity {
    type Error = SimilarityError;

    fn try_from(map: DAffine3) -> Result<Self, SimilarityError> {
        if !map.is_finite() {
            return Err(SimilarityError::NotFinite);
        }
        let (scale, rotation) = scale_and_rotation(&map.matrix3)?;
        Ok(Self {
            rotation,
            scale,
            translation: map.translation,
        })
    }
}

fn scale_and_rotation(map: &DMat3) -> Result<(f64, DQuat), SimilarityError> {
    let elements = map.to_cols_array();
    // Divided by the largest element, so that no square overflows or underflows.
    let largest = elements.into_iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    if largest == 0.0 {
        return Err(SimilarityError::Scale(0.0));
    }
    let reduced = DMat3::from_cols_array(&elements.map(|x| x / largest));
    let axes = [reduced.x_axis, reduced.y_axis, reduced.z_axis];
    let mean_sq = axes.map(|axis| axis.length_squared()).iter().sum::<f64>() / 3.0;
    let size = mean_sq.sqrt();
    let scale = size * largest;
    if !scale.is_normal() {
        return Err(SimilarityError::Scale(scale));
    }
    let [x, y, z] = axes.map(|axis| axis / size);
    let found = [x, y, z].map(|axis| axis.length_squared() - 1.0);
    let found = found.into_iter().chain([x.dot(y), y.dot(z), z.dot(x)]);
    let found = found.fold(0.0, |a: f64, b| a.max(b.abs()));
    if found > UNIT_TOLERANCE {
        let limit = UNIT_TOLERANCE;
        return Err(SimilarityError::NotUniform { found, limit });
    }
    let rotation = DMat3::from_cols(x, y, z);
    if rotation.determinant() < 0.0 {
        return Err(SimilarityError::Mirrored);
    }
    Ok((scale, DQuat::from_mat3(&rotation).normalize()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::rotation_from_axis_angle;
    use glam::DVec3;

    /// Includes scales whose squares overflow and underflow.
    #[test]
    fn a_similarity_comes_back_at_any_scale() {
        let mut rng = fastrand::Rng::with_seed(41);
        for round in 0..2_000 {
            let axis = crate::testing::direction(&mut rng).as_dvec3().normalize();
            let scale = libm::pow(10.0, rng.f64() * 600.0 - 300.0);
            let there = Similarity {
                rotation: rotation_from_axis_angle(axis, rng.f64() * 7.0),
                scale,
                translation: axis * scale,
            };
            let back = Similarity::try_from(there.to_affine()).unwrap();
            let turned = (back.rotation.dot(there.rotation).abs() - 1.0).abs();
            let scaled = (back.scale / scale - 1.0).abs();
            assert!(turned < 1e-14, "{round}: {there:?} {back:?}");
            assert!(scaled < 1e-14, "{round}: {there:?} {back:?}");
            assert_eq!(back.translation, there.translation);
            assert!(back.is_valid());
        }
    }

    #[test]
    fn a_similarity_rounded_to_f32_is_accepted() {
        let there = Similarity {
            rotation: rotation_from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.7),
            scale: 3.0,
            translation: DVec3::X,
        };
        let rounded = crate::geometry::Affine::from_f64(&there.to_affine()).to_f64();
        let back = Similarity::try_from(rounded).unwrap();
        assert!((back.scale - 3.0).abs() < 1e-6, "{back:?}");
    }

    #[test]
    fn maps_that_change_shapes_are_refused() {
        let refused = |map: DAffine3| Similarity::try_from(map).unwrap_err();
        let stretched = DAffine3::from_scale(DVec3::new(1.0, 1.0, 1.0001));
        let flat = DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.0));
        let mut sheared = DAffine3::IDENTITY;
        sheared.matrix3.x_axis.y = 0.01;
        for map in [stretched, flat, sheared] {
            let found = refused(map);
            let is_uneven = matches!(found, SimilarityError::NotUniform { .. });
            assert!(is_uneven, "{map}: {found:?}");
        }
        let mirrored = DAffine3::from_scale(DVec3::new(2.0, -2.0, 2.0));
        assert_eq!(refused(mirrored), SimilarityError::Mirrored);
        assert_eq!(refused(DAffine3::ZERO), SimilarityError::Scale(0.0));
        let tiny = DAffine3::from_scale(DVec3::splat(1e-320));
        let found = refused(tiny);
        assert!(matches!(found, SimilarityError::Scale(_)), "{found:?}");
        for bad in [f64::NAN, f64::INFINITY] {
            let mut map = DAffine3::IDENTITY;
            map.translation.y = bad;
            assert_eq!(refused(map), SimilarityError::NotFinite);
            map = DAffine3::IDENTITY;
            map.matrix3.z_axis.x = bad;
            assert_eq!(refused(map), SimilarityError::NotFinite);
        }
    }
}
