//! Builds a skeleton from the joints of a creature and all nodes above them.

use std::collections::BTreeMap;

use clamber_surface::geometry::Affine;
use clamber_surface::rig::{Joint, JointId, Skeleton};
use gltf::Skin;

use crate::accessor::Reader;
use crate::contents::Contents;
use crate::members::Members;
use crate::{GltfErrorKind, ImportWarning};

/// A skeleton, and the joints of nodes, skins and rigid meshes.
pub(crate) struct Joints {
    pub(crate) skeleton: Skeleton,
    /// By node: its joints. There are several if skins give the node different inverse bind matrices.
    pub(crate) of_node: BTreeMap<usize, Vec<JointId>>,
    /// By skin: the joint for each joint index that the skin's meshes name.
    pub(crate) of_skin: BTreeMap<usize, Vec<JointId>>,
    /// By node: the joint that moves the rigid mesh there.
    pub(crate) of_rigid: BTreeMap<usize, JointId>,
}

/// Joints under construction.
#[derive(Default)]
struct Gathering {
    /// Node and inverse bind matrix of each joint.
    joints: Vec<(usize, Affine)>,
    /// Joints by node and by the bits of the inverse bind matrix.
    numbers: BTreeMap<(usize, [u32; 12]), JointId>,
    of_node: BTreeMap<usize, Vec<JointId>>,
}

impl Gathering {
    /// The joint of a node with this inverse bind matrix; added if it is new.
    fn joint(&mut self, node: usize, inverse_bind: Affine) -> JointId {
        let bits = inverse_bind.rows.map(|row| row.map(f32::to_bits));
        let mut key = [0; 12];
        key.copy_from_slice(bits.as_flattened());
        *self.numbers.entry((node, key)).or_insert_with(|| {
            let id = JointId(self.joints.len() as u32);
            self.joints.push((node, inverse_bind));
            self.of_node.entry(node).or_default().push(id);
            id
        })
    }
}

/// Builds the skeleton: the joints of the skins, in the skins' order, then the nodes of rigid meshes, then all other
/// nodes above these.
pub(crate) fn load(
    contents: &Contents<'_>,
    members: &Members,
    warnings: &mut Vec<ImportWarning>,
) -> Result<Joints, GltfErrorKind> {
    let tree = &contents.tree;
    let mut gathering = Gathering::default();
    let mut of_skin = BTreeMap::new();
    for skin in members.skins.iter().map(|skin| &tree.skins[*skin]) {
        let inverse_binds = inverse_binds(skin, &contents.reader, warnings)?;
        let joints = skin.joints().enumerate().map(|(index, node)| {
            let inverse_bind = inverse_binds.get(index).copied();
            gathering.joint(node.index(), inverse_bind.unwrap_or(Affine::IDENTITY))
        });
        of_skin.insert(skin.index(), joints.collect());
    }
    let rigid = members
        .meshes
        .iter()
        .filter(|node| tree.nodes[**node].skin().is_none());
    let of_rigid = rigid
        .map(|node| (*node, gathering.joint(*node, Affine::IDENTITY)))
        .collect();
    // The list grows while it is walked: each joint adds its parent if that is missing.
    let mut next = 0;
    while let Some(&(node, _)) = gathering.joints.get(next) {
        if let Some(parent) = tree.parent_of[node]
            && !gathering.of_node.contains_key(&parent)
        {
            gathering.joint(parent, Affine::IDENTITY);
        }
        next += 1;
    }
    let Gathering {
        joints, of_node, ..
    } = gathering;
    let bytes = |node: usize| tree.nodes[node].name().map_or(0, str::len) + size_of::<Joint>();
    let bytes = joints.iter().map(|(node, _)| bytes(*node)).sum();
    contents.reader.charge(&members.object(), bytes)?;
    let joints = joints.into_iter().map(|(node, inverse_bind)| {
        let parent = tree.parent_of[node].and_then(|parent| of_node.get(&parent)?.first().copied());
        Joint {
            name: tree.name(node),
            parent,
            rest: contents.transforms[node],
            inverse_bind,
        }
    });
    let skeleton = Skeleton::new(joints.collect()).map_err(|error| GltfErrorKind::Skeleton {
        object: members.object(),
        error,
    })?;
    Ok(Joints {
        skeleton,
        of_node,
        of_skin,
        of_rigid,
    })
}

fn inverse_binds(
    skin: &Skin<'_>,
    reader: &Reader<'_>,
    warnings: &mut Vec<ImportWarning>,
) -> Result<Vec<Affine>, GltfErrorKind> {
    let joints = skin.joints().len();
    let Some(accessor) = skin.inverse_bind_matrices() else {
        return Ok(Vec::new());
    };
    let mut matrices = reader.floats::<16>(&accessor)?;
    if matrices.len() < joints {
        return Err(GltfErrorKind::invalid(
            format!("skin {}", skin.index()),
            format!(
                "has {joints} joints, but {} inverse bind matrices",
                matrices.len()
            ),
        ));
    }
    // More matrices than joints are legal; the rest has no meaning.
    matrices.truncate(joints);
    let last_row = |m: &[f32; 16]| [m[3], m[7], m[11], m[15]] == [0.0, 0.0, 0.0, 1.0];
    let projective = matrices.iter().filter(|m| !last_row(m)).count();
    if projective > 0 {
        warnings.push(ImportWarning::ProjectiveInverseBinds {
            skin: skin.index(),
            matrices: projective,
        });
    }
    Ok(matrices.iter().map(Affine::from_cols_array).collect())
}
