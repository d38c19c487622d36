//! Casts and sweeps: their promises on times, distances and normals, and limbs at any speed.

use std::sync::Arc;

use crate::SimdLevel;
use crate::geometry::{Affine, Capsule, Ray, Similarity, rotation_from_axis_angle};
use crate::measure::BruteForce;
use crate::mesh::{ColliderMesh, PartId, TriangleId};
use crate::rig::Palette;
use crate::surface::agreement::assert_queries_agree;
use crate::surface::{CastOptions, SkinnedSurface, SweepHit};
use crate::testing::{ball, bend, capsule, cases, rigid, tube};
use glam::{DQuat, DVec3, Vec3};

/// Tick rates, Hz.
const RATES: [f64; 3] = [30.0, 60.0, 120.0];

/// Speeds of the limb, metres a second.
const SPEEDS: [f64; 5] = [5.0, 20.0, 60.0, 100.0, 300.0];

/// A resting ball, far thinner than the distance that the limb moves in a tick.
const BALL: (Vec3, f32) = (Vec3::new(1.5, 0.0, 0.0), 0.1);

/// The first contact of a moving shape with the surface as it is now.
fn cast(surface: &SkinnedSurface, shape: &Capsule, motion: Vec3) -> Option<SweepHit> {
    let space = surface.in_model();
    space.cast_capsule(shape, [motion; 2], &CastOptions::STILL)
}

/// The first contact of a resting shape with the surface as it moves over the tick.
fn sweep(surface: &SkinnedSurface, shape: &Capsule) -> Option<SweepHit> {
    let space = surface.in_model();
    space.cast_capsule(shape, [Vec3::ZERO; 2], &CastOptions::MOVING)
}

/// Moves the tube as a limb along z, tick by tick, from below the ball to above it. Returns the limb's position on z
/// when a query first reports the ball.
fn passes(
    step: f64,
    mut report: impl FnMut(&SkinnedSurface) -> Option<SweepHit>,
    mut place: impl FnMut(&mut SkinnedSurface, f64, bool),
) -> Option<f64> {
    let mut surface = SkinnedSurface::new(tube(4, 12));
    // An odd start, so that no tick ends at the ball.
    let start = -3.0 - step * 0.37;
    place(&mut surface, start, true);
    let mut tick = 0.0;
    while start + tick * step < 3.0 {
        tick += 1.0;
        place(&mut surface, start + tick * step, false);
        if let Some(hit) = report(&surface) {
            assert!(!hit.undecided, "{hit:?}");
            return Some(start + (tick - 1.0 + hit.fraction) * step);
        }
    }
    None
}

#[test]
fn a_limb_at_any_speed_touches_a_resting_shape_at_the_right_time() {
    let by_joints = |surface: &mut SkinnedSurface, z: f64, first: bool| {
        let palette = rigid(4, DQuat::IDENTITY, DVec3::Z * z);
        step(surface, &palette, DVec3::ZERO, first);
    };
    let by_root = |surface: &mut SkinnedSurface, z: f64, first: bool| {
        let palette = rigid(4, DQuat::IDENTITY, DVec3::ZERO);
        step(surface, &palette, DVec3::Z * z, first);
    };
    for rate in RATES {
        for speed in SPEEDS {
            let case = format!("{speed} m/s at {rate} Hz");
            let (center, radius) = BALL;
            // The tube's flat side or edge is some 0.5 m from its axis, the ball 0.1 m thick.
            let expected = -0.6;
            let near = |z: Option<f64>| z.is_some_and(|z| (z - expected).abs() < 0.05);
            let stick = capsule(center - Vec3::Y * 0.2, center + Vec3::Y * 0.2, radius);
            for shape in [ball(center, radius), stick] {
                let touch = passes(speed / rate, |s| sweep(s, &shape), by_joints);
                assert!(near(touch), "{shape:?}, joints, {case}: {touch:?}");
            }
            // A point at rest in the world rests in the current model frame, wherever that frame is.
            let sphere = |s: &SkinnedSurface| {
                let in_model = s
                    .world_from_model()
                    .inverse_transform_point_f32(center.as_dvec3());
                sweep(s, &ball(in_model, radius))
            };
            let touch = passes(speed / rate, sphere, by_root);
            assert!(near(touch), "sphere, root, {case}: {touch:?}");
        }
    }
}

fn step(surface: &mut SkinnedSurface, palette: &Palette, root: DVec3, first: bool) {
    let world = Similarity::from_translation(root);
    if first {
        surface.teleport(palette, world).unwrap();
    } else {
        surface.advance(palette, world).unwrap();
    }
}

#[test]
fn a_swinging_limb_does_not_miss_a_sphere() {
    let sphere = ball(Vec3::X * 2.5, 0.05);
    let mut swings = 0;
    for rate in RATES {
        for speed in SPEEDS {
            // Vertices move straight: in a larger turn they would cut far inside the arc.
            let angle = speed / rate / 2.5;
            if angle > 0.7 {
                continue;
            }
            swings += 1;
            let mut surface = SkinnedSurface::new(tube(4, 12));
            let turned = |angle: f64| {
                let turn = rotation_from_axis_angle(DVec3::NEG_Y, angle);
                rigid(4, turn, DVec3::ZERO)
            };
            let mut at = -0.5 - angle * 0.3;
            step(&mut surface, &turned(at), DVec3::ZERO, true);
            let touched = loop {
                at += angle;
                step(&mut surface, &turned(at), DVec3::ZERO, false);
                let hit = sweep(&surface, &sphere);
                let plain = BruteForce::new(surface.in_model());
                let plain = plain.cast_capsule(&sphere, [Vec3::ZERO; 2], &CastOptions::MOVING);
                assert_eq!(hit, plain, "{speed} m/s at {rate} Hz");
                if hit.is_some() || at > 1.5 {
                    break hit.map(|hit| at - angle * (1.0 - hit.fraction));
                }
            };
            // The skin in front of the tube's middle has an angle of 0.2 to the ball.
            let near = touched.is_some_and(|at| (-0.3..-0.1).contains(&at));
            assert!(near, "{speed} m/s at {rate} Hz: {touched:?}");
        }
    }
    assert!(swings >= 10, "{swings}");
}

/// The tube at rest.
fn resting() -> SkinnedSurface {
    SkinnedSurface::new(tube(4, 64))
}

#[test]
fn a_hit_has_the_right_time_point_and_normals() {
    let surface = resting();
    let sphere = ball(Vec3::new(1.5, 3.0, 0.0), 0.25);
    let hit = cast(&surface, &sphere, Vec3::NEG_Y * 4.0).unwrap();
    // The ball touches at height 0.75 above the axis of the round tube.
    let early = (3.0 - 0.75) / 4.0 - hit.fraction;
    assert!((-1e-6..1e-3).contains(&early), "{hit:?}");
    assert!(
        hit.hit.point.distance(Vec3::new(1.5, 0.5, 0.0)) < 1e-3,
        "{hit:?}"
    );
    assert!(hit.separation_normal.distance(Vec3::Y) < 1e-3, "{hit:?}");
    assert!(hit.hit.normal.dot(Vec3::Y) > 0.99, "{hit:?}");
    let gap = hit.hit.distance - 0.25;
    assert!((0.0..=0.25 * 2.5e-4).contains(&gap), "{hit:?}");
    assert!(!hit.started_inside && !hit.undecided, "{hit:?}");
    let weights: f32 = hit.hit.barycentric.iter().sum();
    assert!((weights - 1.0).abs() < 1e-6, "{hit:?}");
    // From the inside, the contact normal points inwards and the skin's normal outwards.
    let inside = ball(Vec3::new(1.5, 0.0, 0.0), 0.25);
    let hit = cast(&surface, &inside, Vec3::Y).unwrap();
    assert!(hit.separation_normal.y < -0.99, "{hit:?}");
    assert!(hit.hit.normal.y > 0.99, "{hit:?}");
    // A ball that neither moves nor touches anything has no contact.
    assert_eq!(cast(&surface, &inside, Vec3::ZERO), None);
}

#[test]
fn an_initial_overlap_is_a_contact_at_time_0_with_the_nearest_triangle() {
    let surface = resting();
    let sphere = ball(Vec3::new(1.55, 0.6, 0.01), 0.25);
    let nearest = surface.in_model().closest_point(sphere.ends()[0], 1.0);
    let nearest = nearest.unwrap();
    for motion in [Vec3::ZERO, Vec3::Y * 5.0, Vec3::NEG_Y * 5.0] {
        let hit = cast(&surface, &sphere, motion).unwrap();
        assert!(hit.started_inside, "{hit:?}");
        assert_eq!(
            (hit.fraction, hit.hit.triangle),
            (0.0, nearest.triangle),
            "{hit:?}"
        );
        assert!(hit.separation_normal.y > 0.99, "{hit:?}");
    }
    // The capsule's segment itself crosses the skin: the skin's own normal.
    let stick = capsule(Vec3::new(1.5, -0.1, 0.0), Vec3::new(1.5, 1.0, 0.0), 0.01);
    let hit = cast(&surface, &stick, Vec3::X).unwrap();
    assert!(hit.started_inside && hit.hit.distance == 0.0, "{hit:?}");
    assert!(hit.separation_normal.y > 0.99, "{hit:?}");
}

#[test]
fn all_contacts_are_sorted_by_time_and_begin_with_the_first() {
    let surface = resting();
    let sphere = ball(Vec3::new(-2.0, 0.2, 0.1), 0.3);
    let stick = capsule(Vec3::new(-2.0, 0.2, 0.1), Vec3::new(-2.0, 1.2, 0.1), 0.1);
    let (mut hits, motion) = (Vec::new(), Vec3::X * 8.0);
    for shape in [sphere, stick] {
        let space = surface.in_model();
        space.cast_capsule_all(&shape, [motion; 2], &CastOptions::STILL, &mut hits);
        assert!(!shape.is_ball() || hits.len() > 100, "{}", hits.len());
        assert!(hits.is_sorted_by_key(|hit| hit.fraction), "{hits:?}");
        let first = cast(&surface, &shape, motion);
        assert_eq!(first, hits.first().copied(), "{shape:?}");
    }
}

#[test]
fn casts_pass_through_disabled_triangles_and_parts() {
    let mut surface = resting();
    let sphere = ball(Vec3::new(1.5, 3.0, 0.0), 0.25);
    let motion = Vec3::NEG_Y * 9.0;
    let mut before = 0.0;
    for _ in 0..400 {
        let Some(hit) = cast(&surface, &sphere, motion) else {
            return;
        };
        assert!(hit.fraction >= before, "{hit:?}");
        before = hit.fraction;
        surface.disable_triangle(hit.hit.triangle).unwrap();
        let plain = BruteForce::new(surface.in_model());
        let plain = plain.cast_capsule(&sphere, [motion; 2], &CastOptions::STILL);
        assert_eq!(cast(&surface, &sphere, motion), plain);
    }
    for part in 0..surface.mesh().parts().len() as u32 {
        surface.disable_part(PartId(part)).unwrap();
    }
    assert_eq!(cast(&surface, &sphere, motion), None);
}

#[test]
fn non_finite_or_negative_input_finds_nothing() {
    let surface = resting();
    let space = surface.in_model();
    let ball = ball(Vec3::ZERO, 1.0);
    let mut hits = vec![];
    let cast = |displacements: [Vec3; 2], options: CastOptions| {
        space.cast_capsule(&ball, displacements, &options)
    };
    assert!(cast([Vec3::X; 2], CastOptions::STILL).is_some());
    space.cast_capsule_all(&ball, [Vec3::X; 2], &CastOptions::STILL, &mut hits);
    assert!(!hits.is_empty());
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let place = Vec3::new(0.0, bad, 0.0);
        for displacements in [[place; 2], [Vec3::X, place], [place, Vec3::X]] {
            assert_eq!(cast(displacements, CastOptions::STILL), None);
            space.cast_capsule_all(&ball, displacements, &CastOptions::MOVING, &mut hits);
            assert_eq!(hits, []);
        }
        let fine = CastOptions::MOVING.with_tolerance(bad.into());
        assert_eq!(cast([Vec3::X; 2], fine), None);
    }
    let negative = CastOptions::STILL.with_tolerance(-1.0);
    assert_eq!(cast([Vec3::X; 2], negative), None);
    let ray = Ray::new(Vec3::Y * 3.0, Vec3::NEG_Y).unwrap();
    for bad in [f32::NAN, -1e-9] {
        assert_eq!(space.cast_ray(&ray, bad), None);
        assert!(!space.intersects_ray(&ray, bad));
        space.cast_ray_all(&ray, 10.0, &mut Vec::new());
        assert_eq!(space.closest_point(Vec3::ZERO, bad), None);
        assert_eq!(space.closest_to_capsule(&ball, bad), None);
    }
    for bad in [f32::NAN, f32::INFINITY] {
        assert_eq!(space.closest_point(Vec3::X * bad, 1.0), None);
        space.visit_box(Vec3::splat(-bad), Vec3::ONE, |_| panic!("{bad}"));
        space.visit_box(Vec3::NEG_ONE, Vec3::splat(bad), |_| panic!("{bad}"));
    }
}

/// A limb that bends, twists and turns, at every SIMD level, lazily and skinned ahead.
#[test]
fn sweeps_of_a_bent_tube_agree_at_every_level_lazily_and_ahead() {
    let mesh: Arc<ColliderMesh> = tube(12, 40);
    let mut found = 0;
    for level in SimdLevel::available() {
        let mut surface = SkinnedSurface::with_simd_level(mesh.clone(), level);
        let mut rng = fastrand::Rng::with_seed(72);
        for tick in 0..6 {
            let axis = DVec3::new(1.0, f64::from(tick), 0.3).normalize();
            let palette = bend(12, axis, 0.15 * f64::from(tick));
            let root = Similarity {
                rotation: rotation_from_axis_angle(DVec3::Z, 0.1 * f64::from(tick / 2)),
                ..Similarity::IDENTITY
            };
            surface.advance(&palette, root).unwrap();
            if tick % 2 == 0 {
                surface.skin_ahead();
            }
            found += assert_queries_agree(&surface, &mut rng, cases(5));
        }
    }
    assert!(found > cases(1_000), "{found}");
}

#[test]
fn a_mirrored_tube_keeps_outward_normals() {
    let mut surface = SkinnedSurface::new(tube(4, 32));
    let mut mirror = Affine::IDENTITY;
    mirror.rows[2][2] = -1.0;
    let palette = Palette::from_matrices([mirror; 4]);
    surface.teleport(&palette, Similarity::IDENTITY).unwrap();
    let sphere = ball(Vec3::new(1.5, 3.0, 0.0), 0.25);
    let hit = cast(&surface, &sphere, Vec3::NEG_Y * 4.0).unwrap();
    assert!(hit.hit.normal.y > 0.99, "{hit:?}");
    assert!(hit.hit.triangle < TriangleId(surface.mesh().triangles().len() as u32));
}
