use std::collections::BTreeMap;

use super::*;
use crate::geometry::widen;
use crate::mesh::clusters::tests::meshes;
use crate::mesh::clusters::{Clusters, ROW, build};
use crate::mesh::summary::Summarizer;
use crate::mesh::weights::WEIGHT_ONE;
use crate::mesh::{ColliderMesh, VertexId};
use crate::testing::clusters_below;

fn vertices_below(hierarchy: &Hierarchy, clusters: &Clusters, child: Child) -> Vec<VertexId> {
    let below = clusters_below(hierarchy, child).into_iter();
    let slots = below.flat_map(|index| {
        let cluster = &clusters.clusters[index as usize];
        let first = cluster.first_row as usize * ROW;
        &clusters.vertices[first..][..usize::from(cluster.slots)]
    });
    slots.copied().collect()
}

fn for_each_lane(
    mut check: impl FnMut(&str, &ColliderMesh, &Node, usize, &[JointWeights], &[VertexId]),
) {
    for (name, mesh) in meshes() {
        let (clusters, hierarchy) = build(&mesh);
        for node in &hierarchy.nodes {
            let rows = &hierarchy.weights[node.first_joint as usize..][..node.joints as usize];
            for lane in 0..usize::from(node.lanes) {
                let vertices = vertices_below(&hierarchy, &clusters, node.child(lane));
                check(name, &mesh, node, lane, rows, &vertices);
            }
        }
    }
}

#[test]
fn every_cluster_is_once_below_the_root_and_parents_come_first() {
    for (name, mesh) in meshes() {
        let (clusters, hierarchy) = build(&mesh);
        let all: Vec<u32> = (0..clusters.clusters.len() as u32).collect();
        assert_eq!(clusters_below(&hierarchy, Child::Node(0)), all, "{name}");
        let mut parents = vec![0; hierarchy.nodes.len()];
        for (index, node) in hierarchy.nodes.iter().enumerate() {
            assert!(usize::from(node.lanes) <= LANES, "{name}");
            for lane in 0..usize::from(node.lanes) {
                if let Child::Node(child) = node.child(lane) {
                    assert!(child as usize > index, "{name}");
                    parents[child as usize] += 1;
                }
            }
        }
        assert!(parents[1..].iter().all(|count| *count == 1), "{name}");
        let lanes = usize::from(hierarchy.nodes[0].lanes);
        assert_eq!(lanes == 0, clusters.clusters.is_empty(), "{name}");
    }
}

/// [`Hierarchy::stack_needed`] by brute force: visits each child of a node in turn while its siblings wait.
fn stack_needed_below(hierarchy: &Hierarchy, child: Child) -> usize {
    let Child::Node(index) = child else {
        return 1;
    };
    let node = &hierarchy.nodes[index as usize];
    let lanes = usize::from(node.lanes);
    let below = (0..lanes).map(|lane| lanes - 1 + stack_needed_below(hierarchy, node.child(lane)));
    below.max().unwrap_or(1)
}

#[test]
fn a_traversal_needs_few_stack_entries() {
    for (name, mesh) in meshes() {
        let (clusters, hierarchy) = build(&mesh);
        let most = hierarchy.stack_needed();
        assert_eq!(
            most,
            stack_needed_below(&hierarchy, Child::Node(0)),
            "{name}"
        );
        let levels = clusters.clusters.len().max(1).ilog2() as usize + 2;
        assert!(most <= 7 * levels && most <= STACK, "{name}: {most}");
    }
}

#[test]
fn a_chain_of_nodes_needs_a_stack_entry_for_each_waiting_sibling() {
    let mut hierarchy = Hierarchy::default();
    for index in 0..60u32 {
        let mut node = Node::EMPTY;
        node.lanes = 3;
        node.set_child(0, Child::Cluster(0));
        node.set_child(1, Child::Node((index + 1).min(59)));
        node.set_child(2, Child::Cluster(1));
        if index == 59 {
            node.set_child(1, Child::Cluster(2));
        }
        hierarchy.nodes.push(node);
    }
    assert_eq!(hierarchy.stack_needed(), 60 * 2 + 1);
}

#[test]
fn lane_balls_hold_every_vertex_below() {
    for_each_lane(|name, mesh, node, lane, _, vertices| {
        let center = glam::Vec3::new(node.x[lane], node.y[lane], node.z[lane]);
        for vertex in vertices {
            let p = mesh.positions()[vertex.index()];
            let distance = (widen(p) - widen(center)).length();
            assert!(distance <= f64::from(node.radius[lane]), "{name}: {vertex}");
            assert!(
                widen(p).length() <= f64::from(node.reach[lane]),
                "{name}: {vertex}"
            );
        }
    });
}

#[test]
fn weight_middles_add_up_to_one_and_every_moving_joint_is_listed() {
    for_each_lane(|name, mesh, node, lane, rows, vertices| {
        let units = |weight: f32| {
            let units = weight * WEIGHT_ONE as f32;
            assert_eq!(units.fract(), 0.0, "{name}: {weight}");
            units as u32
        };
        let sum: u32 = rows.iter().map(|row| units(row.middle[lane])).sum();
        assert_eq!(sum, WEIGHT_ONE, "{name}");
        assert!(node.inflation[lane] > 0.0, "{name}");
        let moved = rows
            .iter()
            .filter(|row| row.middle[lane] + row.deviation[lane] > 0.0);
        let mut joints = BTreeMap::new();
        for vertex in vertices {
            for (joint, _) in mesh.influences(*vertex) {
                joints.insert(joint, ());
            }
        }
        assert_eq!(moved.count(), joints.len(), "{name}");
    });
}

#[test]
fn lanes_have_the_intervals_of_their_vertices() {
    for (name, mesh) in meshes() {
        let (clusters, hierarchy) = build(&mesh);
        for node in &hierarchy.nodes {
            let first = node.first_joint as usize;
            let joints = &hierarchy.joints[first..][..node.joints as usize];
            let rows = &hierarchy.weights[first..][..node.joints as usize];
            assert!(joints.windows(2).all(|w| w[0] < w[1]), "{name}: {joints:?}");
            for lane in 0..usize::from(node.lanes) {
                let mut vertices = vertices_below(&hierarchy, &clusters, node.child(lane));
                vertices.sort_unstable();
                vertices.dedup();
                let summary = Summarizer::new(&mesh).of_vertices(&vertices);
                let wanted = summary.intervals().into_iter();
                let wanted: BTreeMap<u32, (f32, f32)> =
                    wanted.map(|i| (i.joint, (i.middle, i.deviation))).collect();
                for (joint, row) in joints.iter().zip(rows) {
                    let found = (row.middle[lane], row.deviation[lane]);
                    let wanted = wanted.get(joint).copied().unwrap_or_default();
                    assert_eq!(found, wanted, "{name}: joint {joint}");
                }
                // Not much larger than the ball computed from the distinct vertices.
                let (found, near) = (node.radius[lane], summary.ball.radius);
                assert!(found <= near * 1.1, "{name}: {found} against {near}");
            }
            for lane in usize::from(node.lanes)..LANES {
                assert_eq!(
                    (node.radius[lane], node.inflation[lane]),
                    (0.0, 0.0),
                    "{name}"
                );
                assert!(rows.iter().all(|r| r.middle[lane] == 0.0), "{name}");
            }
        }
    }
}

#[test]
fn nodes_are_well_filled() {
    let (name, mesh) = &meshes()[1];
    let (clusters, hierarchy) = build(mesh);
    let lanes = clusters.clusters.len() + hierarchy.nodes.len() - 1;
    let mean = lanes as f64 / hierarchy.nodes.len() as f64;
    assert!(mean > 4.0, "{name}: {mean}");
}

#[test]
fn one_cluster_gives_a_root_with_one_child() {
    let (_, mesh) = meshes().swap_remove(7);
    let (clusters, hierarchy) = build(&mesh);
    assert_eq!(clusters.clusters.len(), 1);
    assert_eq!(hierarchy.nodes.len(), 1);
    assert_eq!(hierarchy.nodes[0].lanes, 1);
    assert_eq!(hierarchy.nodes[0].child(0), Child::Cluster(0));
}
