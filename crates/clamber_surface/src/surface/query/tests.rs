//! Lazy against eager, bit for bit: any creature, any palette, any instruction set, any threads.

mod accuracy;
mod best;
mod extremes;
mod hidden;
mod inside;
mod nearest;
mod places;
mod sweeps;
mod watertight;

use std::sync::Arc;

use super::SurfaceHit;
use crate::SimdLevel;
use crate::geometry::{Affine, Ray, Similarity, Sphere};
use crate::mesh::{BuildOptions, ColliderMesh, Influence, MeshSource, VertexId};
use crate::rig::{JointId, Palette};
use crate::skin::skin_scalar;
use crate::surface::SkinnedSurface;
use crate::surface::agreement::{answers, assert_queries_agree};
use crate::surface::bounds::tests::random::{MOTIONS, Spread, creature, palette};
use crate::testing::{direction, point};
use glam::Vec3;

fn assert_positions_equal(surface: &SkinnedSurface, mesh: &ColliderMesh, case: &str) {
    let wanted = skin_scalar(mesh, surface.current.palette()).unwrap();
    let before = skin_scalar(mesh, surface.previous.palette()).unwrap();
    let mut all = Vec::new();
    surface.skin_all(&mut all);
    assert!(same_bits(&all, &wanted), "{case}: skin_all");
    for (index, cluster) in mesh.clusters().clusters.iter().enumerate() {
        for (pose, wanted) in [(&surface.current, &wanted), (&surface.previous, &before)] {
            let mut positions = crate::skin::ClusterPositions::ZERO;
            // Filled by the first, read from the cache by the second.
            for _ in 0..2 {
                pose.positions(mesh, index as u32, &mut positions);
                for (slot, v) in cluster.vertices(mesh.clusters()).iter().enumerate() {
                    let found = Vec3::from_array(positions.0.map(|axis| axis[slot]));
                    assert!(same_bits(&[found], &[wanted[v.index()]]), "{case}: {v}");
                }
            }
        }
    }
}

fn same_bits(a: &[Vec3], b: &[Vec3]) -> bool {
    let bits = |p: &Vec3| p.to_array().map(f32::to_bits);
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| bits(a) == bits(b))
}

#[test]
fn any_creature_in_any_pose_at_every_simd_level() {
    let mut rng = fastrand::Rng::with_seed(71);
    let spreads = [
        Spread::Random,
        Spread::NearlyEqual,
        Spread::Uneven,
        Spread::Few,
        Spread::Constant,
    ];
    let mut found = 0;
    for case in 0..120 {
        let (mesh, _) = creature(&mut rng, 1 + case % 16, spreads[case / 16 % 5]);
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
                surface.advance(&palette, Similarity::IDENTITY).unwrap();
                found += assert_queries_agree(surface, &mut rng, 2);
                let case = format!("{case}, {}", surface.simd_level());
                assert_positions_equal(surface, &mesh, &case);
            }
        }
    }
    assert!(found > 100_000, "{found} hits");
}

#[test]
fn threads_that_query_at_once_find_what_one_finds() {
    let mesh = crate::testing::tube(12, 48);
    let mut rng = fastrand::Rng::with_seed(72);
    let mut surface = SkinnedSurface::new(mesh);
    for tick in 0..20 {
        let angle = f64::from(tick) * 0.05;
        let bent = crate::testing::bend(12, glam::DVec3::Z, angle);
        let places: Vec<(Vec3, Vec3, f32)> = (0..64)
            .map(|_| {
                let place = Vec3::new(5.0, 1.0, 0.0) + point(&mut rng, 6.0);
                (place, direction(&mut rng) * 3.0, rng.f32() * 2.0)
            })
            .collect();
        let ask = |surface: &SkinnedSurface| -> Vec<Vec<SurfaceHit>> {
            let each = places.iter();
            each.map(|(place, towards, reach)| answers(surface, *place, *towards, *reach))
                .collect()
        };
        surface.advance(&bent, Similarity::IDENTITY).unwrap();
        // Never skinned ahead, so that it counts what the others count.
        let alone = surface.clone();
        let wanted = ask(&alone);
        let diagnostics = alone.diagnostics();
        for threads in [1, 2, 8] {
            let fresh = surface.clone();
            std::thread::scope(|scope| {
                let handles: Vec<_> = (0..threads).map(|_| scope.spawn(|| ask(&fresh))).collect();
                for handle in handles {
                    assert!(
                        handle.join().unwrap() == wanted,
                        "{threads} threads, tick {tick}"
                    );
                }
            });
            let touched = fresh.diagnostics();
            assert_eq!(touched.bounds_evaluated, diagnostics.bounds_evaluated);
            assert_eq!(touched.clusters_skinned, diagnostics.clusters_skinned);
            assert_eq!(touched.vertices_skinned, diagnostics.vertices_skinned);
            assert_eq!(
                touched.triangles_tested,
                threads * diagnostics.triangles_tested
            );
        }
    }
}

#[test]
fn skinning_ahead_changes_no_answer() {
    let mesh = crate::testing::tube(8, 24);
    let mut rng = fastrand::Rng::with_seed(73);
    let mut ahead = SkinnedSurface::new(mesh.clone());
    for tick in 0..10 {
        let bent = crate::testing::bend(8, glam::DVec3::Y, 0.2 * f64::from(tick));
        ahead.advance(&bent, Similarity::IDENTITY).unwrap();
        ahead.skin_ahead();
        assert!(assert_queries_agree(&ahead, &mut rng, 30) > 100);
        assert_positions_equal(&ahead, &mesh, &format!("tick {tick}"));
        let (touched, all) = (ahead.diagnostics(), mesh.clusters().clusters.len());
        assert_eq!(touched.clusters_skinned, all);
    }
}

#[test]
fn a_tick_after_one_that_touched_everything_is_skinned_ahead_and_one_after_rest_is_not() {
    let mesh = crate::testing::tube(8, 24);
    let mut surface = SkinnedSurface::new(mesh.clone());
    let bent = crate::testing::bend(8, glam::DVec3::Y, 0.2);
    let everything = Sphere {
        center: Vec3::ZERO,
        radius: f32::INFINITY,
    };
    let mut hits = Vec::new();
    let mut tick = |touch: bool| {
        surface.advance(&bent, Similarity::IDENTITY).unwrap();
        let ahead = surface.diagnostics().clusters_skinned;
        if touch {
            surface.overlap_sphere(&everything, &mut hits).unwrap();
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
fn only_what_is_touched_is_skinned() {
    let mesh = crate::testing::tube(24, 48);
    let mut surface = SkinnedSurface::new(mesh.clone());
    let bent = crate::testing::bend(24, glam::DVec3::Z, 0.05);
    surface.advance(&bent, Similarity::IDENTITY).unwrap();
    assert_eq!(surface.diagnostics().clusters_skinned, 0);
    let far = Ray::new(Vec3::new(0.0, 900.0, 0.0), Vec3::X).unwrap();
    assert_eq!(surface.cast_ray(&far, 5.0).unwrap(), None);
    let nothing = surface.diagnostics();
    assert_eq!((nothing.bounds_evaluated, nothing.triangles_tested), (0, 0));
    let at = surface.position(VertexId(100)).unwrap();
    let near = surface.closest_point(at, 0.1).unwrap();
    assert!(near.is_some());
    let touched = surface.diagnostics();
    assert!(touched.clusters_skinned >= 1);
    assert!(
        touched.vertices_skinned * 4 < touched.vertices,
        "{touched:?}"
    );
    assert!(touched.triangles_tested < 100, "{touched:?}");
    // The same again touches nothing new.
    assert_eq!(surface.closest_point(at, 0.1).unwrap(), near);
    let again = surface.diagnostics();
    assert_eq!(again.bounds_evaluated, touched.bounds_evaluated);
    assert_eq!(again.clusters_skinned, touched.clusters_skinned);
}

/// Small triangles anywhere in a cube, no two with a vertex in common, each on three joints in shares
/// of its own.
fn soup(rng: &mut fastrand::Rng, triangles: u32) -> ColliderMesh {
    let positions: Vec<Vec3> = (0..triangles)
        .flat_map(|_| {
            let middle = point(rng, 2.0);
            [0, 1, 2].map(|_| middle + point(rng, 0.2))
        })
        .collect();
    let corners: Vec<[u32; 3]> = (0..triangles)
        .map(|t| [0, 1, 2].map(|k| 3 * t + k))
        .collect();
    let influences: Vec<Influence> = (0..triangles)
        .flat_map(|_| {
            let shares = [0, 1, 2].map(|joint| Influence {
                joint: JointId(joint),
                weight: rng.f32(),
            });
            [shares; 3].into_iter().flatten()
        })
        .collect();
    let source = MeshSource {
        positions: &positions,
        triangles: &corners,
        influences: &influences,
        joint_count: 3,
        ..MeshSource::default()
    };
    ColliderMesh::build(&source, &BuildOptions::default())
        .unwrap()
        .0
}

#[test]
fn a_mesh_tuned_to_poses_answers_as_before() {
    let mut rng = fastrand::Rng::with_seed(74);
    let mesh = Arc::new(soup(&mut rng, 1_000));
    // One joint moves all that it moves far away, the others do not move at all.
    let mut away = Affine::IDENTITY;
    away.rows[0][3] = 20.0;
    let still = [Affine::IDENTITY; 2];
    let poses = [0.5, 1.0].map(|share| {
        away.rows[0][3] *= share;
        Palette::from_matrices(still.into_iter().chain([away]))
    });
    let tuned = Arc::new(mesh.tuned(&poses).unwrap());
    let (mut one, mut other) = (
        SkinnedSurface::new(mesh.clone()),
        SkinnedSurface::new(tuned),
    );
    let mut touched = [0; 2];
    for pose in &poses {
        one.advance(pose, Similarity::IDENTITY).unwrap();
        other.advance(pose, Similarity::IDENTITY).unwrap();
        for _ in 0..40 {
            let towards = direction(&mut rng);
            let place = Vec3::X * 10.0 * rng.f32() + point(&mut rng, 3.0);
            let reach = 0.5;
            one.place(pose, Similarity::IDENTITY).unwrap();
            other.place(pose, Similarity::IDENTITY).unwrap();
            let wanted = answers(&one, place, towards, reach);
            assert_eq!(answers(&other, place, towards, reach), wanted);
            touched[0] += one.diagnostics().clusters_touched;
            touched[1] += other.diagnostics().clusters_touched;
        }
        assert!(assert_queries_agree(&other, &mut rng, 20) > 100);
    }
    assert!(touched[1] < touched[0], "{touched:?}");
    assert!(
        mesh.tuned(&[crate::testing::bend(11, glam::DVec3::Y, 0.0)])
            .is_err()
    );
}
