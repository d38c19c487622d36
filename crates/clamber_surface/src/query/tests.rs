//! Lazy against eager skinning, bit for bit: any creature, any palette, any instruction set, any threads.

mod accuracy;
mod best;
mod extremes;
mod hidden;
mod inside;
mod nearest;
mod places;
mod spans;
mod sweeps;
mod watertight;

use std::sync::Arc;

use crate::SimdLevel;
use crate::bounds::tests::random::{MOTIONS, Spread, creature, palette};
use crate::geometry::{Affine, Ray};
use crate::measure::{BruteForce, skin_scalar};
use crate::mesh::{ColliderMesh, VertexId};
use crate::rig::Palette;
use crate::surface::SkinnedSurface;
use crate::surface::agreement::{assert_queries_agree, assert_same_answers, questions};
use crate::testing::{advance, ball, bend, bits, cases, positions_of, tube};
use glam::{DVec3, Vec3};

fn assert_positions_equal(surface: &SkinnedSurface, mesh: &ColliderMesh, case: &str) {
    let wanted = skin_scalar(mesh, surface.instance.current.palette()).unwrap();
    let before = skin_scalar(mesh, surface.instance.previous.palette()).unwrap();
    let all = positions_of(surface);
    assert!(bits(&all) == bits(&wanted), "{case}: skin_all");
    for (index, cluster) in mesh.clusters().clusters.iter().enumerate() {
        for (pose, wanted) in [
            (&surface.instance.current, &wanted),
            (&surface.instance.previous, &before),
        ] {
            // The first pass fills the cache, the second reads it.
            for _ in 0..2 {
                let positions = &pose.cluster(mesh, index as u32).positions;
                for (slot, v) in cluster.vertices(mesh.clusters()).iter().enumerate() {
                    let found = Vec3::from_array(positions.0.map(|axis| axis[slot]));
                    let wanted = wanted[v.index()];
                    assert_eq!(bits(&[found]), bits(&[wanted]), "{case}: {v}");
                }
            }
        }
    }
}

#[test]
fn queries_and_skinning_agree_in_any_pose_at_every_simd_level() {
    let mut rng = fastrand::Rng::with_seed(71);
    let mut found = 0;
    // Steps of 5 also go through all counts of joints and all spreads.
    for case in (0..120).step_by(120 / cases(120)) {
        let (mesh, _) = creature(&mut rng, 1 + case % 16, Spread::ALL[case / 16 % 5]);
        let mesh = Arc::new(mesh);
        let mut surfaces: Vec<SkinnedSurface> = SimdLevel::available()
            .into_iter()
            .map(|level| SkinnedSurface::with_simd_level(mesh.clone(), level))
            .collect();
        for motion in MOTIONS {
            let case = format!("case {case}, {motion:?}");
            let palette = palette(&mut rng, motion, mesh.radius());
            let before = rng.clone();
            for surface in &mut surfaces {
                rng = before.clone();
                advance(surface, &palette);
                found += assert_queries_agree(surface, &mut rng, 1);
                let case = format!("{case}, {}", surface.simd_level());
                assert_positions_equal(surface, &mesh, &case);
            }
        }
    }
    assert!(found > cases(100_000), "{found} hits");
}

/// The rounding error of numbers this small is not a share of their size.
#[test]
fn queries_agree_on_skin_that_is_smaller_than_normal_numbers() {
    let mut rng = fastrand::Rng::with_seed(70);
    let mut found = 0;
    for exponent in [38, 40, 41, 42, 43] {
        let scale = (0..exponent).fold(1.0, |scale: f32, _| scale * 0.1);
        let mut matrix = Affine::IDENTITY;
        for axis in 0..3 {
            matrix.rows[axis][axis] = scale;
        }
        let palette = Palette::from_matrices([matrix; 4]);
        for level in SimdLevel::available() {
            let mut surface = SkinnedSurface::with_simd_level(tube(4, 8), level);
            advance(&mut surface, &palette);
            found += assert_queries_agree(&surface, &mut rng, 5);
        }
    }
    assert!(found > 300, "{found} hits");
}

#[test]
fn concurrent_queries_find_the_same_as_one_thread() {
    let mut rng = fastrand::Rng::with_seed(72);
    let mut surface = SkinnedSurface::new(tube(12, 48));
    let mut found = 0;
    for tick in 0..20 {
        advance(&mut surface, &bend(12, DVec3::Z, f64::from(tick) * 0.05));
        let questions = questions(&surface, &mut rng, 1);
        // The clone is never skinned ahead, so it counts what the others count.
        let alone = surface.clone();
        let brute_force = BruteForce::new(alone.in_model());
        found += assert_same_answers(&alone, &brute_force, &questions);
        let diagnostics = alone.diagnostics();
        for threads in [1, 2, 8] {
            let fresh = surface.clone();
            std::thread::scope(|scope| {
                for _ in 0..threads {
                    scope.spawn(|| assert_same_answers(&fresh, &alone.in_model(), &questions));
                }
            });
            let touched = fresh.diagnostics();
            assert_eq!(touched.bounds_evaluated, diagnostics.bounds_evaluated);
            assert_eq!(touched.clusters_skinned, diagnostics.clusters_skinned);
            assert_eq!(touched.vertices_skinned, diagnostics.vertices_skinned);
            let tested = threads * diagnostics.triangles_tested;
            assert_eq!(touched.triangles_tested, tested);
        }
    }
    assert!(found > 1_000, "{found}");
}

#[test]
fn skinning_ahead_changes_no_result() {
    let mesh = tube(8, 24);
    let mut rng = fastrand::Rng::with_seed(73);
    let mut ahead = SkinnedSurface::new(mesh.clone());
    for tick in 0..10 {
        advance(&mut ahead, &bend(8, DVec3::Y, 0.2 * f64::from(tick)));
        ahead.skin_ahead();
        assert!(assert_queries_agree(&ahead, &mut rng, 5) > 100);
        assert_positions_equal(&ahead, &mesh, &format!("tick {tick}"));
        let (touched, all) = (ahead.diagnostics(), mesh.clusters().clusters.len());
        assert_eq!(touched.clusters_skinned, all);
    }
}

#[test]
fn only_a_tick_after_one_that_touched_everything_is_skinned_ahead() {
    let mesh = tube(8, 24);
    let mut surface = SkinnedSurface::new(mesh.clone());
    let everything = ball(Vec3::ZERO, f32::MAX);
    let mut hits = Vec::new();
    let mut tick = |touch: bool| {
        advance(&mut surface, &bend(8, DVec3::Y, 0.2));
        let ahead = surface.diagnostics().clusters_skinned;
        if touch {
            surface.in_model().overlap_capsule(&everything, &mut hits);
            assert_eq!(hits.len(), mesh.triangles().len());
        }
        ahead
    };
    let all = mesh.clusters().clusters.len();
    assert_eq!(
        [tick(true), tick(true), tick(false), tick(false)],
        [0, all, all, 0]
    );
}

#[test]
fn only_touched_clusters_are_skinned() {
    let mut surface = SkinnedSurface::new(tube(24, 48));
    advance(&mut surface, &bend(24, DVec3::Z, 0.05));
    assert_eq!(surface.diagnostics().clusters_skinned, 0);
    let far = Ray::new(Vec3::new(0.0, 900.0, 0.0), Vec3::X).unwrap();
    assert_eq!(surface.in_model().cast_ray(&far, 5.0), None);
    let nothing = surface.diagnostics();
    assert_eq!((nothing.bounds_evaluated, nothing.triangles_tested), (0, 0));
    let at = surface.in_model().position(VertexId(100)).unwrap();
    let near = surface.in_model().closest_point(at, 0.1);
    assert!(near.is_some());
    let touched = surface.diagnostics();
    assert!(touched.clusters_skinned >= 1);
    assert!(
        touched.vertices_skinned * 4 < touched.vertices,
        "{touched:?}"
    );
    assert!(touched.triangles_tested < 100, "{touched:?}");
    // The same query again touches nothing new.
    assert_eq!(surface.in_model().closest_point(at, 0.1), near);
    let again = surface.diagnostics();
    assert_eq!(again.bounds_evaluated, touched.bounds_evaluated);
    assert_eq!(again.clusters_skinned, touched.clusters_skinned);
}
