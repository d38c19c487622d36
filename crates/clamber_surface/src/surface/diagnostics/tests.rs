use glam::Vec3;

use crate::geometry::{Ray, Similarity};
use crate::mesh::TriangleId;
use crate::surface::SkinnedSurface;
use crate::testing::{bend, tube};

#[test]
fn each_triangle_stands_in_one_cluster_which_says_what_was_made_of_it() {
    let mesh = tube(24, 48);
    let mut surface = SkinnedSurface::new(mesh.clone());
    let bent = bend(24, glam::DVec3::Z, 0.05);
    surface.advance(&bent, Similarity::IDENTITY).unwrap();
    let idle = surface.clusters();
    assert_eq!(idle.filter(|c| c.touched || c.skinned).count(), 0);

    // Through the tube from above its middle.
    let middle = surface.position(mesh.triangles()[mesh.triangles().len() / 2][0]);
    let above = middle.unwrap() + Vec3::Y * 100.0;
    let ray = Ray::new(above, Vec3::NEG_Y).unwrap();
    let hit = surface.cast_ray(&ray, 200.0).unwrap().unwrap();
    let mut triangles: Vec<TriangleId> = Vec::new();
    for cluster in surface.clusters() {
        let holds = cluster.triangles.contains(&hit.triangle);
        assert!(!holds || cluster.touched && cluster.skinned, "{cluster:?}");
        triangles.extend(cluster.triangles);
    }
    triangles.sort_unstable();
    let all: Vec<TriangleId> = (0..mesh.triangles().len() as u32).map(TriangleId).collect();
    assert_eq!(triangles, all);

    let counts = |surface: &SkinnedSurface| {
        let count = |counts: fn((bool, bool)) -> bool| {
            let flags = surface.clusters().map(|c| (c.touched, c.skinned));
            flags.filter(|flags| counts(*flags)).count()
        };
        [count(|(touched, _)| touched), count(|(_, skinned)| skinned)]
    };
    let told = |surface: &SkinnedSurface| {
        let told = surface.diagnostics();
        [told.clusters_touched, told.clusters_skinned]
    };
    assert_eq!(counts(&surface), told(&surface), "after a ray");
    assert!(told(&surface)[0] < surface.diagnostics().clusters / 2);

    surface.advance(&bent, Similarity::IDENTITY).unwrap();
    surface.skin_ahead();
    surface.cast_ray(&ray, 200.0).unwrap();
    assert_eq!(counts(&surface), told(&surface), "skinned ahead");
    assert_eq!(told(&surface)[1], surface.diagnostics().clusters);
}
