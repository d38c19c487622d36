//! The primitives of all meshes that a skin deforms, as one collider mesh.

use std::sync::Arc;

use clamber_surface::mesh::{BuildReport, ColliderMesh, Influence, MeshSource, SurfaceTag};
use clamber_surface::rig::JointId;
use glam::Vec3;
use gltf::mesh::{Mode, Primitive, Semantic};
use gltf::{Document, Skin};

use crate::accessor::Reader;
use crate::tag::tag_of;
use crate::{GltfError, LoadOptions};

/// What all primitives add up to.
#[derive(Default)]
struct Gathered {
    positions: Vec<Vec3>,
    /// A list per vertex, of any length.
    influences: Vec<Vec<Influence>>,
    triangles: Vec<[u32; 3]>,
    tags: Vec<SurfaceTag>,
    unweighted: usize,
}

pub(crate) fn load(
    document: &Document,
    skin: &Skin<'_>,
    joint_count: usize,
    reader: Reader<'_>,
    options: &LoadOptions<'_>,
    warnings: &mut Vec<String>,
) -> Result<(Arc<ColliderMesh>, BuildReport), GltfError> {
    let mut gathered = Gathered::default();
    let deforms = |node: &gltf::Node<'_>| node.skin().is_some_and(|s| s.index() == skin.index());
    for node in document.nodes().filter(deforms) {
        let Some(mesh) = node.mesh() else { continue };
        for primitive in mesh.primitives() {
            let object = format!("mesh {}, primitive {}", mesh.index(), primitive.index());
            gathered.add(&primitive, &object, reader, options, warnings)?;
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

impl Gathered {
    fn add(
        &mut self,
        primitive: &Primitive<'_>,
        object: &str,
        reader: Reader<'_>,
        options: &LoadOptions<'_>,
        warnings: &mut Vec<String>,
    ) -> Result<(), GltfError> {
        let mode = primitive.mode();
        if !matches!(
            mode,
            Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan
        ) {
            warnings.push(format!("{object}: {mode:?} have no surface; passed over"));
            return Ok(());
        }
        let Some(positions) = primitive.get(&Semantic::Positions) else {
            warnings.push(format!("{object}: has no positions; passed over"));
            return Ok(());
        };
        let positions = reader.floats::<3>(&positions)?;
        let Some(influences) = influences(primitive, positions.len(), object, reader)? else {
            warnings.push(format!("{object}: has no joints and weights; passed over"));
            return Ok(());
        };
        if primitive.morph_targets().next().is_some() {
            warnings.push(format!("{object}: its morph targets were passed over"));
        }
        let indices = match primitive.indices() {
            Some(accessor) => reader.integers::<1>(&accessor)?.into_flattened(),
            None => (0..positions.len() as u32).collect(),
        };
        if let Some(index) = indices.iter().find(|i| **i as usize >= positions.len()) {
            let reason = format!("names vertex {index} of {}", positions.len());
            return Err(GltfError::invalid(object, reason));
        }
        let base = self.positions.len() as u32;
        let tag = tag_of(&primitive.material(), options)?;
        let before = self.triangles.len();
        self.triangles
            .extend(triangles(&indices, mode).map(|corners| corners.map(|vertex| vertex + base)));
        self.tags
            .resize(self.tags.len() + self.triangles.len() - before, tag);
        self.positions
            .extend(positions.into_iter().map(Vec3::from_array));
        for mut list in influences {
            if list.iter().all(|influence| influence.weight == 0.0) {
                self.unweighted += 1;
                list.truncate(1);
                list.iter_mut().for_each(|influence| influence.weight = 1.0);
            }
            self.influences.push(list);
        }
        Ok(())
    }

    fn build(
        &self,
        joint_count: usize,
        options: &LoadOptions<'_>,
    ) -> Result<(Arc<ColliderMesh>, BuildReport), clamber_surface::mesh::MeshError> {
        let widest = self.influences.iter().map(Vec::len).max().unwrap_or(0);
        let none = Influence {
            joint: JointId(0),
            weight: 0.0,
        };
        let mut flat = Vec::with_capacity(self.influences.len() * widest);
        for list in &self.influences {
            flat.extend_from_slice(list);
            flat.resize(flat.len() + widest - list.len(), none);
        }
        let source = MeshSource {
            positions: &self.positions,
            triangles: &self.triangles,
            influences: &flat,
            tags: &self.tags,
            joint_count,
        };
        let (mesh, report) = ColliderMesh::build(&source, &options.build)?;
        Ok((Arc::new(mesh), report))
    }
}

/// The influences of every vertex, from all sets; `None` if there is no set.
fn influences(
    primitive: &Primitive<'_>,
    vertices: usize,
    object: &str,
    reader: Reader<'_>,
) -> Result<Option<Vec<Vec<Influence>>>, GltfError> {
    let mut lists: Option<Vec<Vec<Influence>>> = None;
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
        let lists = lists.get_or_insert_with(|| vec![Vec::with_capacity(4); vertices]);
        for ((list, joints), weights) in lists.iter_mut().zip(joints).zip(weights) {
            let pairs = joints.into_iter().zip(weights);
            list.extend(pairs.map(|(joint, weight)| Influence {
                joint: JointId(joint),
                weight,
            }));
        }
    }
    Ok(lists)
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
