use std::collections::BTreeSet;
use std::sync::Arc;

use glam::Vec3;

use super::*;
use crate::mesh::{MeshSource, SurfaceTag, VertexId};
use crate::surface::SkinnedSurface;
use crate::testing::{built, point};

fn mesh(positions: &[Vec3], triangles: &[[u32; 3]]) -> ColliderMesh {
    built(&MeshSource::rigid(positions, triangles))
}

/// Random triangles on few vertices: some edges have many triangles, some have one.
fn crowd(rng: &mut fastrand::Rng) -> ColliderMesh {
    let vertices = rng.u32(4..14);
    let positions: Vec<Vec3> = (0..vertices).map(|_| point(rng, 1.0)).collect();
    let triangles: Vec<[u32; 3]> = (0..rng.usize(1..25))
        .map(|_| {
            let first = rng.u32(0..vertices);
            let second = (first + rng.u32(1..vertices)) % vertices;
            let third = (0..vertices).filter(|v| *v != first && *v != second);
            let third: Vec<u32> = third.collect();
            [first, second, third[rng.usize(0..third.len())]]
        })
        .collect();
    mesh(&positions, &triangles)
}

/// The start and the end of side `k` of a triangle.
fn side(mesh: &ColliderMesh, triangle: TriangleId, k: usize) -> [VertexId; 2] {
    let corners = mesh.triangles()[triangle.index()];
    [corners[k], corners[(k + 1) % 3]]
}

/// The neighbour by brute force, from the rule in the docs of [`ColliderMesh::neighbours`]: lists all sides at the
/// edge by direction, and pairs them in ascending order.
fn neighbour_reference(mesh: &ColliderMesh, triangle: TriangleId, k: usize) -> Option<TriangleId> {
    let [from, to] = side(mesh, triangle, k);
    let (mut same, mut opposite) = (Vec::new(), Vec::new());
    for other in living(mesh) {
        for j in 0..3 {
            let edge = side(mesh, other, j);
            if edge == [from, to] {
                same.push(other);
            } else if edge == [to, from] {
                opposite.push(other);
            }
        }
    }
    let place = same.iter().position(|t| *t == triangle).unwrap();
    if let Some(found) = opposite.get(place) {
        return Some(*found);
    }
    let left = &same[opposite.len()..];
    left.get((place - opposite.len()) ^ 1).copied()
}

fn living(mesh: &ColliderMesh) -> impl Iterator<Item = TriangleId> {
    let all = (0..mesh.triangles().len() as u32).map(TriangleId);
    all.filter(|triangle| mesh.part_of(*triangle).is_some())
}

/// The island by brute force: compares all pairs of triangles until nothing is added any more.
fn island_reference(mesh: &ColliderMesh, triangle: TriangleId) -> BTreeSet<TriangleId> {
    let mut island = BTreeSet::from([triangle]);
    loop {
        let shares_edge = |a: TriangleId, b: TriangleId| {
            let corners = mesh.triangles()[a.index()];
            let other = mesh.triangles()[b.index()];
            corners.iter().filter(|v| other.contains(v)).count() >= 2
        };
        let reached: Vec<TriangleId> = living(mesh)
            .filter(|t| island.iter().any(|inside| shares_edge(*inside, *t)))
            .collect();
        let before = island.len();
        island.extend(reached);
        if island.len() == before {
            return island;
        }
    }
}

fn assert_agrees(mesh: &ColliderMesh, told: &str) {
    let mut lowest = BTreeSet::new();
    for triangle in living(mesh) {
        let neighbours = mesh.neighbours(triangle);
        for (k, neighbour) in neighbours.into_iter().enumerate() {
            let expected = neighbour_reference(mesh, triangle, k);
            assert_eq!(neighbour, expected, "{told}: {triangle} side {k}");
            if let Some(other) = neighbour {
                assert!(mesh.neighbours(other).contains(&Some(triangle)), "{told}");
            }
        }
        let island = island_reference(mesh, triangle);
        for other in living(mesh) {
            let together = mesh.island_of(other) == mesh.island_of(triangle);
            let found = island.contains(&other);
            assert_eq!(together, found, "{told}: {triangle} and {other}");
        }
        lowest.insert(island.first().copied());
    }
    assert_eq!(mesh.island_count(), lowest.len(), "{told}");
    for (island, lowest) in (0..).map(IslandId).zip(lowest) {
        let found = lowest.and_then(|lowest| mesh.island_of(lowest));
        assert_eq!(found, Some(island), "{told}");
    }
    let removed = (0..mesh.triangles().len() as u32 + 2).map(TriangleId);
    for gone in removed.filter(|triangle| mesh.part_of(*triangle).is_none()) {
        assert_eq!(mesh.neighbours(gone), [None; 3], "{told}: {gone}");
        assert_eq!(mesh.island_of(gone), None, "{told}: {gone}");
    }
}

#[test]
fn crowds_of_triangles_agree_with_the_reference() {
    let mut rng = fastrand::Rng::with_seed(91);
    let mut crowded = 0;
    for round in 0..400 {
        let mesh = crowd(&mut rng);
        assert_agrees(&mesh, &format!("round {round}"));
        crowded += usize::from(mesh.triangles().len() > mesh.positions().len() * 2);
    }
    assert!(crowded > 20, "{crowded}");
}

#[test]
fn edits_are_seen_at_once() {
    let mut rng = fastrand::Rng::with_seed(92);
    for round in 0..60 {
        let mut surface = SkinnedSurface::new(Arc::new(crowd(&mut rng)));
        for step in 0..6 {
            // Reads before the edit, so that the edit has to invalidate what was computed.
            assert_agrees(surface.mesh(), &format!("round {round} step {step}"));
            surface.edit(|edit| {
                for _ in 0..rng.u32(1..4) {
                    let gone = TriangleId(rng.u32(0..26));
                    // Refused if there is no such triangle.
                    let _ = edit.remove_triangle(gone);
                    let mut any = || VertexId(rng.u32(0..14));
                    let _ = edit.add_triangle([any(), any(), any()], SurfaceTag::default());
                }
            });
        }
    }
}

/// A tetrahedron: every triangle has three neighbours, and all form one island.
#[test]
fn a_closed_surface_is_one_island_without_a_rim() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let tetrahedron = mesh(&corners, &faces);
    assert_eq!(tetrahedron.island_count(), 1);
    for triangle in living(&tetrahedron) {
        let around = tetrahedron.neighbours(triangle).map(Option::unwrap);
        let distinct = BTreeSet::from(around);
        assert_eq!(distinct.len(), 3, "{triangle}: {around:?}");
    }
    let base = tetrahedron.neighbours(TriangleId(0));
    assert_eq!(base, [3, 2, 1].map(|t| Some(TriangleId(t))));
}

#[test]
fn triangles_that_share_one_vertex_are_two_islands() {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, -Vec3::X, -Vec3::Y];
    let bow_tie = mesh(&positions, &[[0, 1, 2], [0, 3, 4]]);
    assert_eq!(bow_tie.island_count(), 2);
    assert_eq!(bow_tie.neighbours(TriangleId(0)), [None; 3]);
}

/// Three triangles that share an edge: two of opposite directions are neighbours, the third has none.
#[test]
fn the_third_triangle_at_an_edge_has_no_neighbour() {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, -Vec3::Y];
    let fins = mesh(&positions, &[[0, 1, 2], [0, 1, 3], [1, 0, 4]]);
    let across = |t| fins.neighbours(TriangleId(t))[0];
    assert_eq!(across(0), Some(TriangleId(2)));
    assert_eq!(across(2), Some(TriangleId(0)));
    assert_eq!(across(1), None);
    assert_eq!(fins.island_count(), 1);
}
