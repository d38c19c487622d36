use std::sync::Barrier;

use glam::{DVec3, Vec3};

use super::Diagnostics;
use crate::geometry::Ray;
use crate::mesh::TriangleId;
use crate::surface::SkinnedSurface;
use crate::testing::{advance, ball, bend, cases, tube};

#[test]
fn each_triangle_is_in_one_cluster_whose_flags_match_the_diagnostics() {
    let mesh = tube(24, 48);
    let mut surface = SkinnedSurface::new(mesh.clone());
    let bent = bend(24, DVec3::Z, 0.05);
    advance(&mut surface, &bent);
    let idle = surface.clusters();
    assert_eq!(idle.filter(|c| c.touched || c.skinned).count(), 0);

    // A ray through the tube, from above its middle.
    let corner = mesh.triangles()[mesh.triangles().len() / 2][0];
    let middle = surface.in_model().position(corner);
    let above = middle.unwrap() + Vec3::Y * 100.0;
    let ray = Ray::new(above, Vec3::NEG_Y).unwrap();
    let hit = surface.in_model().cast_ray(&ray, 200.0).unwrap();
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

    advance(&mut surface, &bent);
    surface.skin_ahead();
    surface.in_model().cast_ray(&ray, 200.0);
    assert_eq!(counts(&surface), told(&surface), "skinned ahead");
    assert_eq!(told(&surface)[1], surface.diagnostics().clusters);
}

/// Diagnostics of ticks with eight equal queries on a number of threads: at the start of each tick, where clusters may
/// be skinned ahead, and after its queries.
fn ticks(threads: usize, count: u32) -> Vec<[Diagnostics; 2]> {
    /// Number of queries in a tick, shared among the threads.
    const QUERIES: usize = 8;
    let mut surface = SkinnedSurface::new(tube(24, 48));
    let tick = |tick: u32| {
        // The radius reaches from some of the skin to all of it: just below and just above the share for which the next
        // tick is skinned ahead.
        let radius = 6.0 + 18.0 * (tick % 50) as f32 / 50.0;
        advance(&mut surface, &bend(24, DVec3::Z, 1e-4 * f64::from(tick)));
        let ahead = surface.diagnostics();
        let sphere = ball(Vec3::ZERO, radius);
        let barrier = Barrier::new(threads);
        std::thread::scope(|scope| {
            for thread in 0..threads {
                let (surface, barrier) = (&surface, &barrier);
                scope.spawn(move || {
                    let mut hits = Vec::new();
                    barrier.wait();
                    for _ in (thread..QUERIES).step_by(threads) {
                        surface.in_model().overlap_capsule(&sphere, &mut hits);
                    }
                });
            }
        });
        [ahead, surface.diagnostics()]
    };
    (0..count).map(tick).collect()
}

#[test]
fn any_number_of_threads_skins_the_same_ticks_ahead() {
    let wanted = ticks(1, 100);
    let is_ahead = |[ahead, _]: &&[Diagnostics; 2]| ahead.clusters_skinned == ahead.clusters;
    let ahead = wanted.iter().filter(is_ahead).count();
    assert!(ahead > 15 && ahead < 50, "{ahead} of {}", wanted.len());
    for threads in [2, 8, 3, 4, 5, 6, 7].into_iter().take(cases(7)) {
        for (tick, (found, wanted)) in ticks(threads, 100).iter().zip(&wanted).enumerate() {
            assert_eq!(found, wanted, "{threads} threads, tick {tick}");
        }
    }
}

#[test]
fn lists_of_parts_take_no_memory_before_somebody_needs_them() {
    let mut surface = SkinnedSurface::new(tube(24, 48));
    let made = surface.mesh().memory();
    let ray = Ray::new(Vec3::Y * 100.0, Vec3::NEG_Y).unwrap();
    let hit = surface.in_model().cast_ray(&ray, 200.0).unwrap();
    let anchor = surface.anchor(hit.triangle, hit.barycentric).unwrap();
    surface.in_model().motion(&anchor, 0.1).unwrap();
    surface.disable_part(hit.part).unwrap();
    advance(&mut surface, &bend(24, DVec3::Z, 0.05));
    assert_eq!(surface.mesh().memory(), made);

    let lists = surface.mesh().parts().iter();
    let lists = lists.map(|p| 4 * (p.triangles.len() + p.vertices.len()));
    let lists = lists.sum::<usize>();
    assert_eq!(surface.mesh().memory(), made + lists);
}
