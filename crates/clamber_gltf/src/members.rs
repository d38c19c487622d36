//! Groups the skins and meshes of a file into creatures.
//!
//! Skins that share joints are one creature, and so are skins where a joint of one is a descendant of a joint of the
//! other: exporters write a skin per mesh, per material, or per armature. A mesh without a skin belongs to the creature
//! whose joint it is under. A file without skins is one creature of rigid pieces.

use gltf::Mesh;
use gltf::mesh::Semantic;

use crate::extras::NodeExtras;
use crate::tree::Tree;
use crate::vertices::has_surface;
use crate::{GltfErrorKind, ImportWarning, warning};

/// The objects of a file that make up one creature.
#[derive(Clone, Debug, Default)]
pub(crate) struct Members {
    /// Indices of its skins, ascending.
    pub(crate) skins: Vec<usize>,
    /// Nodes that show a mesh, ascending, each deformed by the skin that it names, or rigid.
    pub(crate) meshes: Vec<usize>,
    /// Nodes that are weak points, ascending.
    pub(crate) weak_points: Vec<usize>,
    /// Approximate number of corners of all its triangles.
    corners: u64,
}

impl Members {
    /// The creature's name in messages.
    pub(crate) fn object(&self) -> String {
        warning::creature(&self.skins)
    }
}

/// All creatures of a file that have a mesh, in the order of their first skins.
pub(crate) fn all(
    tree: &Tree<'_>,
    extras: &[NodeExtras],
    warnings: &mut Vec<ImportWarning>,
) -> Vec<Members> {
    // Pruning has taken the joints from skins that only meshes of other scenes use.
    let mut used = vec![false; tree.skins.len()];
    for skin in tree.nodes.iter().filter_map(|node| node.skin()) {
        used[skin.index()] = true;
    }
    let is_gone = |skin: &usize| !used[*skin] && tree.skins[*skin].joints().len() == 0;
    let all_gone = (0..tree.skins.len()).all(|skin| is_gone(&skin));
    let of_skin = if all_gone {
        Vec::new()
    } else {
        creature_of_skin(tree)
    };
    let mut creatures = vec![Members::default(); of_skin.len().max(1)];
    for (skin, creature) in of_skin.iter().enumerate() {
        creatures[*creature].skins.push(skin);
    }
    let of_node = creature_of_node(tree, &of_skin);
    let mut static_meshes = 0;
    for node in &tree.nodes {
        let index = node.index();
        if let Some(mesh) = node.mesh() {
            let creature = match node.skin() {
                Some(skin) => Some(of_skin[skin.index()]),
                None if of_skin.is_empty() => Some(0),
                None => of_node[index],
            };
            match creature {
                Some(creature) => {
                    let corners = &mut creatures[creature].corners;
                    *corners = corners.saturating_add(corner_count(&mesh));
                    creatures[creature].meshes.push(index);
                }
                None => static_meshes += 1,
            }
        }
        if extras[index].weak_point.is_some() {
            match of_node[index] {
                Some(creature) => creatures[creature].weak_points.push(index),
                None => warnings.push(ImportWarning::WeakPointWithoutJoint {
                    node: tree.name(index),
                }),
            }
        }
    }
    if static_meshes > 0 {
        warnings.push(ImportWarning::MeshesWithoutJoint {
            meshes: static_meshes,
        });
    }
    let bare = creatures.iter().filter(|c| c.meshes.is_empty());
    let idle_skins = bare.flat_map(|creature| &creature.skins);
    let idle_skins = idle_skins.filter(|skin| !is_gone(skin)).count();
    if idle_skins > 0 {
        warnings.push(ImportWarning::UnusedSkins { skins: idle_skins });
    }
    creatures.retain(|creature| !creature.meshes.is_empty());
    creatures
}

/// The creature with the wanted skin. Without a wanted skin, the creature with the most triangles; the first of equal
/// ones.
pub(crate) fn choose(
    tree: &Tree<'_>,
    creatures: &[Members],
    wanted: Option<usize>,
    warnings: &mut Vec<ImportWarning>,
) -> Result<Members, GltfErrorKind> {
    let found = tree.skins.len();
    let chosen = match wanted {
        Some(wanted) if wanted >= found => return Err(GltfErrorKind::NoSuchSkin { wanted, found }),
        Some(wanted) => creatures.iter().find(|c| c.skins.contains(&wanted)),
        None => creatures.iter().rev().max_by_key(|c| c.corners),
    };
    let object = || wanted.map_or_else(|| "the file".into(), |skin| format!("skin {skin}"));
    let chosen = chosen.ok_or_else(|| GltfErrorKind::NoTriangles { object: object() })?;
    if creatures.len() > 1 {
        warnings.push(ImportWarning::OtherCreatures {
            skins: chosen.skins.clone(),
            others: creatures.len() - 1,
        });
    }
    Ok(chosen.clone())
}

/// For each skin, the number of its creature. Creatures are numbered from 0, in the order of their first skins.
fn creature_of_skin(tree: &Tree<'_>) -> Vec<usize> {
    let count = tree.skins.len();
    let mut above: Vec<usize> = (0..count).collect();
    let mut skin_of_joint: Vec<Option<usize>> = vec![None; tree.nodes.len()];
    for skin in &tree.skins {
        for joint in skin.joints() {
            match skin_of_joint[joint.index()] {
                Some(other) => unite(&mut above, other, skin.index()),
                None => skin_of_joint[joint.index()] = Some(skin.index()),
            }
        }
    }
    // From the roots down: the skin of the nearest joint at or above each node.
    let mut skin_above: Vec<Option<usize>> = vec![None; tree.nodes.len()];
    for &node in &tree.order {
        let inherited = tree.parent_of[node].and_then(|parent| skin_above[parent]);
        if let (Some(above_it), Some(own)) = (inherited, skin_of_joint[node]) {
            unite(&mut above, above_it, own);
        }
        skin_above[node] = skin_of_joint[node].or(inherited);
    }
    // The smallest skin represents its creature, so numbers ascend by first skin, and the skin above another one has
    // its number already.
    let mut numbers = vec![0; count];
    let mut next = 0;
    for skin in 0..count {
        numbers[skin] = if above[skin] == skin {
            next += 1;
            next - 1
        } else {
            numbers[above[skin]]
        };
    }
    numbers
}

/// For each node, the number of the creature that the nearest joint at or above it belongs to. In a file without skins
/// every node may be a joint, so all nodes belong to creature 0.
fn creature_of_node(tree: &Tree<'_>, of_skin: &[usize]) -> Vec<Option<usize>> {
    let nobody = of_skin.is_empty().then_some(0);
    let mut of_node = vec![nobody; tree.nodes.len()];
    for skin in &tree.skins {
        for joint in skin.joints() {
            of_node[joint.index()] = Some(of_skin[skin.index()]);
        }
    }
    for &node in &tree.order {
        let inherited = tree.parent_of[node].and_then(|parent| of_node[parent]);
        of_node[node] = of_node[node].or(inherited);
    }
    of_node
}

/// The smallest skin of the set that `skin` is in. Halves the path to it on the way, so that paths stay short in any
/// order of skins.
fn representative(above: &mut [usize], mut skin: usize) -> usize {
    while above[skin] != skin {
        above[skin] = above[above[skin]];
        skin = above[skin];
    }
    skin
}

/// Merges two sets under the smaller representative.
fn unite(above: &mut [usize], a: usize, b: usize) {
    let (a, b) = (representative(above, a), representative(above, b));
    above[a.max(b)] = a.min(b);
}

/// The approximate number of triangle corners of a mesh.
fn corner_count(mesh: &Mesh<'_>) -> u64 {
    let count = |primitive: gltf::Primitive<'_>| {
        let positions = || primitive.get(&Semantic::Positions);
        let accessor = primitive.indices().or_else(positions);
        accessor.map_or(0, |accessor| accessor.count() as u64)
    };
    let primitives = mesh.primitives().filter(has_surface);
    primitives.map(count).fold(0, u64::saturating_add)
}
