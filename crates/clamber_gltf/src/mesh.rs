//! The primitives of all meshes that a skin deforms, as one collider mesh.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use clamber_surface::mesh::{
    BuildReport, ColliderMesh, Influence, MeshError, MeshSource, SurfaceTag,
};
use clamber_surface::rig::JointId;
use glam::Vec3;
use gltf::mesh::{Mode, Primitive, Semantic};
use gltf::{Document, Mesh, Skin};

use crate::accessor::Reader;
use crate::tag::tag_of;
use crate::{GltfError, LoadOptions};

/// The skin asked for, or the one that deforms the most triangles; says which others and which
/// meshes without a skin are passed over.
pub(crate) fn choose_skin<'a>(
    document: &'a Document,
    wanted: Option<usize>,
    warnings: &mut Vec<String>,
) -> Result<Skin<'a>, GltfError> {
    let mut corners = vec![0u64; document.skins().len()];
    let mut unskinned = 0;
    for node in document.nodes() {
        match (node.mesh(), node.skin()) {
            (Some(mesh), Some(skin)) => corners[skin.index()] += corner_count(&mesh),
            (Some(_), None) => unskinned += 1,
            (None, _) => {}
        }
    }
    if unskinned > 0 {
        warnings.push(format!("{unskinned} meshes without a skin; passed over"));
    }
    // Of equal ones the first.
    let largest = (0..corners.len()).rev().max_by_key(|skin| corners[*skin]);
    let chosen = wanted.or(largest).unwrap_or(0);
    let others = corners.len().saturating_sub(1);
    if others > 0 {
        warnings.push(format!(
            "took skin {chosen}; {others} other skins were passed over"
        ));
    }
    document.skins().nth(chosen).ok_or(GltfError::NoSuchSkin {
        wanted: chosen,
        found: corners.len(),
    })
}

/// How many triangle corners a mesh has, more or less.
fn corner_count(mesh: &Mesh<'_>) -> u64 {
    let count = |primitive: Primitive<'_>| {
        let positions = || primitive.get(&Semantic::Positions);
        let accessor = primitive.indices().or_else(positions);
        accessor.map_or(0, |accessor| accessor.count() as u64)
    };
    mesh.primitives().map(count).fold(0, u64::saturating_add)
}

/// What all primitives add up to.
#[derive(Default)]
struct Gathered {
    positions: Vec<Vec3>,
    influences: Vec<Influence>,
    /// Where each vertex's influences end.
    influence_ends: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    tags: Vec<SurfaceTag>,
    unweighted: usize,
    /// First vertex of each set of attributes, by its accessors: primitives often share them.
    bases: BTreeMap<Vec<usize>, u32>,
}

pub(crate) fn load(
    document: &Document,
    skin: &Skin<'_>,
    joint_count: usize,
    reader: &Reader<'_>,
    options: &LoadOptions<'_>,
    warnings: &mut Vec<String>,
) -> Result<(Arc<ColliderMesh>, BuildReport), GltfError> {
    let mut gathered = Gathered::default();
    // A mesh that several nodes show with one skin is one mesh: the skin says where it stands.
    let deformed: BTreeSet<usize> = document
        .nodes()
        .filter(|node| node.skin().is_some_and(|s| s.index() == skin.index()))
        .filter_map(|node| Some(node.mesh()?.index()))
        .collect();
    let skin_joints = skin.joints().count();
    for mesh in document
        .meshes()
        .filter(|mesh| deformed.contains(&mesh.index()))
    {
        for primitive in mesh.primitives() {
            let object = format!("mesh {}, primitive {}", mesh.index(), primitive.index());
            match passed_over(&primitive) {
                Some(reason) => warnings.push(format!("{object}: {reason}; passed over")),
                None => gathered.add(&primitive, &object, skin_joints, reader, options)?,
            }
            if primitive.morph_targets().next().is_some() {
                warnings.push(format!("{object}: its morph targets were passed over"));
            }
        }
    }
    if gathered.triangles.is_empty() {
        return Err(GltfError::NoSkinnedMesh { skin: skin.index() });
    }
    if gathered.unweighted > 0 {
        warnings.push(format!(
            "{} vertices have no weights and follow the first joint that they name",
            gathered.unweighted
        ));
    }
    gathered
        .build(joint_count, options)
        .map_err(|source| GltfError::Collider {
            skin: skin.index(),
            source,
        })
}

/// Why a primitive is no part of a collider; `None` if it is.
fn passed_over(primitive: &Primitive<'_>) -> Option<String> {
    let mode = primitive.mode();
    if !matches!(
        mode,
        Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan
    ) {
        return Some(format!("{mode:?} have no surface"));
    }
    if primitive.get(&Semantic::Positions).is_none() {
        return Some("has no positions".into());
    }
    let sets = [Semantic::Joints(0), Semantic::Weights(0)];
    let unskinned = sets.iter().all(|set| primitive.get(set).is_none());
    unskinned.then(|| "has no joints and weights".into())
}

impl Gathered {
    fn add(
        &mut self,
        primitive: &Primitive<'_>,
        object: &str,
        skin_joints: usize,
        reader: &Reader<'_>,
        options: &LoadOptions<'_>,
    ) -> Result<(), GltfError> {
        let (base, vertices) = self.vertices_of(primitive, object, skin_joints, reader)?;
        let indices = match primitive.indices() {
            Some(accessor) => reader.integers::<1>(&accessor)?.into_flattened(),
            None => {
                reader.charge(object, vertices * size_of::<u32>())?;
                (0..vertices as u32).collect()
            }
        };
        if let Some(index) = indices.iter().find(|i| **i as usize >= vertices) {
            let reason = format!("names vertex {index} of {vertices}");
            return Err(GltfError::invalid(object, reason));
        }
        let tag = tag_of(&primitive.material(), options)?;
        let before = self.triangles.len();
        // A strip makes three corners of every index.
        reader.charge(object, indices.len() * size_of::<[u32; 4]>())?;
        self.triangles
            .extend(triangles(&indices, primitive.mode()).map(|t| t.map(|v| v + base)));
        self.tags
            .resize(self.tags.len() + self.triangles.len() - before, tag);
        Ok(())
    }

    /// Number of the first of a primitive's vertices and how many there are, read unless another
    /// primitive has the same ones.
    fn vertices_of(
        &mut self,
        primitive: &Primitive<'_>,
        object: &str,
        skin_joints: usize,
        reader: &Reader<'_>,
    ) -> Result<(u32, usize), GltfError> {
        let Some(positions) = primitive.get(&Semantic::Positions) else {
            return Ok((0, 0));
        };
        let mut key = vec![positions.index()];
        for (semantic, accessor) in primitive.attributes() {
            if let Semantic::Joints(set) = semantic {
                key.extend([2 * set as usize, accessor.index()]);
            } else if let Semantic::Weights(set) = semantic {
                key.extend([2 * set as usize + 1, accessor.index()]);
            }
        }
        if let Some(base) = self.bases.get(&key) {
            return Ok((*base, positions.count()));
        }
        let base = u32::try_from(self.positions.len())
            .map_err(|_| GltfError::invalid(object, "the file has more than 2^32 vertices"))?;
        let positions = reader.floats::<3>(&positions)?;
        let sets = weight_sets(primitive, positions.len(), object, reader)?;
        for vertex in 0..positions.len() {
            self.push_influences(&sets, vertex, object, skin_joints)?;
        }
        let count = positions.len();
        self.positions
            .extend(positions.into_iter().map(Vec3::from_array));
        self.bases.insert(key, base);
        Ok((base, count))
    }

    /// Appends the influences of a vertex. What weighs nothing is padding and may name any joint.
    fn push_influences(
        &mut self,
        sets: &[WeightSet],
        vertex: usize,
        object: &str,
        skin_joints: usize,
    ) -> Result<(), GltfError> {
        let start = self.influences.len();
        let named = sets
            .iter()
            .flat_map(|(joints, weights)| joints[vertex].into_iter().zip(weights[vertex]))
            .map(|(joint, weight)| Influence {
                joint: JointId(joint),
                weight,
            });
        self.influences
            .extend(named.clone().filter(|influence| influence.weight != 0.0));
        if self.influences.len() == start {
            self.unweighted += 1;
            self.influences.extend(named.take(1).map(|first| Influence {
                weight: 1.0,
                ..first
            }));
        }
        let beyond = |i: &&Influence| i.joint.0 as usize >= skin_joints;
        if let Some(bad) = self.influences[start..].iter().find(beyond) {
            let reason = format!("follows joint {} of a skin of {skin_joints}", bad.joint);
            return Err(GltfError::invalid(object, reason));
        }
        let end = u32::try_from(self.influences.len())
            .map_err(|_| GltfError::invalid(object, "the file has more than 2^32 weights"))?;
        self.influence_ends.push(end);
        Ok(())
    }

    fn build(
        &self,
        joint_count: usize,
        options: &LoadOptions<'_>,
    ) -> Result<(Arc<ColliderMesh>, BuildReport), MeshError> {
        let source = MeshSource {
            positions: &self.positions,
            triangles: &self.triangles,
            influences: &self.influences,
            influence_ends: &self.influence_ends,
            tags: &self.tags,
            joint_count,
        };
        let (mesh, report) = ColliderMesh::build(&source, &options.build)?;
        Ok((Arc::new(mesh), report))
    }
}

/// Joints and weights of every vertex, four of each.
type WeightSet = (Vec<[u32; 4]>, Vec<[f32; 4]>);

/// All sets of a primitive, at least one.
fn weight_sets(
    primitive: &Primitive<'_>,
    vertices: usize,
    object: &str,
    reader: &Reader<'_>,
) -> Result<Vec<WeightSet>, GltfError> {
    let mut sets = Vec::new();
    for set in 0.. {
        let (joints, weights) = match (
            primitive.get(&Semantic::Joints(set)),
            primitive.get(&Semantic::Weights(set)),
        ) {
            (Some(joints), Some(weights)) => (joints, weights),
            (None, None) => break,
            _ => {
                let reason = format!("has only one of JOINTS_{set} and WEIGHTS_{set}");
                return Err(GltfError::invalid(object, reason));
            }
        };
        let joints = reader.integers::<4>(&joints)?;
        let weights = reader.floats::<4>(&weights)?;
        if joints.len() != vertices || weights.len() != vertices {
            let reason = format!(
                "has {vertices} positions, but {} joints and {} weights in set {set}",
                joints.len(),
                weights.len()
            );
            return Err(GltfError::invalid(object, reason));
        }
        sets.push((joints, weights));
    }
    Ok(sets)
}

/// The triangles of a list, strip or fan, all with the same side outside.
fn triangles(indices: &[u32], mode: Mode) -> impl Iterator<Item = [u32; 3]> {
    let count = match mode {
        Mode::Triangles => indices.len() / 3,
        _ => indices.len().saturating_sub(2),
    };
    (0..count).map(move |k| match mode {
        Mode::TriangleStrip if k % 2 == 0 => [indices[k], indices[k + 1], indices[k + 2]],
        Mode::TriangleStrip => [indices[k], indices[k + 2], indices[k + 1]],
        Mode::TriangleFan => [indices[k + 1], indices[k + 2], indices[0]],
        _ => [indices[3 * k], indices[3 * k + 1], indices[3 * k + 2]],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_strips_and_fans() {
        let all = |mode| triangles(&[0, 1, 2, 3, 4], mode).collect::<Vec<_>>();
        assert_eq!(all(Mode::Triangles), [[0, 1, 2]]);
        assert_eq!(all(Mode::TriangleStrip), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        assert_eq!(all(Mode::TriangleFan), [[1, 2, 0], [2, 3, 0], [3, 4, 0]]);
        assert_eq!(triangles(&[0], Mode::TriangleStrip).count(), 0);
    }
}
