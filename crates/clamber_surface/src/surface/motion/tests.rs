use super::*;
use crate::geometry::{Affine, Ray, Similarity, rotation_from_axis_angle};
use crate::rig::Palette;
use crate::surface::SkinnedSurface;
use crate::surface::deformation::is_collapsed;
use crate::testing::{advance, bend, rigid, tube};

/// Number of joints of the tube.
const JOINTS: u32 = 5;

fn surface() -> SkinnedSurface {
    SkinnedSurface::new(tube(JOINTS, 12))
}

/// A point on top of the tube's middle.
fn anchor(surface: &SkinnedSurface) -> Anchor {
    let ray = Ray::new(Vec3::new(2.05, 5.0, 0.03), -Vec3::Y).unwrap();
    let hit = surface.in_model().cast_ray(&ray, 10.0).unwrap();
    surface.anchor_at(&hit).unwrap()
}

fn scaled(x: f32, y: f32, z: f32) -> Palette {
    let mut matrix = Affine::IDENTITY;
    matrix.rows[0][0] = x;
    matrix.rows[1][1] = y;
    matrix.rows[2][2] = z;
    Palette::from_matrices((0..JOINTS).map(|_| matrix))
}

fn frame(rest: [Vec3; 3], now: [Vec3; 3], joint: &Affine) -> Option<DQuat> {
    Rest::new(rest).frame(Flattened::new(now).as_ref(), joint)
}

fn stretched(before: [Vec3; 3], now: [Vec3; 3]) -> (f64, [f64; 2]) {
    let flat = [before, now].map(Flattened::new);
    stretch([before, now], [flat[0].as_ref(), flat[1].as_ref()])
}

#[test]
fn a_rigid_turn_gives_finite_displacement_and_exact_rotation() {
    let mut surface = surface();
    let anchor = anchor(&surface);
    let dt = 0.1;
    // A third of a turn in one tick: omega x r would be far off.
    let turn = rotation_from_axis_angle(DVec3::Z, 2.0);
    advance(&mut surface, &rigid(JOINTS, turn, DVec3::X));
    let motion = surface.in_model().motion(&anchor, dt).unwrap();
    let expected = turn * widen(motion.previous_position) + DVec3::X;
    assert!((widen(motion.position) - expected).length() < 1e-6);
    let velocity = (expected - widen(motion.previous_position)) / dt;
    assert!((widen(motion.velocity) - velocity).length() < 1e-4);
    assert!((widen(motion.angular_velocity) - DVec3::Z * 20.0).length() < 1e-3);
    let heading = rotation_f64(motion.frame) * DVec3::X;
    assert!((heading - turn * DVec3::X).length() < 1e-5, "{heading}");
    assert!((motion.area_ratio - 1.0).abs() < 1e-5);
}

#[test]
fn a_moving_root_moves_the_point_in_the_current_model_frame() {
    let mut surface = surface();
    let anchor = anchor(&surface);
    let turned = Similarity {
        rotation: rotation_from_axis_angle(DVec3::Y, 0.2),
        scale: 1.0,
        translation: DVec3::new(0.0, 0.5, 0.0),
    };
    let palette = bend(JOINTS, DVec3::Y, 0.0);
    let before = surface.in_model().motion(&anchor, 1.0).unwrap().position;
    surface.advance(&palette, turned).unwrap();
    let motion = surface.in_model().motion(&anchor, 1.0).unwrap();
    assert_eq!(motion.position, before);
    let previous_in_world = turned.transform_point_f32(motion.previous_position);
    assert!((previous_in_world - widen(before)).length() < 1e-6);
    let spin = turned.transform_vector(widen(motion.angular_velocity));
    assert!((spin - DVec3::Y * 0.2).length() < 1e-5, "{spin}");
}

#[test]
fn stretches_and_area_of_pure_scale() {
    let mut surface = surface();
    let anchor = anchor(&surface);
    advance(&mut surface, &scaled(2.0, 1.0, 1.5));
    let motion = surface.in_model().motion(&anchor, 1.0).unwrap();
    // The top of the tube lies nearly in the XZ plane.
    assert!((motion.stretches[0] - 2.0).abs() < 0.02, "{motion:?}");
    assert!((motion.stretches[1] - 1.5).abs() < 0.05, "{motion:?}");
    let product = motion.stretches[0] * motion.stretches[1];
    assert!((product - motion.area_ratio).abs() < 1e-4);
    // The facet's slope of 15 degrees in YZ falls to two thirds: a turn of 4.87 degrees.
    let turned = rotation_vector(rotation_f64(motion.frame)).length();
    assert!((turned - 0.085).abs() < 1e-3, "{turned}");
}

#[test]
fn shear_turns_the_frame_by_half_its_angle_only() {
    // A triangle in the XZ plane, sheared in its plane; the nearest rotation of [[1, s], [0, 1]] turns by atan(s / 2).
    let corners = [Vec3::ZERO, Vec3::Z, Vec3::X];
    for s in [0.01f32, 0.5, 3.0] {
        let sheared = [Vec3::ZERO, Vec3::Z, Vec3::X + Vec3::Z * s];
        let turned = rotation_vector(frame(corners, sheared, &Affine::IDENTITY).unwrap());
        // About the normal, Y, from X towards Z.
        let expected = DVec3::Y * -libm::atan(f64::from(s) / 2.0);
        assert!((turned - expected).length() < 1e-9, "{s}: {turned}");
        let (area, [large, small]) = stretched(corners, sheared);
        assert!((area - 1.0).abs() < 1e-9 && (large * small - 1.0).abs() < 1e-9);
        let exact = (1.0 + f64::from(s * s) / 4.0).sqrt() + f64::from(s) / 2.0;
        assert!((large - exact).abs() < 1e-6, "{s}: {large} {exact}");
    }
}

#[test]
fn a_collapsed_triangle_keeps_the_last_frame_and_stays_finite() {
    let mut surface = surface();
    let mut anchor = anchor(&surface);
    let turn = rotation_from_axis_angle(DVec3::X, 0.4);
    advance(&mut surface, &rigid(JOINTS, turn, DVec3::ZERO));
    let motion = surface.in_model().motion(&anchor, 0.1).unwrap();
    advance(&mut surface, &scaled(0.0, 0.0, 0.0));
    // Even an anchor whose frame was not updated has the frame of a tick ago.
    let kept = surface.in_model().motion(&anchor, 0.1).unwrap();
    assert_eq!(kept.frame, motion.frame);
    anchor.frame = motion.frame;
    for _ in 0..2 {
        let held = surface.in_model().motion(&anchor, 0.1).unwrap();
        assert_eq!(held.frame, motion.frame);
        assert!((held.normal - motion.normal).length() < 1e-3, "{held:?}");
        assert!(held.velocity.is_finite() && held.angular_velocity.is_finite());
        assert!(held.stretches.iter().all(|s| s.is_finite()) && held.area_ratio.is_finite());
        advance(&mut surface, &scaled(0.0, 0.0, 0.0));
    }
}

#[test]
fn a_triangle_flattened_to_a_line_far_out_counts_as_collapsed() {
    // Flattened to a line, then turned and moved: rounding of the corners gives it an area.
    let mut rng = fastrand::Rng::with_seed(9);
    let random = |rng: &mut fastrand::Rng| DVec3::new(rng.f64(), rng.f64(), rng.f64()) - 0.5;
    for case in 0..2_000 {
        let size = [0.01, 0.1, 3.0][case % 3];
        let turn = rotation_from_axis_angle(random(&mut rng).normalize(), rng.f64() * 6.0);
        let shift = random(&mut rng) * 20.0;
        let line = random(&mut rng).normalize();
        let flat = [0.0, rng.f64() * 0.6 + 0.2, 1.0].map(|t| {
            let p = turn * (line * (t * size)) + shift;
            Vec3::new(p.x as f32, p.y as f32, p.z as f32)
        });
        assert!(is_collapsed(flat), "case {case}: {flat:?}");
        let side = turn * line.any_orthonormal_vector() * size * 0.2;
        let tall = [flat[0], flat[1], flat[2] + round_to_f32(side)];
        assert!(!is_collapsed(tall), "case {case}: {tall:?}");
    }
}

#[test]
fn a_sliver_without_a_frame_at_rest_turns_with_its_joint() {
    let thin = [Vec3::ZERO, Vec3::X, Vec3::new(0.5, 1e-9, 0.0)];
    let turn = rotation_from_axis_angle(DVec3::new(0.0, 0.6, 0.8), 1.0);
    let joint = Affine::from_f64(&glam::DAffine3::from_quat(turn));
    let turned = thin.map(|p| joint.transform_point(p));
    let frame = frame(thin, turned, &joint).unwrap();
    assert!(rotation_vector(frame * turn.conjugate()).length() < 1e-6);
}

#[test]
fn an_anchor_follows_bending_skin_at_fixed_corner_weights() {
    let mut surface = surface();
    let anchor = anchor(&surface);
    for step in 0..100 {
        advance(
            &mut surface,
            &bend(JOINTS, DVec3::Z, f64::from(step) * 0.01),
        );
        let motion = surface.in_model().motion(&anchor, 1.0 / 60.0).unwrap();
        let corners = surface.instance.corners(anchor.triangle).map(widen);
        let shares = (0..3).map(|k| corners[k] * f64::from(anchor.barycentric[k]));
        let off = (shares.sum::<DVec3>() - widen(motion.position)).length();
        assert!(off < 1e-6, "step {step}: {off}");
        let on_skin = surface.in_model().closest_point(motion.position, 1.0);
        let off = on_skin.unwrap().distance;
        assert!(off < 1e-6, "step {step}: {off}");
    }
}

#[test]
fn bad_anchors_and_ticks_are_refused() {
    let surface = surface();
    let good = anchor(&surface);
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(surface.in_model().motion(&good, dt).is_err(), "{dt}");
    }
    let mut moved = surface.clone();
    advance(&mut moved, &bend(JOINTS, DVec3::Z, 0.1));
    assert!(moved.in_model().motion(&good, 1e-300).is_err());
    for barycentric in [[0.5, 0.6, 0.1], [f32::NAN, 0.5, 0.5], [-0.5, 1.0, 0.5]] {
        assert!(surface.anchor(good.triangle, barycentric).is_err());
        let bad = Anchor {
            barycentric,
            ..good
        };
        assert!(surface.in_model().motion(&bad, 1.0).is_err());
    }
    let nowhere = Anchor {
        triangle: crate::mesh::TriangleId(1 << 30),
        ..good
    };
    assert!(surface.in_model().motion(&nowhere, 1.0).is_err());
}

#[test]
fn stretches_of_a_collapsed_triangle_come_larger_first() {
    // Far out, where its corners are rounded so much that it has no frame.
    let at = |corners: [Vec3; 3], offset: f32| corners.map(|p| p + Vec3::X * offset);
    let before = [Vec3::ZERO, Vec3::X * 2.0, Vec3::Y * 0.5];
    let now = at([Vec3::ZERO, Vec3::X, Vec3::Y], 1e7);
    assert!(is_collapsed(now) && !is_collapsed(before));
    let (area, [larger, smaller]) = stretched(before, now);
    assert!((area - 1.0).abs() < 1e-6, "{area}");
    assert!(
        larger > 1.4 && smaller < 0.7 && smaller > 0.6,
        "{larger} {smaller}"
    );
}

#[test]
fn ratios_beyond_f32_are_clamped_to_its_largest_number() {
    let mut surface = surface();
    let anchor = anchor(&surface);
    for size in [1e-20, 1e20] {
        advance(&mut surface, &scaled(size, size, size));
    }
    let motion = surface.in_model().motion(&anchor, 1.0).unwrap();
    assert_eq!(motion.area_ratio, f32::MAX);
    assert_eq!(motion.stretches, [f32::MAX; 2]);
}

#[test]
fn a_path_has_the_bits_of_the_motion() {
    let mut surface = surface();
    let anchor = anchor(&surface);
    for step in 1..50 {
        let palette = bend(JOINTS, DVec3::Z, f64::from(step) * 0.02);
        let place = Similarity::from_translation(DVec3::splat(f64::from(step)));
        surface.advance(&palette, place).unwrap();
        let dt = 1.0 / f64::from(step);
        let motion = surface.in_model().motion(&anchor, dt).unwrap();
        let path = surface.in_model().path(&anchor, dt).unwrap();
        let wanted = (motion.position, motion.previous_position, motion.velocity);
        let found = (path.position, path.previous_position, path.velocity);
        assert_eq!(found, wanted, "step {step}");
        let motion = surface.in_world().motion(&anchor, dt).unwrap();
        let path = surface.in_world().path(&anchor, dt).unwrap();
        let wanted = (motion.position, motion.previous_position, motion.velocity);
        let found = (path.position, path.previous_position, path.velocity);
        assert_eq!(found, wanted, "in the world, step {step}");
    }
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let path = surface.in_model().path(&anchor, dt);
        assert!(matches!(path, Err(SurfaceError::Tick(_))), "{dt}");
    }
    let short = surface.in_model().path(&anchor, 1e-300);
    assert!(
        matches!(short, Err(SurfaceError::ShortTick(_))),
        "{short:?}"
    );
}
