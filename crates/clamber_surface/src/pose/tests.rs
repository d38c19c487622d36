//! Checks that every vertex lies in every bound above it, on meshes as a build makes them.

use super::*;
use crate::bounds::tests::random::{JOINTS, MOTIONS, Spread, creature, palette};
use crate::measure::skin_scalar;
use crate::mesh::clusters::Cluster;
use crate::rig::Palette;
use crate::testing::{
    bend, clusters_below, direction, influence, point, separate, skinned_mesh, tube,
};
use glam::DVec3;

/// 700 triangles, each of nearby vertices that follow `influences` of [`JOINTS`] joints: enough for nodes above nodes.
fn many_clusters(rng: &mut fastrand::Rng, influences: usize) -> ColliderMesh {
    let size = [1e-3, 1.0, 1e3][rng.usize(0..3)];
    let offset = direction(rng) * [0.0, 1.0, 1e3][rng.usize(0..3)];
    let (mut positions, mut given) = (Vec::new(), Vec::new());
    for _ in 0..700 {
        let middle = point(rng, size) + offset;
        let first = rng.u32(0..JOINTS);
        for _ in 0..3 {
            positions.push(middle + point(rng, size * 0.1));
            let joints = (0..influences as u32).map(|k| (first + k) % JOINTS);
            given.extend(joints.map(|joint| influence(joint, rng.f32() + 1e-3)));
        }
    }
    skinned_mesh(&positions, &separate(700), &given, JOINTS as usize)
}

/// Asserts that every vertex lies in every bound above it. Returns the number of pairs.
fn check(mesh: &ColliderMesh, pose: &PosedMesh, case: &str) -> usize {
    let skinned = skin_scalar(mesh, pose.palette()).unwrap();
    let clusters = mesh.clusters();
    let vertices = |cluster: &Cluster| cluster.vertices(clusters).iter().map(|v| v.index());
    let mut checked = 0;
    for (index, node) in mesh.hierarchy().nodes.iter().enumerate() {
        let bounds = pose.bounds(mesh, index as u32);
        for lane in 0..usize::from(node.lanes) {
            for cluster in clusters_below(mesh.hierarchy(), node.child(lane)) {
                for v in vertices(&clusters.clusters[cluster as usize]) {
                    let p = skinned[v];
                    assert!(
                        bounds.holds(lane, p),
                        "{case}: node {index} {lane}: {p} {bounds:?}"
                    );
                    checked += 1;
                }
            }
        }
    }
    let root = pose.root();
    for p in &skinned {
        let inside = p.cmpge(root.min).all() && p.cmple(root.max).all();
        assert!(inside, "{case}: {p} outside {root:?}");
    }
    for (id, sphere) in pose.part_spheres(mesh) {
        for v in &mesh.parts()[id.index()].vertices {
            let p = skinned[v.index()];
            assert!(sphere.contains(p), "{case}: part {id}: {p}");
            checked += 1;
        }
    }
    checked + skinned.len()
}

/// [`check`] of the bounds from the palette, then of the bounds that were fitted to the skinned positions.
fn check_both(mesh: &ColliderMesh, pose: &mut PosedMesh, palette: &Palette, case: &str) -> usize {
    pose.set(mesh, palette.matrices().iter().copied());
    let lazily = check(mesh, pose, case);
    pose.set(mesh, palette.matrices().iter().copied());
    pose.fill(mesh);
    lazily + check(mesh, pose, &format!("{case}, refitted"))
}

fn hunt(seed: u64, cases: usize) -> usize {
    let mut rng = fastrand::Rng::with_seed(seed);
    let mut checked = 0;
    for case in 0..cases {
        let influences = 1 + case % 12;
        let mesh = if case % 4 == 0 {
            many_clusters(&mut rng, influences)
        } else {
            creature(&mut rng, influences, Spread::ALL[case / 12 % 5]).0
        };
        let mut pose = PosedMesh::at_rest(&mesh, SimdLevel::best());
        for motion in MOTIONS {
            let palette = palette(&mut rng, motion, mesh.radius());
            let case = format!("seed {seed}, case {case}, {motion:?}");
            checked += check_both(&mesh, &mut pose, &palette, &case);
        }
    }
    for joints in [3, 9, 30] {
        let mesh = tube(joints, 24);
        let mut pose = PosedMesh::at_rest(&mesh, SimdLevel::best());
        for step in 0..6 {
            let axis = DVec3::new(0.0, 0.6, 0.8);
            let palette = bend(joints, axis, f64::from(step) * 0.3 - 0.9);
            let case = format!("tube of {joints}, step {step}");
            checked += check_both(&mesh, &mut pose, &palette, &case);
        }
    }
    checked
}

#[test]
fn every_vertex_lies_in_every_bound_above_it() {
    let checked = hunt(101, 60);
    println!("{checked} checks");
    assert!(checked > 1_000_000, "{checked}");
}

#[test]
#[ignore = "takes minutes in release mode"]
fn every_vertex_lies_in_every_bound_above_it_in_a_long_search() {
    let checked: usize = (0..40).map(|k| hunt(1_000 + k, 600)).sum();
    println!("{checked} checks");
}

#[test]
fn requested_entries_stay_marked_when_everything_is_filled() {
    let mesh = tube(9, 24);
    let mut pose = PosedMesh::at_rest(&mesh, SimdLevel::best());
    for cluster in [3, 5] {
        pose.cluster(&mesh, cluster);
    }
    pose.bounds(&mesh, 0);
    pose.fill(&mesh);
    for _ in 0..2 {
        assert_eq!(pose.asked_clusters().collect::<Vec<_>>(), [3, 5]);
        assert_eq!(pose.asked_nodes().collect::<Vec<_>>(), [0]);
        assert_eq!(pose.asked_clusters().count(), 2);
        // Further requests do not count.
        for cluster in [3, 5] {
            pose.cluster(&mesh, cluster);
        }
    }
    let all = mesh.clusters().clusters.len();
    assert_eq!(pose.skinned_clusters().count(), all);
    pose.cluster(&mesh, 4);
    assert_eq!(pose.asked_clusters().count(), 3);
    pose.bounds(&mesh, 1);
    assert_eq!(pose.asked_nodes().collect::<Vec<_>>(), [0, 1]);
    // Another palette invalidates everything.
    pose.set(&mesh, pose.palette.clone().into_iter());
    assert_eq!(pose.asked_clusters().count(), 0);
    assert_eq!(pose.skinned_clusters().count(), 0);
    assert_eq!(pose.asked_nodes().count(), 0);
}
