//! Overlaps, casts and sweeps of capsules.

use clamber_surface::geometry::rotation_from_axis_angle;
use rapier3d::parry::shape::HalfSpace;

use super::*;

/// Bodies that move from the first pose to the second over a tick.
struct Moving {
    world: PhysicsWorld,
    before: BodyPoses,
}

impl Moving {
    fn new(bodies: impl IntoIterator<Item = (ColliderBuilder, [Pose; 2])>) -> Self {
        let mut world = PhysicsWorld::default();
        let bodies = bodies.into_iter().map(|(collider, [from, to])| {
            let body = RigidBodyBuilder::kinematic_position_based().pose(from);
            (world.insert(body, collider).0, to)
        });
        let bodies: Vec<_> = bodies.collect();
        world.step();
        let mut before = BodyPoses::new();
        before.record(&world.bodies);
        for (body, to) in bodies {
            world.bodies[body].set_next_kinematic_position(to);
        }
        world.step();
        Self { world, before }
    }

    fn terrain(&self) -> RapierTerrain<'_> {
        RapierTerrain::of_world(&self.world, &self.before)
    }
}

fn slide(from: [f32; 3], to: [f32; 3]) -> [Pose; 2] {
    [from, to].map(|at| Pose::from_translation(Vector::from(at)))
}

#[test]
fn falling_ball_meets_every_kind_of_shape() {
    let plane = SharedShape::new(HalfSpace::new(Vector::Y));
    let corners = vec![
        Vector::Y,
        Vector::NEG_X,
        Vector::X,
        Vector::Z,
        Vector::NEG_Z,
    ];
    let line = vec![Vector::new(-1.0, 1.0, 0.0), Vector::new(1.0, 1.0, 0.0)];
    let part = (
        Pose::from_translation(Vector::Y * 0.5),
        SharedShape::ball(0.5),
    );
    let shapes = [
        ("ball", ColliderBuilder::ball(1.0)),
        ("cuboid", ColliderBuilder::cuboid(1.0, 1.0, 1.0)),
        (
            "round cuboid",
            ColliderBuilder::round_cuboid(0.8, 0.8, 0.8, 0.2),
        ),
        ("capsule", ColliderBuilder::capsule_y(0.5, 0.5)),
        ("cylinder", ColliderBuilder::cylinder(1.0, 1.0)),
        ("cone", ColliderBuilder::cone(1.0, 1.0)),
        ("hull", ColliderBuilder::convex_hull(&corners).unwrap()),
        ("compound", ColliderBuilder::compound(vec![part])),
        ("line", ColliderBuilder::polyline(line, None)),
        (
            "voxels",
            ColliderBuilder::voxels(Vector::splat(0.5), &[IVector::new(0, 1, 0)])
                .translation(Vector::new(-0.25, 0.0, -0.25)),
        ),
        ("plane", ColliderBuilder::new(plane).translation(Vector::Y)),
    ];
    for (name, collider) in shapes.into_iter().chain(grounds()) {
        let world = world_of(collider);
        let terrain = RapierTerrain::of_world(&world, &NO_POSES);
        let ball = WorldCapsule::ball(DVec3::Y * 3.0, 0.5);
        let by = DVec3::NEG_Y * 4.0;
        let met = cast(&terrain, &ball, by).unwrap();
        assert_eq!(Some(met), sweep(&terrain, &ball, by), "{name}");
        assert!((met.fraction - 0.375).abs() < 3e-5, "{name}: {met:?}");
        assert_near(met.separation_normal, DVec3::Y, 1e-6, name);
        let off = (met.contact.distance - 0.5).abs();
        assert!(off < 1e-4, "{name}: {met:?}");
        assert_near(met.contact.point, DVec3::Y, 2e-4, name);
        assert!(!met.started_inside, "{name}");
        for by in [DVec3::NEG_Y, DVec3::Y * 9.0] {
            assert_eq!(cast(&terrain, &ball, by), None, "{name}, {by}");
        }
        let motion = terrain.motion(&met.contact.material, 0.1).unwrap();
        assert_near(motion.position, met.contact.point, 1e-6, name);
        let mut contacts = Vec::new();
        terrain.overlap_capsule(&ball.with_radius(2.1), &mut contacts);
        let nearest = contacts.iter().map(|contact| contact.distance);
        let nearest = nearest.fold(f64::INFINITY, f64::min);
        assert!((nearest - 2.0).abs() < 1e-6, "{name}: {contacts:?}");
    }
}

#[test]
fn a_wall_at_thirty_metres_a_second_hits_a_resting_capsule() {
    // The wall moves half a metre in 1/60 s and is 10 cm thick. The capsule is at rest.
    let wall = || ColliderBuilder::cuboid(0.05, 3.0, 3.0);
    let moving = Moving::new([(wall(), slide([-1.0, 0.0, 0.0], [-0.5, 0.0, 0.0]))]);
    let at = |x: f64| WorldCapsule {
        ends: [DVec3::new(x, 0.0, 0.0), DVec3::new(x, 1.0, 0.0)],
        radius: 0.3,
    };
    // The wall's face moves from -0.95 to -0.45.
    let terrain = moving.terrain();
    let met = sweep(&terrain, &at(-0.4), DVec3::ZERO).unwrap();
    assert!((met.fraction - 0.5).abs() < 2e-4, "{met:?}");
    assert!(!met.started_inside && (met.separation_normal - DVec3::X).length() < 1e-6);
    assert!((met.contact.point.x + 0.7).abs() < 1e-4, "{met:?}");
    let dt = 1.0 / 60.0;
    let motion = terrain.motion(&met.contact.material, dt).unwrap();
    assert_near(motion.velocity, DVec3::X * 30.0, 1e-3, "velocity");
    // A capsule that moves with the wall is never reached; one that moves against it is reached sooner.
    assert_eq!(sweep(&terrain, &at(-0.4), DVec3::X * 0.5), None);
    let against = sweep(&terrain, &at(-0.4), DVec3::X * -0.5).unwrap();
    assert!((against.fraction - 0.25).abs() < 2e-4, "{against:?}");
    // The wall does not reach a capsule farther ahead. A cast sees the wall where it stands now.
    assert_eq!(sweep(&terrain, &at(0.0), DVec3::ZERO), None);
    let now = cast(&terrain, &at(-0.4), DVec3::ZERO).unwrap();
    assert!(now.started_inside);
}

#[test]
fn sweeps_and_casts_agree_on_a_resting_body_whatever_its_colliders_offset() {
    let mut rng = fastrand::Rng::with_seed(72);
    for _ in 0..200 {
        let mut vector =
            |size: f32| Vector::new(rng.f32() - 0.5, rng.f32() - 0.5, rng.f32() - 0.5) * size;
        let turned = rotation_from_axis_angle(vector(1.0).as_dvec3().normalize(), 2.0);
        let place = Pose::from_parts(vector(9.0), turned.as_quat());
        let collider = ColliderBuilder::cuboid(0.5, 0.4, 0.3)
            .translation(vector(3.0))
            .rotation(vector(3.0));
        let moving = Moving::new([(collider, [place, place])]);
        let terrain = moving.terrain();
        assert!(terrain.moved().moved.is_empty());
        let middle = moving.world.colliders.iter().next().unwrap().1;
        let middle = middle.position().translation.as_dvec3();
        let ball = WorldCapsule::ball(middle + vector(4.0).as_dvec3(), 0.2);
        let by = middle - ball.ends[0];
        let swept = sweep(&terrain, &ball, by).unwrap();
        assert_eq!(cast(&terrain, &ball, by), Some(swept));
        let motion = terrain.motion(&swept.contact.material, 0.1).unwrap();
        assert_eq!(motion.velocity, DVec3::ZERO);
    }
}

#[test]
fn a_thin_plate_at_a_hundred_metres_a_second_hits_a_resting_ball() {
    // 1 mm thick, 1.67 m a tick: far beyond its current bounding box.
    let plate = ColliderBuilder::cuboid(0.0005, 1.0, 1.0);
    let moving = Moving::new([(plate, slide([-0.8, 0.0, 0.0], [0.8667, 0.0, 0.0]))]);
    for radius in [0.0, 0.001, 0.2] {
        let ball = WorldCapsule::ball(DVec3::new(0.1, 0.3, -0.2), radius);
        let met = sweep(&moving.terrain(), &ball, DVec3::ZERO).unwrap();
        let expected = (0.9 - radius - 0.0005) / 1.6667;
        assert!((met.fraction - expected).abs() < 1e-4, "{radius}: {met:?}");
        assert_near(met.separation_normal, DVec3::X, 1e-6, radius);
        assert_eq!(cast(&moving.terrain(), &ball, DVec3::ZERO), None);
    }
    let aside = WorldCapsule::ball(DVec3::new(0.1, 1.3, 0.0), 0.29);
    assert_eq!(sweep(&moving.terrain(), &aside, DVec3::ZERO), None);
}

#[test]
fn a_turning_bar_hits_a_resting_ball() {
    // The bar reaches 4 m each way and turns by a sixth of a turn about Y. The ball is where the bar neither was nor
    // is.
    let angle = core::f64::consts::FRAC_PI_3;
    let turned = rotation_from_axis_angle(DVec3::Y, angle).as_quat();
    let poses = [Pose::IDENTITY, Pose::from_parts(Vector::ZERO, turned)];
    let moving = Moving::new([(ColliderBuilder::cuboid(4.0, 0.2, 0.1), poses)]);
    let at = |share: f64, radius: f64| {
        let (sin, cos) = (libm::sin(angle * share), libm::cos(angle * share));
        WorldCapsule::ball(DVec3::new(2.0 * cos, 0.0, -2.0 * sin), radius)
    };
    for share in [0.25, 0.5, 0.75] {
        let ball = at(share, 0.1);
        let met = sweep(&moving.terrain(), &ball, DVec3::ZERO).unwrap();
        // The bar's near side arrives about 0.2 m before its middle, on a path of about 2.1 m. Points move in straight
        // lines, up to 2 (1 - cos(30 degrees)) = 0.27 m off the arc.
        let expected = share - 0.2 / 2.1;
        assert!((met.fraction - expected).abs() < 0.06, "{share}: {met:?}");
        assert!(met.contact.distance <= 0.1001, "{met:?}");
        let mut contacts = Vec::new();
        moving.terrain().overlap_capsule(&ball, &mut contacts);
        assert!(contacts.is_empty(), "{contacts:?}");
    }
    let beyond = sweep(&moving.terrain(), &at(1.5, 0.1), DVec3::ZERO);
    assert_eq!(beyond, None);
}

#[test]
fn an_overlap_at_the_start_is_a_hit_at_time_zero_with_the_minimum_translation() {
    let moving = Moving::new([(
        ColliderBuilder::cuboid(1.0, 1.0, 1.0),
        slide([0.0, 0.0, 0.0], [5.0, 0.0, 0.0]),
    )]);
    let rod = WorldCapsule {
        ends: [DVec3::new(0.0, 0.8, 0.0), DVec3::new(0.0, 2.0, 0.0)],
        radius: 0.1,
    };
    let terrain = moving.terrain();
    let met = sweep(&terrain, &rod, DVec3::ZERO).unwrap();
    assert!(met.started_inside && met.fraction == 0.0, "{met:?}");
    // The contact is with the box at its previous position.
    assert!((met.contact.distance + 0.2).abs() < 1e-6, "{met:?}");
    assert_near(met.separation_normal, DVec3::Y, 1e-9, "separation");
    assert_near(met.contact.point, DVec3::Y, 1e-6, "point");
    let now = rod.moved(DVec3::X * 5.0);
    let still = cast(&terrain, &now, DVec3::ZERO).unwrap();
    assert!(still.started_inside);
    assert_eq!(cast(&terrain, &rod, DVec3::ZERO), None);
    let mut contacts = Vec::new();
    terrain.overlap_capsule(&now, &mut contacts);
    assert_eq!(contacts.len(), 1);
    assert!((contacts[0].distance + 0.2).abs() < 1e-6, "{contacts:?}");
    assert_near(contacts[0].normal, DVec3::Y, 1e-9, "normal");
}

#[test]
fn input_that_is_not_finite_meets_nothing() {
    let world = world_of(ColliderBuilder::cuboid(1.0, 1.0, 1.0));
    let terrain = RapierTerrain::of_world(&world, &NO_POSES);
    let good = WorldCapsule::ball(DVec3::Y * 3.0, 0.5);
    let by = DVec3::NEG_Y * 4.0;
    let meets = |capsule: &WorldCapsule, by: DVec3| {
        let mut contacts = Vec::new();
        terrain.overlap_capsule(capsule, &mut contacts);
        let overlaps = !contacts.is_empty();
        let swept = sweep(&terrain, capsule, by);
        assert_eq!(cast(&terrain, capsule, by), swept);
        assert!(
            !overlaps || swept.is_some_and(|met| met.started_inside),
            "{contacts:?}"
        );
        swept.is_some()
    };
    assert!(meets(&good, by));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
        for place in [DVec3::Y * bad, DVec3::splat(bad)] {
            assert!(!meets(&good, place), "{place}");
            let one_end = WorldCapsule {
                ends: [DVec3::Y * 3.0, place],
                ..good
            };
            assert!(!meets(&one_end, by), "{place}");
            assert!(!meets(&WorldCapsule::ball(place, 0.5), by), "{place}");
        }
        let broken = good.with_radius(bad);
        assert_eq!(cast(&terrain, &broken, by), None, "{bad}");
        assert_eq!(sweep(&terrain, &broken, by), None, "{bad}");
    }
    assert!(!meets(&good.with_radius(-0.1), by));
    assert!(!meets(&WorldCapsule::ball(DVec3::splat(1e300), 0.5), by));
    assert!(!meets(&good, DVec3::X * 1e300));
    // A radius or displacement of zero is valid.
    assert!(meets(&good.with_radius(0.0), by));
    assert!(!meets(&good, DVec3::ZERO));
    assert!(meets(&WorldCapsule::ball(DVec3::Y, 0.5), DVec3::ZERO));
}

#[test]
fn the_order_of_insertion_does_not_matter() {
    let mut rng = fastrand::Rng::with_seed(71);
    let mut bodies = Vec::new();
    for k in 0..60 {
        let mut point = || [0; 3].map(|_| (rng.f32() - 0.5) * 6.0);
        let poses = slide(point(), point());
        let collider = match k % 3 {
            0 => ColliderBuilder::ball(0.3),
            1 => ColliderBuilder::cuboid(0.2, 0.3, 0.4),
            _ => ColliderBuilder::cylinder(0.2, 0.4),
        };
        bodies.push((collider, poses));
    }
    let one = Moving::new(bodies.clone());
    bodies.reverse();
    let other = Moving::new(bodies);
    let mut met = 0;
    for _ in 0..300 {
        let mut point =
            |size: f64| DVec3::new(rng.f64() - 0.5, rng.f64() - 0.5, rng.f64() - 0.5) * size;
        let (a, along, by) = (point(6.0), point(1.0), point(4.0));
        let capsule = WorldCapsule {
            ends: [a, a + along],
            radius: 0.2,
        };
        let [first, last] = [&one, &other].map(|moving| {
            let terrain = moving.terrain();
            let casts = [sweep, cast].map(|cast| cast(&terrain, &capsule, by));
            let mut contacts = Vec::new();
            terrain.overlap_capsule(&capsule, &mut contacts);
            let is_sorted = contacts.is_sorted_by_key(|contact| contact.material.key);
            assert!(is_sorted, "{contacts:?}");
            contacts.sort_by(|a, b| a.distance.total_cmp(&b.distance));
            // Handles differ, since the bodies were made in another order.
            let shown = |contact: crate::Contact| (contact.point, contact.normal, contact.distance);
            let met = |met: SweepContact| (met.fraction, shown(met.contact), met.separation_normal);
            let contacts: Vec<_> = contacts.into_iter().map(shown).collect();
            (casts.map(|cast| cast.map(met)), contacts)
        });
        assert_eq!(first, last, "{capsule:?} {by}");
        met += u32::from(first.0[0].is_some());
    }
    assert!(met > 50, "{met}");
}
