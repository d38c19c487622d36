//! Reads the transforms of nodes, also matrices, as translation, rotation and scale.

use clamber_surface::rig::Transform;
use glam::{DAffine3, DMat3, DVec3, Quat, Vec3};
use gltf::Node;

use crate::ImportWarning;

/// The largest error of a decomposed matrix that gives no warning, as a share of a column's length: a millimetre in a
/// metre.
const SHEAR_WORTH_TELLING: f64 = 1e-3;

/// Largest difference from 1 of a scale that is read as 1. Blender's rounding errors are mostly smaller.
const ROUNDED: f32 = 1e-6;

/// Reads the transforms of nodes as translation, rotation and scale.
pub(crate) fn of_nodes(nodes: &[Node<'_>], warnings: &mut Vec<ImportWarning>) -> Vec<Transform> {
    let mut sheared = 0;
    let mut worst = 0.0f64;
    let transforms = nodes.iter().map(|node| match node.transform() {
        gltf::scene::Transform::Decomposed {
            translation,
            rotation,
            scale,
        } => Transform {
            translation: Vec3::from_array(translation),
            rotation: Quat::from_array(rotation),
            scale: without_rounding(Vec3::from_array(scale)),
        },
        gltf::scene::Transform::Matrix { matrix } => {
            let (transform, error) = decompose(&matrix);
            sheared += usize::from(error > SHEAR_WORTH_TELLING);
            worst = worst.max(error);
            transform
        }
    });
    let transforms = transforms.collect();
    if sheared > 0 {
        warnings.push(ImportWarning::ShearedNodes {
            nodes: sheared,
            worst_error: worst,
        });
    }
    transforms
}

/// Replaces a scale that is nearly 1 by 1: exporters write rounding errors where no scale is meant, and Blender's are
/// mostly below 1e-6. Joints without a scale are posed with less work. The change at a joint moves anything under the
/// joint by at most 1e-6 of its distance.
pub(crate) fn without_rounding(scale: Vec3) -> Vec3 {
    let axis = |axis: f32| {
        if (axis - 1.0).abs() <= ROUNDED {
            1.0
        } else {
            axis
        }
    };
    Vec3::from(scale.to_array().map(axis))
}

/// Decomposes a matrix into translation, rotation and scale. Also returns the largest error of a column, as a share of
/// its length. A column of length zero gets a direction perpendicular to the others.
fn decompose(matrix: &[[f32; 4]; 4]) -> (Transform, f64) {
    let column = |c: usize| DVec3::from_array([0, 1, 2].map(|row| f64::from(matrix[c][row])));
    let linear = DMat3::from_cols(column(0), column(1), column(2));
    let mut scale = DVec3::new(
        linear.x_axis.length(),
        linear.y_axis.length(),
        linear.z_axis.length(),
    );
    if linear.determinant() < 0.0 {
        scale.x = -scale.x;
    }
    let mut x = (linear.x_axis / scale.x).try_normalize();
    let mut y = (linear.y_axis / scale.y).try_normalize();
    let z = (linear.z_axis / scale.z)
        .try_normalize()
        .or_else(|| Some(x?.cross(y?).normalize_or(DVec3::Z)))
        .unwrap_or(DVec3::Z);
    y = y.or_else(|| Some(z.cross(x?).normalize_or(DVec3::Y)));
    x = x.or_else(|| Some(y?.cross(z).normalize_or(DVec3::X)));
    let axes = DMat3::from_cols(x.unwrap_or(DVec3::X), y.unwrap_or(DVec3::Y), z);
    let rotation = glam::DQuat::from_mat3(&axes).normalize();
    let recomposed =
        DAffine3::from_scale_rotation_translation(scale, rotation, DVec3::ZERO).matrix3;
    let off = linear - recomposed;
    // A column of length zero has no error: 0 is divided by the smallest number, not by 0.
    let share = |off: DVec3, of: DVec3| off.length() / of.length().max(f64::MIN_POSITIVE);
    let error = share(off.x_axis, linear.x_axis)
        .max(share(off.y_axis, linear.y_axis))
        .max(share(off.z_axis, linear.z_axis));
    let transform = Transform {
        translation: column(3).as_vec3(),
        rotation: rotation.as_quat(),
        scale: without_rounding(scale.as_vec3()),
    };
    (transform, error)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(x: [f32; 3], y: [f32; 3], z: [f32; 3]) -> [[f32; 4]; 4] {
        let direction = |v: [f32; 3]| [v[0], v[1], v[2], 0.0];
        [
            direction(x),
            direction(y),
            direction(z),
            [5.0, 6.0, 7.0, 1.0],
        ]
    }

    #[test]
    fn matrices_become_translation_rotation_scale() {
        // A quarter turn about Z, scaled by 2, 3, 4.
        let matrix = columns([0.0, 2.0, 0.0], [-3.0, 0.0, 0.0], [0.0, 0.0, 4.0]);
        let (t, error) = decompose(&matrix);
        assert!(error < 1e-12);
        assert_eq!(t.translation, Vec3::new(5.0, 6.0, 7.0));
        assert!((t.scale - Vec3::new(2.0, 3.0, 4.0)).length() < 1e-6);
        assert!((t.rotation.z - 0.5f32.sqrt()).abs() < 1e-6, "{t:?}");
    }

    #[test]
    fn scales_are_1_where_rounding_alone_is_not() {
        let rounded = Vec3::new(0.999_999_94, 1.000_000_2, 1.0);
        assert_eq!(without_rounding(rounded), Vec3::ONE);
        for meant in [1.00001, 0.9999, -1.0, 0.0, 2.0] {
            assert_eq!(without_rounding(Vec3::splat(meant)), Vec3::splat(meant));
        }
        assert!(without_rounding(Vec3::splat(f32::NAN)).is_nan());
    }

    #[test]
    fn mirrors_zero_columns_and_shear() {
        let mirror = columns([1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]);
        let (t, error) = decompose(&mirror);
        assert!(error < 1e-12 && t.scale.x < 0.0 && t.is_valid(), "{t:?}");
        for flat in [
            columns([0.0; 3], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
            columns([1.0, 0.0, 0.0], [0.0; 3], [0.0, 0.0, 1.0]),
            columns([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]),
            columns([0.0; 3], [0.0; 3], [0.0; 3]),
        ] {
            let (t, error) = decompose(&flat);
            assert!(t.is_valid() && error < 1e-6, "{flat:?}: {t:?} {error}");
        }
        let shear = columns([1.0, 0.0, 0.0], [0.5, 1.0, 0.0], [0.0, 0.0, 1.0]);
        assert!(decompose(&shear).1 > 0.01);
    }
}
