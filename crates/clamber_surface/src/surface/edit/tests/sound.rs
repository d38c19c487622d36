//! Invariants of clusters and hierarchy after any edits.

use std::collections::BTreeMap;

use crate::measure::skin_scalar;
use crate::mesh::hierarchy::Child;
use crate::mesh::{ColliderMesh, TriangleId, VertexId};
use crate::pose::PosedMesh;
use crate::surface::SkinnedSurface;
use crate::testing::{bits, clusters_below, positions_of};
use glam::{DVec3, Vec3};

/// Living clusters, each with how often the hierarchy leads to it.
fn reached(mesh: &ColliderMesh) -> BTreeMap<u32, usize> {
    let hierarchy = mesh.hierarchy();
    let mut found = BTreeMap::new();
    for root in [0].into_iter().chain(hierarchy.further_roots()) {
        for cluster in clusters_below(hierarchy, Child::Node(root)) {
            *found.entry(cluster).or_default() += 1;
        }
    }
    assert!(hierarchy.further_roots().count() <= mesh.parts().len());
    found.retain(|index, _| !mesh.clusters().clusters[*index as usize].is_dead());
    found
}

/// Asserts that every triangle is in one living cluster of its part, that every vertex has one owner or none, and that
/// the hierarchy leads to every living cluster once.
pub(super) fn assert_sound(mesh: &ColliderMesh, case: &str) {
    let clusters = mesh.clusters();
    let (mut holder, mut owner) = (BTreeMap::new(), BTreeMap::new());
    let mut living = BTreeMap::new();
    for (index, cluster) in (0..).zip(&clusters.clusters) {
        if cluster.is_dead() {
            assert_eq!((cluster.slots, cluster.owned), (0, 0), "{case}");
            continue;
        }
        living.insert(index, 1);
        for triangle in cluster.triangles(clusters) {
            assert_eq!(mesh.part_of(*triangle), Some(cluster.part), "{case}");
            let again = holder.insert(*triangle, index);
            assert_eq!(again, None, "{case}: triangle {triangle}");
        }
        for vertex in &cluster.vertices(clusters)[..usize::from(cluster.owned)] {
            let again = owner.insert(*vertex, index);
            assert_eq!(again, None, "{case}: vertex {vertex}");
        }
    }
    assert_eq!(clusters.living(), living.len(), "{case}");
    let dead = clusters.clusters.len() - living.len();
    assert!(dead <= living.len(), "{case}: {dead} of {}", living.len());
    assert_eq!(reached(mesh), living, "{case}");
    let all = (0..mesh.triangles().len() as u32).map(TriangleId);
    let held = all.filter(|t| mesh.part_of(*t).is_some());
    assert!(holder.keys().copied().eq(held), "{case}");
    let all = (0..mesh.positions().len() as u32).map(VertexId);
    let loose: Vec<_> = all.filter(|v| !owner.contains_key(v)).collect();
    assert_eq!(clusters.loose, loose, "{case}");
}

/// Asserts that the positions that both poses have cached, or compute now, equal plain skinning and lie within the
/// bounds above them.
pub(super) fn assert_poses_hold(surface: &SkinnedSurface, case: &str) {
    let mesh = surface.mesh();
    let all = bits(&positions_of(surface));
    let wanted = skin_scalar(mesh, surface.instance.current.palette()).unwrap();
    assert_eq!(all, bits(&wanted), "{case}: skin_all");
    for pose in [&surface.instance.current, &surface.instance.previous] {
        let skinned = skin_scalar(mesh, pose.palette()).unwrap();
        check_clusters(mesh, pose, &skinned, case);
        let root = pose.root();
        for p in &skinned {
            let inside = p.cmpge(root.min).all() && p.cmple(root.max).all();
            assert!(inside, "{case}: {p} outside {root:?}");
            let place = surface.world_from_model();
            let within = |(center, radius): (DVec3, f64)| {
                place.transform_point_f32(*p).distance(center) <= radius
            };
            let ball = surface.bounding_ball();
            assert!(ball.is_some_and(within), "{case}: {p} outside {ball:?}");
        }
    }
}

fn check_clusters(mesh: &ColliderMesh, pose: &PosedMesh, skinned: &[Vec3], case: &str) {
    let (hierarchy, clusters) = (mesh.hierarchy(), mesh.clusters());
    for index in 0..hierarchy.nodes.len() as u32 {
        let (node, bounds) = (&hierarchy.nodes[index as usize], pose.bounds(mesh, index));
        for lane in 0..usize::from(node.lanes) {
            let Child::Cluster(cluster) = node.child(lane) else {
                continue;
            };
            let entry = &clusters.clusters[cluster as usize];
            if entry.is_dead() {
                continue;
            }
            let positions = &pose.cluster(mesh, cluster).positions;
            for (slot, v) in entry.vertices(clusters).iter().enumerate() {
                let found = Vec3::from_array(positions.0.map(|axis| axis[slot]));
                assert_eq!(bits(&[found]), bits(&[skinned[v.index()]]), "{case}: {v}");
                assert!(bounds.holds(lane, found), "{case}: {v}");
            }
        }
    }
}
