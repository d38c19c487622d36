use std::collections::BTreeMap;

use glam::Vec3;

use super::super::{ColliderMesh, Influence, MeshSource, PartId, SurfaceTag, TriangleId, VertexId};
use super::*;
use crate::testing::{built, influence, point, separate, tube};

/// A mesh from vertices with their influences.
fn mesh_of(
    vertices: &[(Vec3, Vec<Influence>)],
    triangles: &[[u32; 3]],
    joint_count: usize,
) -> ColliderMesh {
    let positions: Vec<Vec3> = vertices.iter().map(|v| v.0).collect();
    let influences: Vec<Influence> = vertices.iter().flat_map(|v| v.1.clone()).collect();
    let mut ends = Vec::new();
    for (_, influences) in vertices {
        ends.push(ends.last().copied().unwrap_or(0) + influences.len() as u32);
    }
    built(&MeshSource {
        positions: &positions,
        triangles,
        influences: &influences,
        influence_ends: &ends,
        joint_count,
        ..MeshSource::default()
    })
}

fn influences(rng: &mut fastrand::Rng, count: usize, joints: u32) -> Vec<Influence> {
    let any = |_| influence(rng.u32(0..joints), rng.f32() + 0.01);
    (0..count).map(any).collect()
}

/// Triangles without shared vertices.
fn soup(seed: u64, triangles: u32, joints: u32, most_influences: usize) -> ColliderMesh {
    let mut rng = fastrand::Rng::with_seed(seed);
    let vertices: Vec<_> = (0..triangles * 3)
        .map(|_| {
            let count = rng.usize(1..=most_influences);
            (point(&mut rng, 10.0), influences(&mut rng, count, joints))
        })
        .collect();
    mesh_of(&vertices, &separate(triangles), joints as usize)
}

/// Random triangles on few vertices.
fn tangle(seed: u64, vertices: u32, triangles: u32, joints: u32) -> ColliderMesh {
    let mut rng = fastrand::Rng::with_seed(seed);
    let vertices: Vec<_> = (0..vertices)
        .map(|_| (point(&mut rng, 1.0), influences(&mut rng, 3, joints)))
        .collect();
    let corner = |rng: &mut fastrand::Rng| rng.u32(0..vertices.len() as u32);
    let triangles: Vec<_> = (0..triangles)
        .map(|_| [corner(&mut rng), corner(&mut rng), corner(&mut rng)])
        .collect();
    mesh_of(&vertices, &triangles, joints as usize)
}

/// The tube without every third triangle and without all triangles of one part, but with a triangle added.
fn holed_tube() -> ColliderMesh {
    let mut mesh = ColliderMesh::clone(&tube(7, 20));
    for triangle in 0..mesh.triangles().len() as u32 {
        let triangle = TriangleId(triangle);
        let part = mesh.part_of(triangle).unwrap();
        if triangle.0.is_multiple_of(3) || part == PartId(2) {
            mesh.remove_triangle(triangle);
        }
    }
    mesh.add_triangle([0, 40, 90].map(VertexId), SurfaceTag::default());
    mesh.recluster(&(0..7).map(PartId).collect());
    assert!(mesh.parts()[2].triangles.is_empty());
    mesh
}

fn one_triangle() -> ColliderMesh {
    let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| (p, vec![influence(0, 1.0)]));
    mesh_of(&vertices, &[[0, 1, 2]], 1)
}

/// A fan of triangles about a vertex with 16 influences. The vertices of its rim have up to two.
fn sixteen_influences() -> ColliderMesh {
    let mut rng = fastrand::Rng::with_seed(3);
    let mut vertices = vec![(Vec3::ZERO, influences(&mut rng, 16, 65_536))];
    for _ in 0..200 {
        vertices.push((point(&mut rng, 1.0), influences(&mut rng, 2, 5)));
    }
    let triangles: Vec<_> = (1..200).map(|v| [0, v, v + 1]).collect();
    mesh_of(&vertices, &triangles, 65_536)
}

/// A mesh whose only triangle was removed.
fn nothing() -> ColliderMesh {
    let mut mesh = one_triangle();
    mesh.remove_triangle(TriangleId(0));
    mesh.recluster(&[PartId(0)].into());
    mesh
}

/// The meshes on which the tests of clusters and of the hierarchy run.
pub(in crate::mesh) fn meshes() -> Vec<(&'static str, ColliderMesh)> {
    vec![
        ("tube", ColliderMesh::clone(&tube(6, 24))),
        ("fine tube", ColliderMesh::clone(&tube(40, 40))),
        ("tube with holes", holed_tube()),
        ("soup", soup(1, 700, 9, 4)),
        ("soup of one joint", soup(2, 300, 1, 1)),
        ("soup of many joints", soup(4, 300, 500, 12)),
        ("tangle", tangle(5, 80, 4_000, 3)),
        ("one triangle", one_triangle()),
        ("16 influences", sixteen_influences()),
        ("nothing", nothing()),
    ]
}

/// The rest data of a slot: its position, and its weights by joint, without zeros.
fn slot_data(clusters: &Clusters, cluster: &Cluster, slot: usize) -> (Vec3, Vec<(u32, f32)>) {
    let first = cluster.first_rest as usize + slot / ROW * (3 + cluster.joints as usize);
    let value = |k: usize| clusters.rest[first + k].0[slot % ROW];
    let joints = &clusters.joints[cluster.first_joint as usize..][..cluster.joints as usize];
    let weights = joints.iter().enumerate().map(|(k, j)| (*j, value(3 + k)));
    (
        Vec3::new(value(0), value(1), value(2)),
        weights.filter(|(_, w)| *w != 0.0).collect(),
    )
}

#[test]
fn every_triangle_is_in_exactly_one_cluster_of_its_part() {
    for (name, mesh) in meshes() {
        let (clusters, _) = build(&mesh);
        let mut seen = BTreeMap::new();
        for (index, cluster) in clusters.clusters.iter().enumerate() {
            let count = usize::from(cluster.triangles);
            assert!((1..=MAX_TRIANGLES).contains(&count), "{name}: {cluster:?}");
            let first = cluster.first_block as usize;
            let blocks = count.div_ceil(BLOCK);
            let padded = &clusters.triangles[first * BLOCK..][..blocks * BLOCK];
            let (ids, padding) = padded.split_at(count);
            assert!(ids.is_sorted(), "{name}: {ids:?}");
            assert!(padding.iter().all(|t| *t == TriangleId(u32::MAX)), "{name}");
            for (place, triangle) in ids.iter().enumerate() {
                assert_eq!(seen.insert(*triangle, index), None, "{name}: {triangle}");
                assert_eq!(mesh.part_of(*triangle), Some(cluster.part), "{name}");
                let block = &clusters.corners[first + place / BLOCK];
                let slots = block.0.map(|corner| usize::from(corner[place % BLOCK]));
                assert!(
                    slots.iter().all(|s| *s < usize::from(cluster.slots)),
                    "{name}"
                );
                let row = cluster.first_row as usize * ROW;
                let corners = slots.map(|slot| clusters.vertices[row + slot]);
                assert_eq!(corners, mesh.triangles()[triangle.index()], "{name}");
            }
            for place in count..blocks * BLOCK {
                let block = &clusters.corners[first + place / BLOCK];
                assert!(block.0.iter().all(|c| c[place % BLOCK] == 0), "{name}");
            }
        }
        let wanted = (0..mesh.triangles().len()).map(|t| TriangleId(t as u32));
        let wanted: Vec<_> = wanted.filter(|t| mesh.part_of(*t).is_some()).collect();
        assert_eq!(seen.into_keys().collect::<Vec<_>>(), wanted, "{name}");
    }
}

#[test]
fn slots_hold_owned_vertices_before_copies() {
    for (name, mesh) in meshes() {
        let (clusters, _) = build(&mesh);
        let mut owner = BTreeMap::new();
        for (index, cluster) in clusters.clusters.iter().enumerate() {
            let (slots, owned) = (usize::from(cluster.slots), usize::from(cluster.owned));
            assert!((3..=MAX_SLOTS).contains(&slots) && owned <= slots, "{name}");
            let first = cluster.first_row as usize * ROW;
            let padded = &clusters.vertices[first..][..cluster.rows() * ROW];
            let (vertices, padding) = padded.split_at(slots);
            assert!(padding.iter().all(|v| *v == VertexId(u32::MAX)), "{name}");
            let (own, copies) = vertices.split_at(owned);
            for vertices in [own, copies] {
                let ascending = vertices.windows(2).all(|w| w[0] < w[1]);
                assert!(ascending, "{name}: {vertices:?}");
            }
            for vertex in own {
                assert_eq!(owner.insert(*vertex, index), None, "{name}: {vertex}");
            }
            for vertex in copies {
                assert!(owner[vertex] < index, "{name}: {vertex}");
            }
            let joints = &clusters.joints[cluster.first_joint as usize..];
            let joints = &joints[..cluster.joints as usize];
            assert!(joints.windows(2).all(|w| w[0] < w[1]), "{name}: {joints:?}");
            let mut moved = Vec::new();
            for (slot, vertex) in vertices.iter().enumerate() {
                let (position, weights) = slot_data(&clusters, cluster, slot);
                assert_eq!(position, mesh.positions()[vertex.index()], "{name}");
                let wanted: Vec<_> = mesh.influences(*vertex).map(|(j, w)| (j.0, w)).collect();
                assert_eq!(weights, wanted, "{name}: {vertex}");
                moved.extend(weights.iter().map(|w| w.0));
            }
            assert!(
                joints.iter().all(|j| moved.contains(j)),
                "{name}: {joints:?}"
            );
            for slot in slots..cluster.rows() * ROW {
                let first = slot_data(&clusters, cluster, 0);
                assert_eq!(slot_data(&clusters, cluster, slot), first, "{name}");
            }
        }
        let all = (0..mesh.positions().len()).map(|v| VertexId(v as u32));
        let loose: Vec<_> = all.filter(|v| !owner.contains_key(v)).collect();
        assert_eq!(clusters.loose, loose, "{name}");
    }
}

#[test]
fn clusters_are_packed_without_gaps() {
    for (name, mesh) in meshes() {
        let (clusters, _) = build(&mesh);
        let (mut row, mut rest, mut joint, mut block) = (0, 0, 0, 0);
        for c in &clusters.clusters {
            let firsts = (c.first_row, c.first_rest, c.first_joint, c.first_block);
            assert_eq!(firsts, (row, rest, joint, block), "{name}");
            let rows = c.rows() as u32;
            row += rows;
            rest += (3 + c.joints) * rows;
            joint += c.joints;
            block += usize::from(c.triangles).div_ceil(BLOCK) as u32;
        }
        assert_eq!(clusters.vertices.len(), row as usize * ROW, "{name}");
        assert_eq!(clusters.rest.len(), rest as usize, "{name}");
        assert_eq!(clusters.joints.len(), joint as usize, "{name}");
        assert_eq!(clusters.corners.len(), block as usize, "{name}");
        assert_eq!(clusters.triangles.len(), block as usize * BLOCK, "{name}");
    }
}

/// Slots per owned vertex, and triangles per cluster.
fn fill(clusters: &Clusters) -> (f64, f64) {
    let clusters = &clusters.clusters;
    let sum = |of: fn(&Cluster) -> u8| clusters.iter().map(|c| f64::from(of(c))).sum::<f64>();
    let copies = sum(|c| c.slots) / sum(|c| c.owned);
    (copies, sum(|c| c.triangles) / clusters.len() as f64)
}

#[test]
fn few_copies_and_full_clusters_on_a_smooth_skin() {
    // A square grid of 20,000 triangles, whose weights go over from one joint to the other along X.
    let side = 101;
    let mut vertices = Vec::new();
    for v in 0..side * side {
        let (x, y) = ((v % side) as f32 / 100.0, (v / side) as f32 / 100.0);
        let influences = vec![influence(0, x), influence(1, 1.0 - x)];
        vertices.push((Vec3::new(x, y, 0.1 * x * y), influences));
    }
    let corners = (0..side * side).filter(|v| v % side + 1 < side && v / side + 1 < side);
    let triangles: Vec<_> = corners
        .flat_map(|v| [[v, v + 1, v + side], [v + 1, v + side + 1, v + side]])
        .collect();
    let (clusters, _) = build(&mesh_of(&vertices, &triangles, 2));
    let (copies, triangles) = fill(&clusters);
    // Hexagonal clusters of 96 triangles would give 1.27.
    assert!(copies < 1.35, "{copies}");
    assert!(triangles > 80.0, "{triangles}");
}

#[test]
fn triangles_that_share_no_vertex_fill_their_clusters() {
    let (clusters, _) = build(&soup(2, 3_000, 1, 1));
    let (copies, triangles) = fill(&clusters);
    assert_eq!(copies, 1.0);
    assert!(triangles > 18.0, "{triangles}");
}

#[test]
fn the_same_mesh_gives_the_same_clusters() {
    for (name, mesh) in meshes() {
        assert_eq!(build(&mesh), build(&mesh.clone()), "{name}");
    }
}

#[test]
fn tiny_and_huge_coordinates_are_clustered() {
    let mut rng = fastrand::Rng::with_seed(9);
    for scale in [1e-40, 1e-20, 1e20, 3e29] {
        let vertices: Vec<_> = (0..900)
            .map(|v| (point(&mut rng, scale), vec![influence(v / 450, 1.0)]))
            .collect();
        let mesh = mesh_of(&vertices, &separate(300), 2);
        let (clusters, _) = build(&mesh);
        let triangles = clusters.clusters.iter().map(|c| usize::from(c.triangles));
        assert_eq!(triangles.sum::<usize>(), mesh.triangles().len(), "{scale}");
    }
}
