use bevy_asset::RenderAssetUsages;
use bevy_mesh::{Indices, Mesh, PrimitiveTopology, VertexAttributeValues};
use clamber_gltf::{VisualMesh, VisualPrimitive};
use clamber_surface::mesh::Influence;

/// Influences per vertex in Bevy's meshes.
const INFLUENCES: usize = 4;

/// A mesh asset of one primitive, with the vertices that its triangles use.
///
/// The mesh has positions, joints and weights, and, if the file has them, normals, two sets of texture coordinates and
/// colours. A vertex keeps its four strongest influences; ties go to the smaller joint id. Their weights sum to 1.
pub(super) fn mesh(visual: &VisualMesh, primitive: &VisualPrimitive) -> Mesh {
    let (used, indices) = used_vertices(visual.positions.len(), &primitive.triangles);
    let positions: Vec<[f32; 3]> = pick(&visual.positions, &used, |p| p.to_array());
    let strongest = used.iter().map(|v| strongest(influences(visual, *v)));
    let (joints, weights): (Vec<[u16; 4]>, Vec<[f32; 4]>) = strongest.unzip();
    let mut mesh = Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(
        Mesh::ATTRIBUTE_JOINT_INDEX,
        VertexAttributeValues::Uint16x4(joints),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, weights)
    .with_inserted_indices(Indices::U32(indices));
    let count = visual.positions.len();
    if visual.normals.len() == count {
        let normals: Vec<[f32; 3]> = pick(&visual.normals, &used, |n| n.to_array());
        mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, normals);
    }
    let sets = [Mesh::ATTRIBUTE_UV_0, Mesh::ATTRIBUTE_UV_1];
    for (attribute, set) in sets.into_iter().zip(&visual.tex_coords) {
        if set.len() == count {
            let coordinates: Vec<[f32; 2]> = pick(set, &used, |c| c.to_array());
            mesh.insert_attribute(attribute, coordinates);
        }
    }
    if visual.colors.len() == count {
        let colors: Vec<[f32; 4]> = pick(&visual.colors, &used, |c| *c);
        mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, colors);
    }
    mesh
}

/// The vertices that triangles use, in the order of their first use, and the triangles' indices into that list.
/// Triangles with an index out of range are left out.
fn used_vertices(count: usize, triangles: &[[u32; 3]]) -> (Vec<usize>, Vec<u32>) {
    let mut new_of_old = vec![None; count];
    let (mut used, mut indices) = (Vec::new(), Vec::new());
    for triangle in triangles {
        if triangle.iter().any(|v| *v as usize >= count) {
            continue;
        }
        for vertex in triangle.map(|v| v as usize) {
            let new = *new_of_old[vertex].get_or_insert_with(|| {
                used.push(vertex);
                used.len() as u32 - 1
            });
            indices.push(new);
        }
    }
    (used, indices)
}

fn pick<T, U>(all: &[T], used: &[usize], as_attribute: impl Fn(&T) -> U) -> Vec<U> {
    used.iter().map(|v| as_attribute(&all[*v])).collect()
}

/// The influences of a vertex.
fn influences(visual: &VisualMesh, vertex: usize) -> &[Influence] {
    let ends = &visual.influence_ends;
    let start = vertex.checked_sub(1).and_then(|before| ends.get(before));
    let (start, end) = (start.copied().unwrap_or(0), ends.get(vertex).copied());
    let range = start as usize..end.unwrap_or(start) as usize;
    visual.influences.get(range).unwrap_or_default()
}

/// The joints and weights of the four strongest influences.
fn strongest(influences: &[Influence]) -> ([u16; 4], [f32; 4]) {
    let mut sorted = influences.to_vec();
    sorted.sort_by(|a, b| b.weight.total_cmp(&a.weight).then(a.joint.cmp(&b.joint)));
    sorted.truncate(INFLUENCES);
    let sum: f64 = sorted.iter().map(|i| f64::from(i.weight)).sum();
    let (mut joints, mut weights) = ([0; INFLUENCES], [0.0; INFLUENCES]);
    for (index, influence) in sorted.iter().enumerate() {
        // `RigAssets::new` refuses rigs with more joints.
        joints[index] = u16::try_from(influence.joint.0).unwrap_or(u16::MAX);
        weights[index] = (f64::from(influence.weight) / sum) as f32;
    }
    (joints, weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clamber_surface::rig::JointId;
    use glam::Vec3;

    fn influence((joint, weight): (u32, f32)) -> Influence {
        let joint = JointId(joint);
        Influence { joint, weight }
    }

    #[test]
    fn the_four_strongest_influences_stay() {
        let six = [(0, 0.1), (1, 0.3), (2, 0.05), (3, 0.2), (7, 0.25), (9, 0.1)];
        let (joints, weights) = strongest(&six.map(influence));
        assert_eq!(joints, [1, 7, 3, 0]);
        let expected = [0.3, 0.25, 0.2, 0.1].map(|weight| weight / 0.85);
        for (found, expected) in weights.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-6, "{weights:?}");
        }
        assert_eq!(
            strongest(&[influence((5, 1.0))]),
            ([5, 0, 0, 0], [1.0, 0.0, 0.0, 0.0])
        );
    }

    #[test]
    fn vertices_that_a_primitive_does_not_use_are_left_out() {
        let mut visual = VisualMesh::default();
        visual.positions = (0..5).map(|x| Vec3::X * x as f32).collect();
        visual.normals = vec![Vec3::Y; 5];
        visual.influences = (0..5).map(|joint| influence((joint, 1.0))).collect();
        visual.influence_ends = (1..=5).collect();
        let mut primitive = VisualPrimitive::default();
        primitive.triangles = vec![[4, 1, 3], [1, 4, 2], [0, 1, 5]];
        let mesh = mesh(&visual, &primitive);
        let positions = mesh.attribute(Mesh::ATTRIBUTE_POSITION).unwrap();
        let x: Vec<f32> = positions
            .as_float3()
            .unwrap()
            .iter()
            .map(|p| p[0])
            .collect();
        assert_eq!(x, [4.0, 1.0, 3.0, 2.0]);
        let corners: Vec<usize> = mesh.indices().unwrap().iter().collect();
        assert_eq!(corners, [0, 1, 2, 1, 0, 3]);
        let joints = mesh.attribute(Mesh::ATTRIBUTE_JOINT_INDEX).unwrap();
        let VertexAttributeValues::Uint16x4(joints) = joints else {
            panic!("{joints:?}");
        };
        assert_eq!(
            joints.iter().map(|j| j[0]).collect::<Vec<_>>(),
            [4, 1, 3, 2]
        );
        assert_eq!(mesh.attribute(Mesh::ATTRIBUTE_NORMAL).unwrap().len(), 4);
    }
}
