//! Reads the vertices and triangles of a primitive from its accessors.

use clamber_surface::mesh::Influence;
use clamber_surface::rig::JointId;
use glam::{DVec3, Vec3};
use gltf::mesh::{Mode, Semantic};
use gltf::{Accessor, Primitive};

use crate::GltfErrorKind;
use crate::accessor::Reader;
use crate::readings::Shape;

/// The joints that move the vertices of a mesh.
pub(crate) enum Binding<'a> {
    /// The joints of a skin, by the index that vertices name.
    Skin(&'a [JointId]),
    /// The joint that moves the whole mesh.
    Rigid(JointId),
}

/// The positions of vertices, and the influences that move them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Vertices {
    pub(crate) positions: Vec<Vec3>,
    pub(crate) influences: Vec<Influence>,
    /// Where each vertex's influences end.
    pub(crate) influence_ends: Vec<u32>,
    /// Number of vertices whose weights are all zero, and which follow the first joint that they name.
    pub(crate) unweighted: usize,
}

/// True if a primitive consists of triangles, not of points or lines.
pub(crate) fn has_surface(primitive: &Primitive<'_>) -> bool {
    let mode = primitive.mode();
    matches!(
        mode,
        Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan
    )
}

/// Why a primitive is skipped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum PassedOver {
    /// The primitive belongs to a skinned mesh, but lacks joints and weights.
    NoWeights,
    PointsOrLines,
    NoPositions,
}

/// Why a primitive is skipped; `None` if it is loaded.
pub(crate) fn passed_over(primitive: &Primitive<'_>, binding: &Binding<'_>) -> Option<PassedOver> {
    if !has_surface(primitive) {
        return Some(PassedOver::PointsOrLines);
    }
    if primitive.get(&Semantic::Positions).is_none() {
        return Some(PassedOver::NoPositions);
    }
    let sets = [Semantic::Joints(0), Semantic::Weights(0)];
    let unskinned = sets.iter().all(|set| primitive.get(set).is_none());
    (unskinned && matches!(binding, Binding::Skin(_))).then_some(PassedOver::NoWeights)
}

/// Reads positions, with morph targets at these weights, and charges the memory that their vertices take later.
pub(crate) fn positions(
    primitive: &Primitive<'_>,
    morph_weights: &[f32],
    object: &str,
    reader: &Reader<'_>,
) -> Result<Vec<Vec3>, GltfErrorKind> {
    let Some(accessor) = primitive.get(&Semantic::Positions) else {
        return Ok(Vec::new());
    };
    let rest = reader.floats::<3>(&accessor)?;
    let targets = primitive.morph_targets().len();
    if !morph_weights.is_empty() && targets != morph_weights.len() {
        let found = morph_weights.len();
        let reason = format!("has {targets} morph targets, but {found} weights for them");
        return Err(GltfErrorKind::invalid(object, reason));
    }
    reader.charge(object, rest.len().saturating_mul(BUILD_BYTES))?;
    let deltas = primitive.morph_targets().map(|target| target.positions());
    morphed(rest, deltas, morph_weights, object, reader)
}

/// The vertices of a primitive, with the influences that a binding gives them.
pub(crate) fn vertices(
    shape: &Shape,
    primitive: &Primitive<'_>,
    binding: &Binding<'_>,
    object: &str,
    reader: &Reader<'_>,
) -> Result<Vertices, GltfErrorKind> {
    let count = shape.positions.len();
    let mut vertices = Vertices {
        positions: shape.positions.clone(),
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
            let sets = shape.weights(primitive, object, reader)?;
            for vertex in 0..count {
                vertices.push_influences(sets, vertex, object, joints)?;
            }
        }
    }
    Ok(vertices)
}

/// Bound on the memory that a vertex takes in a collider and a visual mesh, bytes. It is charged before it is
/// allocated, so that files that claim more vertices than they hold are refused before memory runs out.
const BUILD_BYTES: usize = 256;

/// Positions or normals with morph targets applied. A target that does not move them is `None`. The sums are taken in
/// f64 in the order of the targets, and rounded once.
pub(crate) fn morphed<'a>(
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
    /// Appends the influences of a vertex. Influences of weight 0 are padding and may name any joint.
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
                let reason = format!("names joint {index} of a skin of {} joints", joints.len());
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
pub(crate) type WeightSet = (Vec<[u32; 4]>, Vec<[f32; 4]>);

/// Reads all weight sets of a primitive.
pub(crate) fn weight_sets(
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

/// Reads the triangles of a primitive with `vertices` vertices.
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
    if primitive.mode() == Mode::Triangles && !indices.len().is_multiple_of(3) {
        let reason = format!("has {} corners, not a multiple of 3", indices.len());
        return Err(GltfErrorKind::invalid(object, reason));
    }
    // A strip makes up to one triangle of every index: three corners for the collider, three for drawing, and the
    // triangle's number in the list of its material.
    reader.charge(object, indices.len().saturating_mul(7 * size_of::<u32>()))?;
    Ok(corners(&indices, primitive.mode()).collect())
}

/// The triangles of a list, strip or fan, all with the same winding.
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
