use super::*;
use crate::geometry::{Ray, rotation_from_axis_angle, widen};
use crate::measure::BruteForce;
use crate::mesh::{PaletteError, TriangleId, VertexId};
use crate::mesh::{PartId, SurfaceTag};
use crate::rig::JointId;
use crate::surface::agreement::assert_queries_agree;
use crate::testing::{advance, bend, positions_of, rigid, tube};
use glam::{DQuat, DVec3};

/// Number of joints of the tube.
const JOINTS: u32 = 6;

fn surface() -> SkinnedSurface {
    SkinnedSurface::new(tube(JOINTS, 12))
}

/// Asserts where the vertices were a tick ago.
fn assert_previous(surface: &SkinnedSurface, positions: &[Vec3], case: &str) {
    for (v, position) in (0..).map(VertexId).zip(positions) {
        let previous = surface.in_model().previous_position(v);
        assert_eq!(previous, Some(*position), "{case}: vertex {v}");
    }
}

#[test]
fn queries_agree_with_brute_force_in_every_pose() {
    let mut rng = fastrand::Rng::with_seed(21);
    let mut surface = surface();
    for angle in [0.0, 0.4, -1.2, 2.5] {
        let palette = bend(JOINTS, DVec3::new(0.0, 0.6, 0.8), angle);
        advance(&mut surface, &palette);
        let found = assert_queries_agree(&surface, &mut rng, 60);
        assert!(found > 1_000, "only {found} hits at angle {angle}");
    }
}

#[test]
fn no_bound_hides_its_outermost_vertices() {
    // Rays that pass just inside each vertex of a part, at right angles to its direction from the sphere's centre, and
    // points beyond the vertex.
    let mut surface = surface();
    advance(&mut surface, &bend(JOINTS, DVec3::new(0.6, 0.0, 0.8), 0.6));
    let brute_force = BruteForce::new(surface.in_model());
    let mut met = 0;
    for (part, sphere) in surface.in_model().part_spheres() {
        let part = &surface.mesh().parts()[part.index()];
        for v in &part.vertices {
            let vertex = brute_force.positions()[v.index()];
            let outward = vertex - sphere.center;
            let target = sphere.center + outward * 0.9999;
            let along = outward.any_orthonormal_vector();
            for ray in [
                Ray::new(target - along * 3.0, along).unwrap(),
                Ray::new(target + along * 3.0, -along).unwrap(),
            ] {
                let hit = surface.in_model().cast_ray(&ray, 6.0);
                assert_eq!(hit, brute_force.cast_ray(&ray, 6.0), "{ray:?}");
                met += usize::from(hit.is_some());
            }
            let beyond = vertex + outward.normalize();
            for reach in [1.0, 0.9999, 1.0001] {
                assert_eq!(
                    surface.in_model().closest_point(beyond, reach),
                    brute_force.closest_point(beyond, reach),
                );
            }
        }
    }
    assert!(met > 100, "only {met} rays met anything");
}

#[test]
fn queries_agree_with_brute_force_after_edits() {
    let mut rng = fastrand::Rng::with_seed(22);
    let mut surface = surface();
    let mut removed = Vec::new();
    for round in 0..60 {
        let count = surface.mesh().triangles().len() as u32;
        let triangle = TriangleId(rng.u32(0..count));
        match round % 6 {
            0 => drop(surface.disable_triangle(triangle)),
            1 => drop(surface.enable_triangle(triangle)),
            2 => {
                if surface.edit(|edit| edit.remove_triangle(triangle)).is_ok() {
                    removed.push(triangle);
                }
            }
            3 => {
                let corners = [0, 3, 17].map(|k| VertexId(k + rng.u32(0..200)));
                drop(surface.edit(|edit| edit.add_triangle(corners, SurfaceTag::default())));
            }
            4 => surface.disable_part(PartId(rng.u32(0..JOINTS))).unwrap(),
            _ => surface.enable_part(PartId(rng.u32(0..JOINTS))).unwrap(),
        }
        if round == 30 {
            advance(&mut surface, &bend(JOINTS, DVec3::Z, 0.5));
        }
        assert_queries_agree(&surface, &mut rng, 4);
    }
    assert!(!removed.is_empty());
    assert!(surface.mesh().triangles().len() > tube(JOINTS, 12).triangles().len());
    for triangle in removed {
        let refused = SurfaceError::Triangle(triangle);
        let anchor = surface.anchor(triangle, [1.0, 0.0, 0.0]);
        assert_eq!(anchor, Err(refused.clone()));
        assert!(surface.enable_triangle(triangle).is_err());
        let again = surface.edit(|edit| edit.remove_triangle(triangle));
        assert_eq!(again, Err(refused));
    }
}

#[test]
fn edits_of_one_surface_do_not_show_in_another() {
    let mut one = surface();
    let other = one.clone();
    one.edit(|edit| edit.remove_triangle(TriangleId(0)))
        .unwrap();
    assert_eq!(one.mesh().part_of(TriangleId(0)), None);
    assert!(other.mesh().part_of(TriangleId(0)).is_some());
}

#[test]
fn rays_pass_through_disabled_triangles_and_parts() {
    let mut surface = surface();
    let ray = Ray::new(Vec3::new(2.1, 5.0, 0.1), -Vec3::Y).unwrap();
    let front = surface.in_model().cast_ray(&ray, 100.0).unwrap();
    let off = (front.distance - 4.5).abs();
    assert!(front.normal.y > 0.9 && off < 0.05, "{front:?}");
    surface.disable_triangle(front.triangle).unwrap();
    let back = surface.in_model().cast_ray(&ray, 100.0).unwrap();
    assert!(back.normal.y < -0.9 && back.distance > 5.0, "{back:?}");
    surface.disable_part(back.part).unwrap();
    assert_eq!(surface.in_model().cast_ray(&ray, 100.0), None);
    surface.enable_part(back.part).unwrap();
    surface.enable_triangle(front.triangle).unwrap();
    assert_eq!(surface.in_model().cast_ray(&ray, 100.0), Some(front));
}

#[test]
fn previous_positions_are_those_of_the_last_tick_if_the_root_rests() {
    let mut surface = surface();
    let world = Similarity::from_translation(DVec3::new(1e5, 3.0, 0.0));
    let bent = |angle: f64| bend(JOINTS, DVec3::Z, angle);
    surface.teleport(&bent(0.1), world).unwrap();
    let before = positions_of(&surface);
    surface.advance(&bent(0.2), world).unwrap();
    assert_previous(&surface, &before, "far out");
    let none = surface.in_model().previous_position(VertexId(u32::MAX));
    assert_eq!(none, None);
}

#[test]
fn previous_positions_are_those_of_the_last_tick_over_many_ticks() {
    let mut surface = surface();
    for tick in 0..6 {
        let before = positions_of(&surface);
        let bent = bend(JOINTS, DVec3::Z, 0.1 * f64::from(tick + 1));
        advance(&mut surface, &bent);
        assert_previous(&surface, &before, &format!("tick {tick}"));
    }
}

#[test]
fn previous_positions_follow_a_moving_root_far_from_the_origin() {
    let mut surface = surface();
    let palette = bend(JOINTS, DVec3::Z, 0.1);
    let world = |angle: f64, x: f64| Similarity {
        rotation: rotation_from_axis_angle(DVec3::Y, angle),
        scale: 4.0,
        translation: DVec3::new(1e5 + x, 20.0, -7e4),
    };
    surface.teleport(&palette, world(0.3, 0.0)).unwrap();
    let vertices = (0..40).map(VertexId);
    let at = |v| {
        let position = surface.in_model().position(v).unwrap();
        surface.world_from_model().transform_point_f32(position)
    };
    let before: Vec<DVec3> = vertices.clone().map(at).collect();
    surface.advance(&palette, world(0.35, 0.8)).unwrap();
    for (v, before) in vertices.zip(before) {
        let previous = surface.in_model().previous_position(v).unwrap();
        let previous = surface.world_from_model().transform_point_f32(previous);
        // The error of coordinates of up to 25 m in f32, and of f64 at 1e5 m.
        let off = (previous - before).length();
        assert!(off < 2e-5, "vertex {v}: {previous} {before}");
    }
}

#[test]
fn place_leaves_no_motion() {
    let mut surface = surface();
    advance(&mut surface, &bend(JOINTS, DVec3::Z, 0.3));
    let far = Similarity::from_translation(DVec3::splat(1e4));
    surface
        .teleport(&bend(JOINTS, DVec3::Z, -0.3), far)
        .unwrap();
    assert_previous(&surface, &positions_of(&surface), "placed");
}

#[test]
fn a_sleeping_surface_answers_and_does_not_move() {
    let (mut surface, mut awake) = (surface(), surface());
    let bent = |angle: f64| bend(JOINTS, DVec3::Z, angle);
    let world = |x: f64| Similarity::from_translation(DVec3::new(x, 0.0, 0.0));
    for surface in [&mut surface, &mut awake] {
        surface.teleport(&bent(0.1), world(0.0)).unwrap();
        surface.advance(&bent(0.3), world(2.0)).unwrap();
    }
    assert_ne!(
        surface.in_model().previous_position(VertexId(0)),
        surface.in_model().position(VertexId(0))
    );
    surface.sleep();
    let positions = positions_of(&awake);
    assert_previous(&surface, &positions, "asleep");
    for (v, position) in (0..).map(VertexId).zip(positions) {
        assert_eq!(surface.in_model().position(v), Some(position));
    }
    let ray = Ray::new(Vec3::new(1.0, 4.0, 0.2), -Vec3::Y).unwrap();
    let hit = surface.in_model().cast_ray(&ray, 10.0);
    assert!(hit.is_some());
    assert_eq!(hit, awake.in_model().cast_ray(&ray, 10.0));
    // Placed far away: no motion.
    surface.teleport(&bent(0.9), world(50.0)).unwrap();
    let v = VertexId(3);
    assert_eq!(
        surface.in_model().previous_position(v),
        surface.in_model().position(v)
    );
}

#[test]
fn the_bounding_ball_holds_all_skin_over_the_tick() {
    let mut surface = surface();
    for tick in 0..8 {
        let world = Similarity::from_translation(DVec3::Y * f64::from(tick) * 0.3);
        let bent = bend(JOINTS, DVec3::Z, 0.2 * f64::from(tick));
        surface.advance(&bent, world).unwrap();
        let (center, radius) = surface.bounding_ball().unwrap();
        let place = *surface.world_from_model();
        let mut farthest = 0.0_f64;
        for v in (0..surface.mesh().positions().len() as u32).map(VertexId) {
            let space = surface.in_model();
            for at in [space.position(v), space.previous_position(v)] {
                let at = place.transform_point_f32(at.unwrap());
                farthest = farthest.max(at.distance(center));
            }
        }
        assert!(
            farthest <= radius && radius < 3.0 * farthest,
            "tick {tick}: {farthest} {radius}"
        );
    }
}

#[test]
fn a_creature_far_away_answers_like_one_at_the_origin() {
    let palette = bend(JOINTS, DVec3::Z, 0.7);
    let (mut near, mut far) = (surface(), surface());
    near.teleport(&palette, Similarity::IDENTITY).unwrap();
    far.teleport(&palette, Similarity::from_translation(DVec3::splat(1e5)))
        .unwrap();
    let ray = Ray::new(Vec3::new(1.0, 4.0, 0.2), -Vec3::Y).unwrap();
    let hit = near.in_model().cast_ray(&ray, 10.0);
    assert!(hit.is_some());
    assert_eq!(hit, far.in_model().cast_ray(&ray, 10.0));
}

#[test]
fn mirrored_joints_keep_outward_normals() {
    let mut surface = surface();
    let mut mirror = Affine::IDENTITY;
    mirror.rows[2][2] = -1.0;
    let palette = Palette::from_matrices((0..JOINTS).map(|_| mirror));
    advance(&mut surface, &palette);
    for origin in [Vec3::new(2.1, 5.0, 0.1), Vec3::new(2.1, 0.1, -5.0)] {
        let inward = Vec3::new(2.1, 0.05, 0.05) - origin;
        let ray = Ray::new(origin, inward).unwrap();
        let hit = surface.in_model().cast_ray(&ray, 100.0).unwrap();
        assert!(hit.normal.dot(inward) < 0.0, "{hit:?}");
    }
}

#[test]
fn bad_palettes_and_placements_change_nothing() {
    let mut surface = surface();
    let good = bend(JOINTS, DVec3::Z, 0.2);
    advance(&mut surface, &good);
    let before = positions_of(&surface);
    let refused = |surface: &mut SkinnedSurface, palette: &Palette, world: Similarity| {
        let by_advance = surface.advance(palette, world).unwrap_err();
        assert_eq!(surface.teleport(palette, world).unwrap_err(), by_advance);
        by_advance
    };
    let short = bend(JOINTS - 1, DVec3::Z, 0.2);
    let (expected, found) = (6, 5);
    assert_eq!(
        refused(&mut surface, &short, Similarity::IDENTITY),
        PaletteError::JointCount { expected, found }.into()
    );
    for bad in [f32::NAN, f32::INFINITY, 2e30] {
        let mut matrices = good.matrices().to_vec();
        matrices[3].rows[1][3] = bad;
        let palette = Palette::from_matrices(matrices);
        assert_eq!(
            refused(&mut surface, &palette, Similarity::IDENTITY),
            SurfaceError::Palette(PaletteError::Matrix(JointId(3))),
            "{bad}"
        );
    }
    let flat = refused(&mut surface, &good, Similarity::from_scale(0.0));
    assert_eq!(flat, SurfaceError::WorldFromModel);
    // A teleport by `advance` would need a displacement whose square overflows f32.
    let far = Similarity::from_translation(DVec3::splat(1e40));
    let found = surface.advance(&good, far);
    assert!(matches!(found, Err(SurfaceError::Palette(_))));
    assert_eq!(positions_of(&surface), before);
    assert_eq!(*surface.world_from_model(), Similarity::IDENTITY);
}

#[test]
fn a_rigid_move_moves_hits_rigidly() {
    let mut surface = surface();
    let ray = Ray::new(Vec3::new(1.3, 5.0, 0.2), -Vec3::Y).unwrap();
    let before = surface.in_model().cast_ray(&ray, 100.0).unwrap();
    let turn = rotation_from_axis_angle(DVec3::new(0.48, 0.6, 0.64), 1.9);
    let shift = DVec3::new(3.0, -1.0, 0.5);
    advance(&mut surface, &rigid(JOINTS, turn, shift));
    let carry = |v: Vec3, t: DVec3| crate::geometry::round_to_f32(turn * widen(v) + t);
    let direction = carry(ray.direction(), DVec3::ZERO);
    let moved = Ray::new(carry(ray.origin(), shift), direction).unwrap();
    let after = surface.in_model().cast_ray(&moved, 100.0).unwrap();
    assert_eq!(after.triangle, before.triangle);
    assert!((after.distance - before.distance).abs() < 1e-5);
    assert!((widen(after.normal) - turn * widen(before.normal)).length() < 1e-5);
    assert_ne!(turn, DQuat::IDENTITY);
}
