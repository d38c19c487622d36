use clamber_surface::geometry::{Affine, Similarity, rotation_from_axis_angle};
use clamber_surface::mesh::TriangleId;
use clamber_surface::rig::Palette;
use clamber_surface::surface::{CastOptions, SkinnedSurface};
use glam::{DVec3, Vec3};

use crate::testing::{assert_near, cast, rest, rigid, sweep};
use crate::{MaterialPoint, Obstacle, WorldCapsule};

/// A level square of side 2 on one joint, placed 100 km from the origin, ten times as large, and turned by 90 degrees
/// about X: it is upright and faces +Z.
fn placed() -> (SkinnedSurface, Similarity) {
    let world_from_model = Similarity {
        rotation: rotation_from_axis_angle(DVec3::X, core::f64::consts::FRAC_PI_2),
        scale: 10.0,
        translation: DVec3::new(2e5, 30.0, -1e5),
    };
    let corners = [(-1., -1.), (-1., 1.), (1., 1.), (1., -1.)].map(|(x, z)| Vec3::new(x, 0., z));
    let mut surface = rigid(&corners, &[[0, 1, 2], [0, 2, 3]]);
    surface.teleport(&rest(), world_from_model).unwrap();
    (surface, world_from_model)
}

#[test]
fn queries_are_in_world_metres_wherever_the_creature_stands() {
    let (surface, world_from_model) = placed();
    let center = world_from_model.translation;
    let p = center + DVec3::new(1.0, 2.0, 4.0);
    let closest = surface.closest_point(p, 5.0).unwrap();
    assert!((closest.distance - 4.0).abs() < 1e-5, "{closest:?}");
    assert!((closest.normal - DVec3::Z).length() < 1e-6, "{closest:?}");
    assert!((closest.separation_normal(p) - DVec3::Z).length() < 1e-6);
    assert_eq!(surface.closest_point(p, 3.9), None);

    let hit = surface
        .cast_ray(p, DVec3::new(0.0, 0.0, -7.0), 100.0)
        .unwrap();
    assert!((hit.distance - 4.0).abs() < 1e-5);
    assert!((hit.point - (p - DVec3::Z * 4.0)).length() < 1e-5);
    assert_eq!(surface.cast_ray(p, DVec3::Z, 100.0), None);

    let mut contacts = vec![closest];
    surface.overlap_sphere(p, 5.0, &mut contacts);
    assert_eq!(contacts.len(), 3, "appends, and finds both triangles");
    assert!(contacts[1].material.key < contacts[2].material.key);
}

#[test]
fn a_material_point_moves_with_root_and_skin_in_world_units() {
    let (mut surface, before) = placed();
    let p = before.translation + DVec3::new(1.0, 2.0, 0.1);
    let material = surface.closest_point(p, 5.0).unwrap().material;
    let mut lifted = Affine::IDENTITY;
    lifted.rows[1][3] = 0.02;
    let turned = Similarity {
        rotation: rotation_from_axis_angle(DVec3::Y, 0.1) * before.rotation,
        translation: before.translation + DVec3::new(0.5, 0.0, 0.0),
        ..before
    };
    let dt = 0.1;
    let palette = Palette::from_matrices([lifted]);
    surface.advance(&palette, turned).unwrap();
    let motion = surface.motion(&material, dt).unwrap();

    let rest = before.inverse_transform_point(p - DVec3::Z * 0.1);
    let expected = turned.transform_point(rest + DVec3::Y * 0.02);
    assert!((motion.position - expected).length() < 1e-5, "{motion:?}");
    assert!((motion.previous_position - (p - DVec3::Z * 0.1)).length() < 1e-5);
    let velocity = (motion.position - motion.previous_position) / dt;
    assert!((motion.velocity - velocity).length() < 1e-3);
    let heading = motion.turn * DVec3::X;
    let expected = rotation_from_axis_angle(DVec3::Y, 0.1) * DVec3::X;
    assert!((heading - expected).length() < 1e-5, "{heading}");
    let frame = motion.frame.unwrap();
    assert!((frame * DVec3::Y - turned.rotation * DVec3::Y).length() < 1e-5);

    // An anchor at the point gives the same.
    let anchor = material.anchor_on(&surface).unwrap();
    let anchored = surface.in_world().motion(&anchor, dt).unwrap();
    assert_eq!(anchored.position, motion.position);
    assert_eq!(anchored.velocity, motion.velocity);
    let nowhere = MaterialPoint {
        key: 99,
        ..material
    };
    assert_eq!(nowhere.anchor_on(&surface), None);
}

#[test]
fn collapsed_material_has_no_frame() {
    let (mut surface, world_from_model) = placed();
    let material = surface.closest_point(world_from_model.translation, 1.0);
    let material = material.unwrap().material;
    let mut flat = Affine::IDENTITY;
    flat.rows[0][0] = 0.0;
    for _ in 0..2 {
        surface
            .advance(&Palette::from_matrices([flat]), world_from_model)
            .unwrap();
        let motion = surface.motion(&material, 0.1).unwrap();
        assert_eq!(motion.frame, None);
        assert!(motion.velocity.is_finite());
    }
}

#[test]
fn bad_input_and_removed_triangles_find_nothing() {
    let (mut surface, world_from_model) = placed();
    let center = world_from_model.translation;
    let mut contacts = Vec::new();
    for bad in [DVec3::NAN, DVec3::splat(f64::INFINITY)] {
        assert_eq!(surface.closest_point(bad, 1.0), None);
        assert_eq!(surface.cast_ray(bad, DVec3::X, 1.0), None);
        assert_eq!(surface.cast_ray(center, bad, 1.0), None);
        surface.overlap_sphere(bad, 1.0, &mut contacts);
    }
    assert_eq!(surface.cast_ray(center, DVec3::ZERO, 1.0), None);
    surface.overlap_sphere(center, f64::NAN, &mut contacts);
    surface.overlap_sphere(center, -1.0, &mut contacts);
    assert!(contacts.is_empty());

    let material = surface.closest_point(center, 1.0).unwrap().material;
    assert!(surface.motion(&material, 0.0).is_none());
    let triangle = TriangleId(material.key as u32);
    surface.disable_triangle(triangle).unwrap();
    assert!(surface.motion(&material, 0.1).is_none());
    surface.enable_triangle(triangle).unwrap();
    assert!(surface.motion(&material, 0.1).is_some());
    surface.edit(|edit| edit.remove_triangle(triangle)).unwrap();
    assert!(surface.motion(&material, 0.1).is_none());
}

#[test]
fn bounds_enclose_the_creature_over_the_tick_tightly() {
    let (mut surface, world_from_model) = placed();
    let moved = Similarity {
        translation: world_from_model.translation + DVec3::X * 40.0,
        ..world_from_model
    };
    surface.advance(&rest(), moved).unwrap();
    let (center, radius) = Obstacle::bounds(&surface).unwrap();
    // Each corner, before and now.
    for from in [&world_from_model, &moved] {
        for (x, z) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)] {
            let corner = from.transform_point(DVec3::new(x, 0.0, z));
            let apart = corner.distance(center);
            assert!(apart <= radius, "{corner}: {apart} of {radius}");
        }
    }
    // The bounds enclose the box around two balls of 14.2 m, one about the square at each place.
    assert!(radius < 40.0, "{radius}");
    surface.sleep();
    let (center, radius) = Obstacle::bounds(&surface).unwrap();
    assert!((center - moved.translation).length() < 1e-3, "{center}");
    assert!(radius < 24.7, "{radius}");
}

#[test]
fn capsule_queries_are_in_world_metres() {
    // The square is 20 m wide, upright, and faces +Z.
    let (mut surface, world_from_model) = placed();
    let center = world_from_model.translation;
    let at = |x: f64, z: f64| center + DVec3::new(x, 2.0, z);
    let ball = WorldCapsule::ball(at(1.0, 4.0), 1.0);
    let met = cast(&surface, &ball, DVec3::Z * -6.0).unwrap();
    assert!((met.fraction - 0.5).abs() < 2e-5, "{met:?}");
    assert_near(met.separation_normal, DVec3::Z, 1e-6, "separation");
    assert_near(met.contact.normal, DVec3::Z, 1e-6, "normal");
    assert_near(met.contact.point, at(1.0, 0.0), 1e-5, "point");
    assert!((met.contact.distance - 1.0).abs() < 1.1e-4, "{met:?}");
    assert!(!met.started_inside);
    assert_eq!(cast(&surface, &ball, DVec3::Z * -2.9), None);

    // A rod that leans towards the square, with its ends at 4 m and 2 m. The near end is 10 cm beyond the square's
    // edge.
    let rod = WorldCapsule {
        ends: [at(1.0, 4.0), at(10.1, 2.0)],
        radius: 0.5,
    };
    let mut contacts = Vec::new();
    surface.overlap_capsule(&rod.with_radius(2.01), &mut contacts);
    assert!(!contacts.is_empty());
    for contact in &contacts {
        let measured = (rod.nearest_on_axis(contact.point) - contact.point).length();
        assert!((contact.distance - measured).abs() < 1e-5, "{contact:?}");
    }
    let nearest = contacts.iter().map(|contact| contact.distance);
    let nearest = nearest.fold(f64::INFINITY, f64::min);
    // Along 9.1 m the rod's distance falls from 4 m to 2 m; over the edge it is 2.022 m, and measured aslant a little
    // less.
    assert!((1.98..2.01).contains(&nearest), "{contacts:?}");
    let met = cast(&surface, &rod, DVec3::Z * -3.0).unwrap();
    assert!((met.fraction - 0.5).abs() < 0.02, "{met:?}");

    // The square moves 2 m nearer over the tick.
    let moved = Similarity {
        translation: center + DVec3::Z * 2.0,
        ..world_from_model
    };
    surface.advance(&rest(), moved).unwrap();
    let met = sweep(&surface, &ball, DVec3::Z * -4.0).unwrap();
    assert!((met.fraction - 0.5).abs() < 3e-5, "{met:?}");
    assert_near(met.contact.point, at(1.0, 1.0), 2e-4, "point");
    let met = sweep(&surface, &ball, DVec3::ZERO);
    assert_eq!(met, None, "a metre is left");
    let inside = WorldCapsule::ball(at(1.0, 0.5), 1.0);
    let met = sweep(&surface, &inside, DVec3::ZERO).unwrap();
    assert!(met.started_inside && met.fraction == 0.0, "{met:?}");
    assert!((met.contact.distance - 0.5).abs() < 1e-5, "{met:?}");
}

#[test]
fn capsules_that_are_not_finite_meet_nothing() {
    let (surface, world_from_model) = placed();
    let center = world_from_model.translation;
    let good = WorldCapsule::ball(center, 1.0);
    assert!(cast(&surface, &good, DVec3::X).is_some());
    let mut contacts = Vec::new();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let place = WorldCapsule {
            ends: [center, center + DVec3::X * bad],
            radius: 1.0,
        };
        for capsule in [place, WorldCapsule::ball(place.ends[1], 1.0)] {
            assert_eq!(cast(&surface, &capsule, DVec3::X), None);
            assert_eq!(sweep(&surface, &capsule, DVec3::X), None);
            surface.overlap_capsule(&capsule, &mut contacts);
        }
        let by = DVec3::X * bad;
        assert_eq!(cast(&surface, &good, by), None, "{bad}");
        assert_eq!(sweep(&surface, &good, by), None, "{bad}");
        let endless = good.with_radius(bad);
        assert_eq!(cast(&surface, &endless, DVec3::X), None);
    }
    let negative = good.with_radius(-1.0);
    assert_eq!(cast(&surface, &negative, DVec3::X), None);
    surface.overlap_capsule(&negative, &mut contacts);
    assert!(contacts.is_empty(), "{contacts:?}");
}

#[test]
fn world_and_model_queries_agree() {
    let (mut surface, before) = placed();
    let turned = Similarity {
        rotation: rotation_from_axis_angle(DVec3::X, 0.3) * before.rotation,
        ..before
    };
    let mut bent = Affine::IDENTITY;
    bent.rows[0][1] = 0.2;
    surface
        .advance(&Palette::from_matrices([bent]), turned)
        .unwrap();
    let (world, model) = (surface.in_world(), surface.in_model());
    let scale = turned.scale;
    assert!((scale - 1.0).abs() > 0.1, "{scale}");
    let place = |p: Vec3| turned.transform_point_f32(p);
    let aim = |v: Vec3| turned.rotation * v.as_dvec3();
    let close = |a: DVec3, b: DVec3| assert!((a - b).length() < 1e-5 * scale, "{a} {b}");
    let above = Vec3::new(0.2, 2.0, 0.1);
    let displacement = Vec3::new(0.1, -3.0, 0.0);
    let (rod, radius) = ([above, above + Vec3::X], 0.25f32);
    let local = clamber_surface::geometry::Capsule::new(rod[0], rod[1], radius).unwrap();
    let capsule = WorldCapsule {
        ends: rod.map(place),
        radius: f64::from(radius) * scale,
    };

    let found = world.closest_to_capsule(&capsule, 5.0 * scale).unwrap();
    let expected = model.closest_to_capsule(&local, 5.0).unwrap();
    close(found.point, place(expected.point));
    assert!((found.distance - expected.distance * scale).abs() < 1e-5 * scale);
    assert!(world.closest_to_capsule(&capsule, 0.5 * scale).is_none());
    assert_eq!(world.is_inside(place(above)), model.is_inside(above));

    let mut hits = vec![found; 3];
    world.cast_ray_all(place(above), aim(Vec3::NEG_Y), 9.0 * scale, &mut hits);
    assert_eq!(hits.len(), 1, "cleared first");
    world.cast_ray_all(DVec3::NAN, DVec3::X, 9.0, &mut hits);
    assert!(hits.is_empty());

    // From above and from below; the larger tolerance is visible in the result.
    for (start, way) in [
        (above, displacement),
        (Vec3::new(0.2, -2.0, 0.1), -displacement),
    ] {
        let ball = clamber_surface::geometry::Capsule::ball(start, radius).unwrap();
        for tolerance in [1e-4, 0.1] {
            let options = CastOptions::STILL.with_tolerance(tolerance);
            let expected = model.cast_capsule(&ball, [way; 2], &options).unwrap();
            let options = options.with_tolerance(tolerance * scale);
            let ball = WorldCapsule::ball(place(start), f64::from(radius) * scale);
            let ways = [turned.transform_vector(way.as_dvec3()); 2];
            let found = world.cast_capsule(&ball, ways, &options).unwrap();
            assert!(
                (found.fraction - expected.fraction).abs() < 1e-5,
                "{found:?} {expected:?}"
            );
            close(found.hit.point, place(expected.hit.point));
            close(
                found.separation_normal * scale,
                aim(expected.separation_normal) * scale,
            );
            close(found.hit.normal * scale, aim(expected.hit.normal) * scale);
            // The skin's own normal is the same from either side; the separation normal points to where the ball comes
            // from.
            let sides = found.separation_normal.dot(found.hit.normal);
            assert!(
                sides * f64::from(start.y) * f64::from(expected.hit.normal.y) > 0.9,
                "{found:?}"
            );
        }
    }
    // Beside an edge, the separation normal differs from the skin's normal.
    let aside = Vec3::new(1.2, 1.0, 0.0);
    let ball = WorldCapsule::ball(place(aside), 0.5 * scale);
    let down = [turned.transform_vector(DVec3::NEG_Y * 2.0); 2];
    let found = world
        .cast_capsule(&ball, down, &CastOptions::STILL)
        .unwrap();
    assert!(
        found.separation_normal.dot(found.hit.normal) < 0.99,
        "{found:?}"
    );

    let anchor = surface.anchor_at(&found).unwrap();
    let (moved, expected) = (
        world.motion(&anchor, 0.1).unwrap(),
        model.motion(&anchor, 0.1).unwrap(),
    );
    close(moved.position, place(expected.position));
    close(moved.previous_position, place(expected.previous_position));
    close(moved.velocity, aim(expected.velocity) * scale);
    close(moved.angular_velocity, aim(expected.angular_velocity));
    close(moved.normal, aim(expected.normal));
    let heading = moved.frame * DVec3::Z;
    close(
        heading,
        turned.rotation * (expected.frame.as_dquat() * DVec3::Z),
    );
    assert_eq!(moved.collapsed, expected.collapsed);
    assert_eq!(
        (moved.area_ratio, moved.stretches),
        (expected.area_ratio, expected.stretches)
    );
    assert!(moved.angular_velocity.length() > 1.0 && moved.area_ratio > 0.5);
}
