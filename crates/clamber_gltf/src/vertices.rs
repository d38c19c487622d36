//! The vertices and triangles of a primitive, out of its accessors.

use clamber_surface::mesh::Influence;
use clamber_surface::rig::JointId;
use glam::{DVec3, Vec2, Vec3};
use gltf::mesh::{Mode, Semantic};
use gltf::{Accessor, Primitive};

use crate::GltfErrorKind;
use crate::accessor::Reader;

/// What moves the vertices of a mesh.
pub(crate) enum Binding<'a> {
    /// The joints of a skin, by the index that vertices name.
    Skin(&'a [JointId]),
    /// One joint moves all of it.
    Rigid(JointId),
}

/// Where vertices are and what moves them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Vertices {
    pub(crate) positions: Vec<Vec3>,
    pub(crate) influences: Vec<Influence>,
    /// Where each vertex's influences end.
    pub(crate) influence_ends: Vec<u32>,
    /// How many have no weights, and follow the first joint that they name.
    pub(crate) unweighted: usize,
}

/// How they look.
#[derive(Clone, Debug, Default)]
pub(crate) struct Looks {
    pub(crate) normals: Vec<Vec3>,
    pub(crate) tex_coords: Vec<Vec<Vec2>>,
    pub(crate) colors: Vec<[f32; 4]>,
}

/// Why a primitive is no part of a surface; `None` if it is.
pub(crate) fn passed_over(primitive: &Primitive<'_>, binding: &Binding<'_>) -> Option<String> {
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
    (unskinned && matches!(binding, Binding::Skin(_))).then(|| "has no joints and weights".into())
}

/// Reads positions, with morph targets at their rest weights, and influences.
pub(crate) fn vertices(
    primitive: &Primitive<'_>,
    binding: &Binding<'_>,
    morph_weights: &[f32],
    object: &str,
    reader: &Reader<'_>,
) -> Result<Vertices, GltfErrorKind> {
    let Some(accessor) = primitive.get(&Semantic::Positions) else {
        return Ok(Vertices::default());
    };
    let rest = reader.floats::<3>(&accessor)?;
    let count = rest.len();
    reader.charge(object, count.saturating_mul(BUILD_BYTES))?;
    let deltas = primitive.morph_targets().map(|target| target.positions());
    let positions = morphed(rest, deltas, morph_weights, object, reader)?;
    let mut vertices = Vertices {
        positions,
        ..Vertices::default()
    };
    match binding {
        Binding::Rigid(joint) => {
            let influence = Influence {
                joint: *joint,
                weight: 1.0,
            };
            vertices.influences = vec![influence; count];
            vertices.influence_ends = (1..=count as u32).collect();
        }
        Binding::Skin(joints) => {
            let sets = weight_sets(primitive, count, object, reader)?;
            for vertex in 0..count {
                vertices.push_influences(&sets, vertex, object, joints)?;
            }
        }
    }
    Ok(vertices)
}

/// What is needed to make a vertex part of a collider and a visual mesh, bytes: a bound on it, so
/// that files which claim more vertices than they hold are refused before the memory is full.
const BUILD_BYTES: usize = 256;

/// Positions or normals moved by morph targets, `None` for a target that does not move them.
/// Added up in f64 in the order of the targets, rounded once.
fn morphed<'a>(
    rest: Vec<[f32; 3]>,
    targets: impl Iterator<Item = Option<Accessor<'a>>>,
    weights: &[f32],
    object: &str,
    reader: &Reader<'_>,
) -> Result<Vec<Vec3>, GltfErrorKind> {
    let weighted = targets.zip(weights).filter(|(_, weight)| **weight != 0.0);
    let moving: Vec<(Accessor<'a>, f32)> = weighted
        .filter_map(|(target, weight)| Some((target?, *weight)))
        .collect();
    if moving.is_empty() {
        return Ok(rest.into_iter().map(Vec3::from_array).collect());
    }
    reader.charge(object, rest.len().saturating_mul(size_of::<DVec3>()))?;
    let wide = |p: &[f32; 3]| DVec3::from_array(p.map(f64::from));
    let mut sums: Vec<DVec3> = rest.iter().map(wide).collect();
    for (accessor, weight) in moving {
        let deltas = reader.floats::<3>(&accessor)?;
        if deltas.len() != sums.len() {
            let reason = format!(
                "has {} vertices, but a morph target of {}",
                sums.len(),
                deltas.len()
            );
            return Err(GltfErrorKind::invalid(object, reason));
        }
        for (sum, delta) in sums.iter_mut().zip(&deltas) {
            *sum += wide(delta) * f64::from(weight);
        }
    }
    Ok(sums.into_iter().map(|sum| sum.as_vec3()).collect())
}

impl Vertices {
    /// Appends the influences of a vertex. What weighs nothing is padding and may name any joint.
    fn push_influences(
        &mut self,
        sets: &[WeightSet],
        vertex: usize,
        object: &str,
        joints: &[JointId],
    ) -> Result<(), GltfErrorKind> {
        let start = self.influences.len();
        let named = || {
            sets.iter()
                .flat_map(|(joints, weights)| joints[vertex].into_iter().zip(weights[vertex]))
        };
        let joint = |index: u32| {
            joints.get(index as usize).copied().ok_or_else(|| {
                let reason = format!("follows joint {index} of a skin of {}", joints.len());
                GltfErrorKind::invalid(object, reason)
            })
        };
        for (index, weight) in named().filter(|(_, weight)| *weight != 0.0) {
            self.influences.push(Influence {
                joint: joint(index)?,
                weight,
            });
        }
        if self.influences.len() == start {
            self.unweighted += 1;
            if let Some((index, _)) = named().next() {
                self.influences.push(Influence {
                    joint: joint(index)?,
                    weight: 1.0,
                });
            }
        }
        let end = u32::try_from(self.influences.len())
            .map_err(|_| GltfErrorKind::invalid(object, "has more than 2^32 weights"))?;
        self.influence_ends.push(end);
        Ok(())
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
) -> Result<Vec<WeightSet>, GltfErrorKind> {
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
                return Err(GltfErrorKind::invalid(object, reason));
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
            return Err(GltfErrorKind::invalid(object, reason));
        }
        sets.push((joints, weights));
    }
    Ok(sets)
}

/// Reads normals, morphed as the positions are, texture coordinates and colours, of as many
/// vertices as there are positions.
pub(crate) fn looks(
    primitive: &Primitive<'_>,
    vertices: usize,
    morph_weights: &[f32],
    object: &str,
    reader: &Reader<'_>,
) -> Result<Looks, GltfErrorKind> {
    let check = |what: &str, found: usize| {
        let reason = || format!("has {vertices} positions, but {found} {what}");
        (found == vertices)
            .then_some(())
            .ok_or_else(|| GltfErrorKind::invalid(object, reason()))
    };
    let mut looks = Looks::default();
    if let Some(accessor) = primitive.get(&Semantic::Normals) {
        let rest = reader.floats::<3>(&accessor)?;
        check("normals", rest.len())?;
        let deltas = primitive.morph_targets().map(|target| target.normals());
        looks.normals = morphed(rest, deltas, morph_weights, object, reader)?;
    }
    for set in 0.. {
        let Some(accessor) = primitive.get(&Semantic::TexCoords(set)) else {
            break;
        };
        let coordinates = reader.floats::<2>(&accessor)?;
        check("texture coordinates", coordinates.len())?;
        looks
            .tex_coords
            .push(coordinates.into_iter().map(Vec2::from_array).collect());
    }
    if let Some(accessor) = primitive.get(&Semantic::Colors(0)) {
        looks.colors = colors(&accessor, reader)?;
        check("colours", looks.colors.len())?;
    }
    Ok(looks)
}

/// Colours with opacity, which is 1 where the file gives none.
fn colors(accessor: &Accessor<'_>, reader: &Reader<'_>) -> Result<Vec<[f32; 4]>, GltfErrorKind> {
    if accessor.dimensions().multiplicity() == 3 {
        let opaque = |[r, g, b]: [f32; 3]| [r, g, b, 1.0];
        return Ok(reader
            .floats::<3>(accessor)?
            .into_iter()
            .map(opaque)
            .collect());
    }
    reader.floats::<4>(accessor)
}

/// The triangles of a primitive that has so many vertices.
pub(crate) fn triangles(
    primitive: &Primitive<'_>,
    vertices: usize,
    object: &str,
    reader: &Reader<'_>,
) -> Result<Vec<[u32; 3]>, GltfErrorKind> {
    let indices = match primitive.indices() {
        Some(accessor) => reader.integers::<1>(&accessor)?.into_flattened(),
        None => {
            reader.charge(object, vertices * size_of::<u32>())?;
            (0..vertices as u32).collect()
        }
    };
    if let Some(index) = indices.iter().find(|i| **i as usize >= vertices) {
        let reason = format!("names vertex {index} of {vertices}");
        return Err(GltfErrorKind::invalid(object, reason));
    }
    // A strip makes three corners of every index, for a collider and to be drawn.
    reader.charge(object, indices.len().saturating_mul(6 * size_of::<u32>()))?;
    Ok(corners(&indices, primitive.mode()).collect())
}

/// The triangles of a list, strip or fan, all with the same side outside.
fn corners(indices: &[u32], mode: Mode) -> impl Iterator<Item = [u32; 3]> {
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
        let all = |mode| corners(&[0, 1, 2, 3, 4], mode).collect::<Vec<_>>();
        assert_eq!(all(Mode::Triangles), [[0, 1, 2]]);
        assert_eq!(all(Mode::TriangleStrip), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        assert_eq!(all(Mode::TriangleFan), [[1, 2, 0], [2, 3, 0], [3, 4, 0]]);
        assert_eq!(corners(&[0], Mode::TriangleStrip).count(), 0);
    }
}
