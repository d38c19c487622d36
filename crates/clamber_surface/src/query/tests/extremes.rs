//! Numbers at the limits of f32: creatures, queries and distances.

use glam::Vec3;

use super::places::{Place, assert_agree, assert_overlaps_agree, overlaps};
use crate::geometry::{Affine, Capsule};
use crate::measure::BruteForce;
use crate::mesh::MeshSource;
use crate::rig::Palette;
use crate::surface::SkinnedSurface;
use crate::testing::{advance, ball, bend, built, capsule, direction, point, separate, tube};

/// Number of joints of the tube.
const JOINTS: u32 = 5;

/// 2^90: a thousandth of the largest coordinate, 2^100.
const HUGE: f32 = (1u128 << 90) as f32;

/// A bent tube, `scale` times as large.
fn scaled(scale: f32) -> SkinnedSurface {
    let mut surface = SkinnedSurface::new(tube(JOINTS, 40));
    let bent = bend(JOINTS, glam::DVec3::Z, 0.3);
    let matrices = bent.matrices().iter().map(|matrix| Affine {
        rows: matrix.rows.map(|row| row.map(|element| element * scale)),
    });
    advance(&mut surface, &Palette::from_matrices(matrices));
    surface
}

/// A triangle soup of one joint at rest.
fn soup(corners: &[[Vec3; 3]]) -> SkinnedSurface {
    let triangles = separate(corners.len() as u32);
    SkinnedSurface::new(built(&MeshSource::rigid(corners.as_flattened(), &triangles)).into())
}

fn any_place(rng: &mut fastrand::Rng, positions: &[Vec3], size: f32) -> Place {
    let near = positions[rng.usize(0..positions.len())];
    let away = [0.0, 1e-6, 0.3, 3.0, 1e3, 1e8][rng.usize(0..6)];
    let origin = near + point(rng, 1.0) * away * size;
    let target = positions[rng.usize(0..positions.len())];
    let axes = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z];
    let towards = match rng.u32(0..4) {
        0 => direction(rng) * size,
        1 => axes[rng.usize(0..6)] * size,
        2 => (target - origin).with_y(0.0),
        _ => target - origin,
    };
    let reach = [0.0, 1e-3, 0.5, 10.0, 1e9, f32::INFINITY][rng.usize(0..6)] * size;
    let reach = if reach.is_nan() { 0.0 } else { reach };
    Place {
        origin,
        towards,
        reach,
    }
}

#[test]
fn creatures_of_any_size_answer_like_brute_force_lazily_and_skinned_ahead() {
    let mut rng = fastrand::Rng::with_seed(83);
    for size in [
        1e-43, 1e-38, 1e-30, 1e-20, 1e-10, 1.0, 1e10, 1e18, 1e20, HUGE,
    ] {
        let mut surface = scaled(size);
        for ahead in [false, true] {
            if ahead {
                surface.skin_ahead();
            }
            let brute_force = BruteForce::new(surface.in_model());
            let positions = brute_force.positions();
            let mut found = 0;
            for _ in 0..150 {
                let place = any_place(&mut rng, positions, size);
                let case = format!("size {size}, ahead {ahead}");
                found += assert_agree(&surface, &brute_force, place, &case);
            }
            assert!(found > 1_000, "size {size}, ahead {ahead}: {found}");
        }
    }
}

#[test]
fn queries_from_anywhere_answer_like_brute_force() {
    let mut rng = fastrand::Rng::with_seed(84);
    let surface = scaled(1.0);
    let brute_force = BruteForce::new(surface.in_model());
    let positions = brute_force.positions();
    for exponent in 0..38 {
        let far = libm::powf(10.0, exponent as f32);
        for _ in 0..60 {
            let origin = direction(&mut rng) * far;
            let target = positions[rng.usize(0..positions.len())];
            let reach = [far * 0.999, far * 1.001, far * 2.0, f32::INFINITY, 1.0, 0.0];
            let place = Place {
                origin,
                // The far end of the capsule lies at, beyond or before the creature.
                towards: (target - origin) * [1.0, 2.0, 0.5][rng.usize(0..3)],
                reach: reach[rng.usize(0..6)],
            };
            assert_agree(&surface, &brute_force, place, &format!("1e{exponent}"));
        }
    }
}

#[test]
fn rays_along_axes_through_vertices_agree_with_brute_force() {
    let mut rng = fastrand::Rng::with_seed(85);
    let surface = SkinnedSurface::new(tube(JOINTS, 24));
    let brute_force = BruteForce::new(surface.in_model());
    let mut found = 0;
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        for sign in [1.0, -1.0] {
            for _ in 0..400 {
                let vertex = brute_force.positions()[rng.usize(0..brute_force.positions().len())];
                let back = [0.0, 0.5, 7.0][rng.usize(0..3)];
                let place = Place {
                    origin: vertex - axis * sign * back,
                    towards: axis * sign,
                    reach: [0.0, back, 1.0, f32::INFINITY][rng.usize(0..4)],
                };
                found += assert_agree(&surface, &brute_force, place, "axis");
            }
        }
    }
    assert!(found > 10_000, "{found}");
}

#[test]
fn a_capsule_whose_squared_length_overflows_still_overlaps_triangles() {
    let surface = scaled(1.0);
    let brute_force = BruteForce::new(surface.in_model());
    let mut rng = fastrand::Rng::with_seed(86);
    let mut found = 0;
    for size in [1e17, 1e18, 1e19, 3e19, 1e20, 1e25, 1e30, 3e38] {
        for _ in 0..40 {
            let along = [Vec3::X, direction(&mut rng)][rng.usize(0..2)] * size;
            let away = [0.0, 1.0, size * 1e-3][rng.usize(0..3)];
            let middle = point(&mut rng, 1.0) * away;
            let capsule = capsule(
                middle - along * [1.0, 0.01, 0.0][rng.usize(0..3)],
                middle + along * 0.5,
                [1.0, size * 1e-2, size * 2.0][rng.usize(0..3)].min(f32::MAX),
            );
            found += overlaps(&surface, &brute_force, &capsule, "long").len();
        }
    }
    assert!(found > 10_000, "{found}");
}

#[test]
fn a_capsule_that_nearly_touches_a_face_agrees_with_the_exact_test() {
    // The exact test takes a gap of 2^-48 of the lengths involved for a crossing.
    let mut touched = 0;
    for gap in [1e-30, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10] {
        for size in [1.0, 100.0, 1e6] {
            let surface = soup(&[[
                Vec3::new(gap, -size, -size),
                Vec3::new(gap, size, -size),
                Vec3::new(gap, 0.0, size),
            ]]);
            let brute_force = BruteForce::new(surface.in_model());
            for length in [1.0, 100.0, 1e6, 1e12] {
                let capsule = capsule(Vec3::new(-length, 0.0, 0.0), Vec3::ZERO, 0.0);
                let case = format!("gap {gap}, size {size}");
                touched += overlaps(&surface, &brute_force, &capsule, &case).len();
            }
        }
    }
    assert!(touched > 10, "{touched}");
}

#[test]
fn a_sphere_that_ends_at_a_face_agrees_with_the_exact_test() {
    // The face is beyond the sphere by less than f64 can resolve at that distance.
    let mut touched = 0;
    for gap in [1e-12, 1e-10, 1e-9, 4e-9, 1e-7] {
        for radius in [1e6, 1e7, 1e8] {
            let surface = soup(&[[
                Vec3::new(gap, -1.0, -1.0),
                Vec3::new(gap, 1.0, -1.0),
                Vec3::new(gap, 0.0, 1.0),
            ]]);
            let brute_force = BruteForce::new(surface.in_model());
            let sphere = ball(Vec3::new(-radius, 0.0, 0.0), radius);
            let case = format!("gap {gap}");
            touched += overlaps(&surface, &brute_force, &sphere, &case).len();
        }
    }
    assert!(touched > 5, "{touched}");
}

#[test]
fn the_nearest_vertex_does_not_narrow_the_search_below_rounding() {
    // If a vertex is the nearest point of all its triangles, their measured distance may be a little larger by
    // rounding, and a triangle beside them may be nearer than that.
    let mut rng = fastrand::Rng::with_seed(87);
    for case in 0..20_000 {
        let near = libm::powf(10.0, -14.0 + 4.0 * rng.f32());
        let long = [1.0, 1e3, 1e6][rng.usize(0..3)];
        let place = Vec3::new(near, 0.0, 0.0);
        let side = |rng: &mut fastrand::Rng| {
            Vec3::new(-1e-9 * rng.f32(), rng.f32() - 0.5, rng.f32() - 0.5)
        };
        let vertex = [
            place,
            place + side(&mut rng) * long,
            place + side(&mut rng) * long,
        ];
        let beside = Vec3::new(-near * (1.0 + rng.f32() * 3.0), 0.0, 0.0);
        let face = [
            Vec3::new(0.0, -1.0, -1.0),
            Vec3::new(0.0, 1.0, -1.0),
            Vec3::new(0.0, 0.0, 2.0),
        ];
        let surface = soup(&[vertex, face.map(|corner| corner * long + beside)]);
        let brute_force = BruteForce::new(surface.in_model());
        let place = Place {
            origin: point(&mut rng, near * 0.3).with_x(0.0),
            towards: Vec3::X,
            reach: f32::INFINITY,
        };
        assert_agree(&surface, &brute_force, place, &format!("case {case}"));
    }
}

#[test]
fn capsules_as_long_as_numbers_allow_overlap_what_brute_force_says() {
    let mut rng = fastrand::Rng::with_seed(85);
    let surface = scaled(1.0);
    let brute_force = BruteForce::new(surface.in_model());
    let mut some = 0;
    for case in 0..400 {
        let mut end = || direction(&mut rng) * [1.0, 1e12, 1e20, f32::MAX][case % 4];
        let ends = [end(), end()];
        let radius = [0.3, 5.0, 1e10, 1e30][case / 4 % 4];
        let capsule = Capsule::new(ends[0], ends[1], radius).unwrap();
        let found = assert_overlaps_agree(&surface, &brute_force, &capsule, "long");
        some += usize::from(found > 0 && found < surface.mesh().triangles().len());
    }
    assert!(some > 10, "{some}");
}
