//! A skin's joints and all nodes above them, as one skeleton.

use std::collections::BTreeMap;

use clamber_surface::geometry::Affine;
use clamber_surface::rig::{Joint, JointId, Skeleton, Transform};
use glam::{DAffine3, DMat3, DVec3, Quat, Vec3};
use gltf::{Document, Node, Skin};

use crate::GltfError;
use crate::accessor::Reader;

/// A skeleton and which of its joints stands for which node.
pub(crate) struct Joints {
    pub(crate) skeleton: Skeleton,
    /// A node can be several joints of a skin.
    pub(crate) of_node: BTreeMap<usize, Vec<JointId>>,
}

/// The skin's joints come first, in the skin's order, so that `JOINTS_n` are joint ids; the other
/// nodes that they hang under follow.
pub(crate) fn load(
    document: &Document,
    skin: &Skin<'_>,
    reader: &Reader<'_>,
    warnings: &mut Vec<String>,
) -> Result<Joints, GltfError> {
    let nodes: Vec<Node<'_>> = document.nodes().collect();
    let parent_of = parents(&nodes)?;
    let mut members: Vec<usize> = skin.joints().map(|node| node.index()).collect();
    let skinning = members.len();
    let mut of_node: BTreeMap<usize, Vec<JointId>> = BTreeMap::new();
    for (index, node) in members.iter().enumerate() {
        of_node
            .entry(*node)
            .or_default()
            .push(JointId(index as u32));
    }
    // Grows while it is walked: each joint adds the parent that is not there yet.
    let mut next = 0;
    while let Some(&node) = members.get(next) {
        if let Some(parent) = parent_of[node]
            && !of_node.contains_key(&parent)
        {
            of_node.insert(parent, vec![JointId(members.len() as u32)]);
            members.push(parent);
        }
        next += 1;
    }
    let inverse_binds = inverse_binds(skin, skinning, reader, warnings)?;
    let joints = members.iter().enumerate().map(|(index, &node)| {
        let parent = parent_of[node].and_then(|parent| of_node.get(&parent)?.first().copied());
        let name = nodes[node].name();
        Joint {
            name: name.map_or_else(|| format!("node {node}"), str::to_owned),
            parent,
            rest: transform(&nodes[node], warnings),
            inverse_bind: inverse_binds
                .get(index)
                .copied()
                .unwrap_or(Affine::IDENTITY),
        }
    });
    let skeleton = Skeleton::new(joints.collect()).map_err(|source| GltfError::Skeleton {
        skin: skin.index(),
        source,
    })?;
    Ok(Joints { skeleton, of_node })
}

/// The parent of every node.
fn parents(nodes: &[Node<'_>]) -> Result<Vec<Option<usize>>, GltfError> {
    let mut parent_of = vec![None; nodes.len()];
    for node in nodes {
        for child in node.children() {
            let parent = &mut parent_of[child.index()];
            if let Some(other) = parent.filter(|other| *other != node.index()) {
                return Err(GltfError::invalid(
                    format!("node {}", child.index()),
                    format!("is a child of nodes {other} and {}", node.index()),
                ));
            }
            *parent = Some(node.index());
        }
    }
    Ok(parent_of)
}

fn inverse_binds(
    skin: &Skin<'_>,
    joints: usize,
    reader: &Reader<'_>,
    warnings: &mut Vec<String>,
) -> Result<Vec<Affine>, GltfError> {
    let Some(accessor) = skin.inverse_bind_matrices() else {
        return Ok(Vec::new());
    };
    let mut matrices = reader.floats::<16>(&accessor)?;
    if matrices.len() < joints {
        return Err(GltfError::invalid(
            format!("skin {}", skin.index()),
            format!(
                "has {joints} joints, but {} inverse bind matrices",
                matrices.len()
            ),
        ));
    }
    // More are legal, and belong to nothing.
    matrices.truncate(joints);
    let last_row = |m: &[f32; 16]| [m[3], m[7], m[11], m[15]] == [0.0, 0.0, 0.0, 1.0];
    let projective = matrices.iter().filter(|m| !last_row(m)).count();
    if projective > 0 {
        warnings.push(format!(
            "skin {}: the last row of {projective} inverse bind matrices is not (0, 0, 0, 1); \
             it was taken as if it were",
            skin.index()
        ));
    }
    Ok(matrices.iter().map(Affine::from_cols_array).collect())
}

/// A node's transform as translation, rotation, scale.
fn transform(node: &Node<'_>, warnings: &mut Vec<String>) -> Transform {
    match node.transform() {
        gltf::scene::Transform::Decomposed {
            translation,
            rotation,
            scale,
        } => Transform {
            translation: Vec3::from_array(translation),
            rotation: Quat::from_array(rotation),
            scale: Vec3::from_array(scale),
        },
        gltf::scene::Transform::Matrix { matrix } => {
            let (transform, error) = decompose(&matrix);
            if error > 1e-3 {
                warnings.push(format!(
                    "node {}: its matrix shears, which a translation, rotation and scale cannot: \
                     its columns are off by up to {error:.1e} of their length",
                    node.index()
                ));
            }
            transform
        }
    }
}

/// Translation, rotation and scale of a matrix, and how far its columns are from theirs, as a
/// share of their length. A column of length zero takes the direction that the others leave it.
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
    // A column of length zero is met exactly: 0 over the smallest number, not over 0.
    let share = |off: DVec3, of: DVec3| off.length() / of.length().max(f64::MIN_POSITIVE);
    let error = share(off.x_axis, linear.x_axis)
        .max(share(off.y_axis, linear.y_axis))
        .max(share(off.z_axis, linear.z_axis));
    let transform = Transform {
        translation: column(3).as_vec3(),
        rotation: rotation.as_quat(),
        scale: scale.as_vec3(),
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
