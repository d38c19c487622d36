use super::*;
use crate::SimdLevel;
use crate::measure::{skin_clusters, skin_scalar};
use crate::mesh::{ColliderMesh, MeshSource};
use crate::surface::SkinnedSurface;
use crate::testing::{bend, bits, built, tube};
use glam::{DVec3, Vec3};

#[test]
fn the_fast_kernel_has_the_bits_of_the_plain_one_at_every_level() {
    // The largest is shared among threads with the feature `rayon`.
    for mesh in [tube(2, 3), tube(6, 24), tube(60, 96)] {
        let joints = mesh.joint_count() as u32;
        let palette = bend(joints, DVec3::new(0.0, 0.6, 0.8), 0.1);
        let wanted = bits(&skin_scalar(&mesh, palette.matrices()).unwrap());
        for level in SimdLevel::available() {
            let mut positions = vec![Vec3::ONE; 7];
            skin_checked(&mesh, palette.matrices(), level, &mut positions);
            assert!(bits(&positions) == wanted, "{level}");
        }
        assert!(bits(&skin(&mesh, palette.matrices()).unwrap()) == wanted);
    }
}

#[test]
fn skin_clusters_writes_one_cluster_after_the_other() {
    let mesh = tube(6, 24);
    let palette = bend(6, DVec3::Z, 0.3);
    let wanted = skin_scalar(&mesh, palette.matrices()).unwrap();
    let mut numbers = Vec::new();
    skin_clusters(&mesh, palette.matrices(), SimdLevel::best(), &mut numbers).unwrap();
    let clusters = mesh.clusters();
    let mut rest = &numbers[..];
    for cluster in &clusters.clusters {
        let slots = cluster.rows() * crate::mesh::clusters::ROW;
        for (slot, vertex) in cluster.vertices(clusters).iter().enumerate() {
            let found = [0, 1, 2].map(|axis| rest[axis * slots + slot]);
            assert_eq!(Vec3::from_array(found), wanted[vertex.index()], "{vertex}");
        }
        rest = &rest[3 * slots..];
    }
    assert!(rest.is_empty());
}

#[test]
fn vertices_without_triangles_are_skinned_as_well() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(3.0, 4.0, 5.0)];
    let mesh = built(&MeshSource::rigid(&corners, &[[0, 1, 2]]));
    let palette = bend(1, DVec3::Z, 0.0);
    assert_eq!(skin(&mesh, palette.matrices()).unwrap(), corners);
    assert!(skin_clusters(&mesh, &[], SimdLevel::best(), &mut Vec::new()).is_err());
    assert!(skin_into(&mesh, &[], &mut Vec::new()).is_err());
    assert!(skin_scalar(&mesh, &[]).is_err());
}

#[test]
fn skinning_a_mesh_does_not_change_what_it_equals() {
    // Large enough to be shared among threads with the feature `rayon`.
    let mesh = tube(60, 96);
    let untouched = ColliderMesh::clone(&mesh);
    let palette = bend(60, DVec3::Z, 0.1);
    skin(&mesh, palette.matrices()).unwrap();
    assert!(*mesh == untouched, "after `skin`");
    let surface = SkinnedSurface::new(mesh.clone());
    surface.skin_all(&mut Vec::new());
    assert!(**surface.mesh() == untouched, "after `skin_all`");
    // The comparison leaves out only the cache.
    assert!(*tube(60, 95) != untouched);
}
