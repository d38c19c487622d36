//! The same scene in avian and in rapier answers queries of obstacles alike.

use avian3d::parry::math::Pose;
use avian3d::parry::shape::SharedShape;
use bevy_app::{App, FixedUpdate, TaskPoolPlugin};
use bevy_clamber::{AvianObstacles, AvianObstaclesPlugin, RapierObstacles, RapierObstaclesPlugin};
use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use bevy_math::{Quat, Vec3};
use bevy_rapier3d::prelude::{NoUserData, PhysicsSet, RapierPhysicsPlugin};
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use bevy_transform::components::Transform;
use clamber_world::{Contact, Obstacle, PointMotion, SweepContact, TargetMotion, WorldCapsule};
use glam::{DQuat, DVec3};

/// Ticks a second.
const RATE: f64 = 64.0;

/// Radians a second that the carousel turns: an eighth of a radian a tick, so that chord and tangent differ.
const SPIN: f64 = 8.0;

/// Metres a second that the carousel moves.
const DRIFT: f64 = 3.0;

/// Largest difference between the answers of two engines, metres.
const SAME: f64 = 1e-5;

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Fixed,
    Carousel,
    Sensor,
}

/// Marks the body that the game moves in each tick.
#[derive(Component)]
struct Carousel;

/// The carousel's axis. It is tilted, so that a wrong order of rotations shows.
fn axis() -> DVec3 {
    DVec3::new(0.28, 0.96, 0.0)
}

/// Rotation and position of the carousel at a time.
fn carousel(seconds: f64) -> (DQuat, DVec3) {
    let half = 0.5 * SPIN * seconds;
    let (sin, cos) = (libm::sin(half), libm::cos(half));
    let v = axis() * sin;
    let place = DVec3::new(-6.0, 4.0, 1.0 + DRIFT * seconds);
    (DQuat::from_xyzw(v.x, v.y, v.z, cos), place)
}

fn turn_carousel(time: Res<Time<Fixed>>, mut all: Query<&mut Transform, With<Carousel>>) {
    for mut transform in &mut all {
        let (rotation, place) = carousel(time.elapsed_secs_f64());
        transform.rotation = rotation.as_quat();
        transform.translation = place.as_vec3();
    }
}

/// A hilly ground, and shapes of several kinds on it.
fn scene() -> Vec<(SharedShape, Transform, Kind)> {
    let side = 13_u32;
    let height = |x: u32, z: u32| 0.8 * ((x * 7 + z * 5) % 6) as f32 / 6.0;
    let corners = (0..side * side).map(|index| {
        let (x, z) = (index % side, index / side);
        Vec3::new(x as f32 * 2.0 - 12.0, height(x, z), z as f32 * 2.0 - 12.0)
    });
    let cells = (0..side * side).filter(|i| i % side + 1 < side && i / side + 1 < side);
    let triangles = cells.flat_map(|i| [[i, i + side, i + 1], [i + 1, i + side, i + side + 1]]);
    let ground = SharedShape::trimesh(corners.collect(), triangles.collect()).unwrap();
    let part = |x: f32, shape| (Pose::from_translation(Vec3::X * x), shape);
    let dumbbell = SharedShape::compound(vec![
        part(-1.0, SharedShape::ball(0.5)),
        part(1.0, SharedShape::cuboid(0.4, 0.5, 0.6)),
    ]);
    let tilted =
        |x, y, z| Transform::from_xyz(x, y, z).with_rotation(Quat::from_xyzw(0.1, 0.7, -0.5, 0.5));
    vec![
        (ground, Transform::from_xyz(0.5, -0.25, 0.0), Kind::Fixed),
        (
            SharedShape::cuboid(1.0, 2.0, 0.5),
            tilted(4.0, 2.0, 3.0),
            Kind::Fixed,
        ),
        (SharedShape::ball(1.5), tilted(-3.0, 1.0, -5.0), Kind::Fixed),
        (
            SharedShape::capsule_y(1.0, 0.5),
            tilted(6.0, 2.0, -4.0),
            Kind::Fixed,
        ),
        (dumbbell, tilted(0.0, 3.0, 6.0), Kind::Fixed),
        (
            SharedShape::cuboid(3.0, 0.25, 3.0),
            Transform::default(),
            Kind::Carousel,
        ),
        (
            SharedShape::ball(4.0),
            Transform::from_xyz(1.0, 5.0, 0.0),
            Kind::Sensor,
        ),
    ]
}

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin))
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
        .insert_resource(Time::<Fixed>::from_hz(RATE))
        .add_systems(FixedUpdate, turn_carousel.before(PhysicsSet::SyncBackend));
    app
}

/// Runs an app for some ticks.
fn run(mut app: App) -> App {
    app.finish();
    app.cleanup();
    for _ in 0..12 {
        app.update();
    }
    app
}

fn avian() -> App {
    use avian3d::prelude::{Collider, PhysicsPlugins, RigidBody, Sensor};
    let mut app = app();
    app.add_plugins((PhysicsPlugins::default(), AvianObstaclesPlugin::default()));
    for (shape, place, kind) in scene() {
        let mut entity = app.world_mut().spawn((Collider::from(shape), place));
        match kind {
            Kind::Fixed => entity.insert(RigidBody::Static),
            Kind::Carousel => entity.insert((RigidBody::Kinematic, Carousel)),
            Kind::Sensor => entity.insert((RigidBody::Static, Sensor)),
        };
    }
    run(app)
}

fn rapier() -> App {
    use bevy_rapier3d::prelude::{Collider, RigidBody, Sensor};
    let mut app = app();
    let physics = RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule();
    app.add_plugins((physics, RapierObstaclesPlugin::default()));
    for (shape, place, kind) in scene() {
        let mut entity = app.world_mut().spawn((Collider::from(shape), place));
        match kind {
            Kind::Fixed => entity.insert(RigidBody::Fixed),
            Kind::Carousel => entity.insert((RigidBody::KinematicPositionBased, Carousel)),
            Kind::Sensor => entity.insert((RigidBody::Fixed, Sensor)),
        };
    }
    run(app)
}

/// The answer of avian's obstacle.
fn ask_avian<R: 'static>(
    app: &mut App,
    ask: impl Fn(&dyn Obstacle) -> R + Send + Sync + 'static,
) -> R {
    let system = move |avian: AvianObstacles| ask(&avian.terrain());
    app.world_mut().run_system_once(system).unwrap()
}

/// The answer of rapier's obstacle.
fn ask_rapier<R: 'static>(
    app: &mut App,
    ask: impl Fn(&dyn Obstacle) -> R + Send + Sync + 'static,
) -> R {
    let system = move |rapier: RapierObstacles| ask(&rapier.terrain().unwrap());
    app.world_mut().run_system_once(system).unwrap()
}

/// A contact, and the motion of its point.
type Answer = (Contact, Option<PointMotion>);

/// The answers to some hundreds of queries: rays, closest points and overlaps, each with the motion of its points.
fn interrogate(obstacle: &dyn Obstacle) -> Vec<(String, Vec<Answer>)> {
    let mut random = fastrand::Rng::with_seed(7);
    let mut vector = |size: f64| {
        let mut one = || size * (2.0 * random.f64() - 1.0);
        DVec3::new(one(), one(), one())
    };
    let with_motion = |contact: Contact| (contact, obstacle.motion(&contact.material, 1.0 / RATE));
    let mut answers = Vec::new();
    for _ in 0..400 {
        let (from, along) = (vector(9.0), vector(3.0));
        let hit = obstacle.cast_ray(from, along, 30.0);
        let name = format!("ray from {from} along {along}");
        answers.push((name, hit.into_iter().map(with_motion).collect()));
        let reach = 0.5 + from.x.abs();
        let near = obstacle.closest_point(from, reach);
        // Where two triangles meet, the normal may be either one's.
        let near = near.map(|contact| Contact {
            normal: contact.separation_normal(from),
            ..contact
        });
        let name = format!("closest to {from} within {reach}");
        answers.push((name, near.into_iter().map(with_motion).collect()));
        let mut all = Vec::new();
        obstacle.overlap_sphere(from, 0.3 * reach, &mut all);
        assert!(all.is_sorted_by_key(|contact| contact.material.key));
        let name = format!("overlap of {from} with {}", 0.3 * reach);
        answers.push((name, all.into_iter().map(with_motion).collect()));
    }
    answers
}

/// The difference of two answers, metres; `f64::MAX` if their normals or rotations differ.
fn apart(a: &Answer, b: &Answer) -> f64 {
    let (a_motion, b_motion) = (a.1.unwrap(), b.1.unwrap());
    let turned = (a_motion.turn * DVec3::X - b_motion.turn * DVec3::X).length();
    if (a.0.normal - b.0.normal).length() > 1e-4 || turned > 1e-5 {
        return f64::MAX;
    }
    let apart = [
        (a.0.point - b.0.point).length(),
        (a.0.distance - b.0.distance).abs(),
        (a_motion.position - b_motion.position).length(),
        (a_motion.previous_position - b_motion.previous_position).length(),
    ];
    apart.into_iter().fold(0.0, f64::max)
}

#[test]
fn avian_answers_as_rapier_does() {
    let avian = ask_avian(&mut avian(), interrogate);
    let rapier = ask_rapier(&mut rapier(), interrogate);
    let (mut contacts, mut carried, mut worst) = (0, 0, 0.0_f64);
    for ((question, avian), (_, rapier)) in avian.iter().zip(&rapier) {
        assert_eq!(
            avian.len(),
            rapier.len(),
            "{question}: {avian:?} {rapier:?}"
        );
        for a in avian {
            let apart = rapier.iter().map(|b| apart(a, b)).fold(f64::MAX, f64::min);
            assert!(apart < SAME, "{question}: {a:?} {rapier:?}");
            worst = worst.max(apart);
            contacts += 1;
            carried += usize::from(a.1.unwrap().velocity != DVec3::ZERO);
        }
    }
    println!("{contacts} contacts, {carried} on moving bodies, at most {worst:.1e} m apart");
    assert!(contacts > 500 && carried > 50, "{contacts} {carried}");
}

/// The name of a cast, its first contact, and the motion of the contact's point.
type Meeting = (String, Option<SweepContact>, Option<PointMotion>);

/// Casts and sweeps capsules, every other one near the carousel.
fn sweep(obstacle: &dyn Obstacle) -> Vec<Meeting> {
    let mut random = fastrand::Rng::with_seed(8);
    let mut vector = |size: f64| {
        let mut one = || size * (2.0 * random.f64() - 1.0);
        DVec3::new(one(), one(), one())
    };
    let mut meetings = Vec::new();
    for case in 0..2_400 {
        let from = match case % 2 {
            0 => vector(9.0),
            _ => vector(3.0) + carousel(12.0 / RATE).1,
        };
        let capsule = WorldCapsule {
            ends: [from, from + vector(1.0)],
            radius: [0.0, 0.1, 0.4][case % 3],
        };
        let by = vector(2.0);
        let turning = [by, vector(2.0)];
        let cast = obstacle.cast_capsule(&capsule, [by; 2], TargetMotion::Still);
        let swept = obstacle.cast_capsule(&capsule, turning, TargetMotion::Moving);
        // The first contact that is not an overlap at the start.
        let past =
            obstacle.cast_capsule_where(&capsule, turning, TargetMotion::Moving, &mut |met| {
                !met.started_inside
            });
        assert!(past.is_none_or(|past| !past.started_inside), "{past:?}");
        for (what, met) in [("cast", cast), ("swept", swept), ("swept past", past)] {
            let motion = met.and_then(|met| obstacle.motion(&met.contact.material, 1.0 / RATE));
            meetings.push((format!("{capsule:?} {what} by {turning:?}"), met, motion));
        }
    }
    meetings
}

#[test]
fn casts_of_capsules_agree_in_avian_and_rapier() {
    let avian = ask_avian(&mut avian(), sweep);
    let rapier = ask_rapier(&mut rapier(), sweep);
    let (mut met, mut carried, mut inside, mut past, mut grazed) = (0, 0, 0, 0, 0);
    let mut was_inside = false;
    for ((question, avian, motion), (_, rapier, _)) in avian.iter().zip(&rapier) {
        let (Some(a), Some(b)) = (avian, rapier) else {
            grazed += usize::from(avian.is_some() != rapier.is_some());
            continue;
        };
        met += 1;
        inside += usize::from(a.started_inside);
        past += usize::from(was_inside && question.contains("past"));
        was_inside = a.started_inside;
        carried += usize::from(motion.unwrap().velocity != DVec3::ZERO);
        // A cast that approaches slowly may stop anywhere within the tolerance.
        grazed += usize::from((a.fraction - b.fraction).abs() > 1e-3);
        assert!(
            (a.fraction - b.fraction).abs() < 0.05,
            "{question}: {a:?} {b:?}"
        );
        assert_eq!(
            a.started_inside, b.started_inside,
            "{question}: {a:?} {b:?}"
        );
        if a.started_inside {
            let apart = (a.contact.distance - b.contact.distance).abs();
            assert!(apart < SAME, "{question}: {a:?} {b:?}");
        }
    }
    println!(
        "{met} contacts, {carried} on moving bodies, {inside} inside, {past} past those, {grazed} grazed"
    );
    assert!(
        met > 400 && carried > 100 && inside > 50 && past > 20,
        "{met} {carried} {inside} {past}"
    );
    assert!(grazed < 8, "{grazed}");
}

/// Checks the carousel's motion; returns the number of points.
fn check_motion(obstacle: &dyn Obstacle, now: f64) -> usize {
    let before = now - 1.0 / RATE;
    let (rotation, place) = carousel(now);
    let mut checked = 0;
    for x in [-2.5, -1.0, 0.5, 2.0] {
        for z in [-2.0, 0.25, 2.5] {
            // From above, on the upper face.
            let local = DVec3::new(x, 0.25, z);
            let point = rotation * local + place;
            let normal = rotation * DVec3::Y;
            let hit = obstacle.cast_ray(point + normal * 0.5, -normal, 1.0);
            let hit = hit.unwrap();
            assert!((hit.distance - 0.5).abs() < SAME, "{hit:?}");
            assert!((hit.normal - normal).length() < 1e-4, "{hit:?}");
            let motion = obstacle.motion(&hit.material, 1.0 / RATE).unwrap();
            let (was_turned, was) = carousel(before);
            let previous = was_turned * local + was;
            assert!(
                (motion.position - point).length() < SAME,
                "{motion:?} {point}"
            );
            assert!(
                (motion.previous_position - previous).length() < SAME,
                "{motion:?} {previous}"
            );
            let chord = (point - previous) * RATE;
            assert!(
                (motion.velocity - chord).length() < 2e-3,
                "{motion:?} {chord}"
            );
            let tangent = axis().cross(point - place) * SPIN + DVec3::Z * DRIFT;
            assert!(
                (motion.velocity - tangent).length() > 0.1,
                "{motion:?} {tangent}"
            );
            let turn = rotation * was_turned.conjugate();
            let apart = (motion.turn * DVec3::X - turn * DVec3::X).length();
            assert!(apart < 1e-5, "{motion:?} {turn}");
            checked += 1;
        }
    }
    checked
}

#[test]
fn a_point_on_a_turning_body_moves_by_its_chord_and_not_by_its_tangent() {
    let (mut avian, mut rapier) = (avian(), rapier());
    for _ in 0..3 {
        let now = avian.world().resource::<Time<Fixed>>().elapsed_secs_f64();
        assert_eq!(ask_avian(&mut avian, move |o| check_motion(o, now)), 12);
        let now = rapier.world().resource::<Time<Fixed>>().elapsed_secs_f64();
        assert_eq!(ask_rapier(&mut rapier, move |o| check_motion(o, now)), 12);
        avian.update();
        rapier.update();
    }
}

/// Checks what the trait promises for bad input and for infinite sizes.
fn check_limits(obstacle: &dyn Obstacle) {
    let mut contacts = Vec::new();
    for bad in [DVec3::NAN, DVec3::splat(f64::INFINITY), DVec3::splat(1e300)] {
        assert_eq!(obstacle.closest_point(bad, 1.0), None);
        assert_eq!(obstacle.cast_ray(bad, DVec3::X, 1.0), None);
        obstacle.overlap_sphere(bad, 1.0, &mut contacts);
    }
    let above = DVec3::new(0.1, 20.0, 0.2);
    for bad in [f64::NAN, -1.0] {
        assert_eq!(obstacle.closest_point(DVec3::ZERO, bad), None);
        assert_eq!(obstacle.cast_ray(above, -DVec3::Y, bad), None);
        obstacle.overlap_sphere(DVec3::ZERO, bad, &mut contacts);
    }
    for bad in [DVec3::NAN, DVec3::ZERO, DVec3::splat(f64::INFINITY)] {
        assert_eq!(obstacle.cast_ray(above, bad, 99.0), None);
    }
    let good = WorldCapsule::ball(above, 0.5);
    for bad in [DVec3::NAN, DVec3::splat(f64::INFINITY), DVec3::splat(1e300)] {
        let one_end = WorldCapsule {
            ends: [above, bad],
            ..good
        };
        for (capsule, by) in [(good, bad), (one_end, -DVec3::Y)] {
            assert_eq!(
                obstacle.cast_capsule(&capsule, [by; 2], TargetMotion::Still),
                None,
                "{capsule:?} {by}"
            );
            assert_eq!(
                obstacle.cast_capsule(&capsule, [by; 2], TargetMotion::Moving),
                None,
                "{capsule:?} {by}"
            );
        }
        obstacle.overlap_capsule(&one_end, &mut contacts);
    }
    for bad in [f64::NAN, -1.0, f64::INFINITY] {
        let capsule = good.with_radius(bad);
        assert_eq!(
            obstacle.cast_capsule(&capsule, [-DVec3::Y; 2], TargetMotion::Still),
            None,
            "{bad}"
        );
        assert_eq!(
            obstacle.cast_capsule(&capsule, [-DVec3::Y; 2], TargetMotion::Moving),
            None,
            "{bad}"
        );
    }
    assert!(contacts.is_empty(), "{contacts:?}");

    // A direction may have any length; distances are in metres. A hit at exactly the limit counts.
    let hit = obstacle
        .cast_ray(above, DVec3::NEG_Y * 7.0, f64::INFINITY)
        .unwrap();
    assert!((hit.point - (above - DVec3::Y * hit.distance)).length() < SAME);
    assert_eq!(obstacle.cast_ray(above, -DVec3::Y, hit.distance), Some(hit));
    assert_eq!(
        obstacle.cast_ray(above, -DVec3::Y, hit.distance * 0.999),
        None
    );
    let far = DVec3::new(300.0, 40.0, -200.0);
    let near = obstacle.closest_point(far, f64::INFINITY).unwrap();
    assert_eq!(obstacle.closest_point(far, near.distance), Some(near));
    assert_eq!(obstacle.closest_point(far, near.distance * 0.999), None);
    obstacle.overlap_sphere(far, f64::INFINITY, &mut contacts);
    assert_eq!(
        contacts.len(),
        288 + 3 + 2 + 1,
        "every triangle, every convex part"
    );
    // Inside a solid the distance is negative, and the normal points out of the solid.
    let inside = obstacle
        .closest_point(DVec3::new(-3.0, 2.0, -5.0), 1.0)
        .unwrap();
    assert!((inside.distance + 0.5).abs() < SAME, "{inside:?}");
    assert!((inside.normal - DVec3::Y).length() < 1e-5, "{inside:?}");
    let moved = obstacle.motion(&hit.material, 0.0);
    assert_eq!(moved, None, "a tick of no length has no motion");
    let mut nobody = hit.material;
    nobody.key = u64::MAX;
    assert_eq!(obstacle.motion(&nobody, 0.1), None);
}

#[test]
fn limits_and_bad_input_are_as_the_trait_says() {
    ask_avian(&mut avian(), check_limits);
    ask_rapier(&mut rapier(), check_limits);
}

#[test]
fn a_stopped_body_has_zero_velocity_and_a_missing_one_no_motion() {
    use avian3d::prelude::Collider;
    let on_carousel = |obstacle: &dyn Obstacle, now| {
        let (rotation, place) = carousel(now);
        let normal = rotation * DVec3::Y;
        let hit = obstacle.cast_ray(place + normal, -normal, 2.0).unwrap();
        hit.material
    };
    let mut avian = avian();
    let now = avian.world().resource::<Time<Fixed>>().elapsed_secs_f64();
    let material = ask_avian(&mut avian, move |obstacle| on_carousel(obstacle, now));
    let mut all = avian.world_mut().query_filtered::<Entity, With<Carousel>>();
    let carousel = all.single(avian.world()).unwrap();
    avian.world_mut().entity_mut(carousel).remove::<Carousel>();
    for ticks in 0..2 {
        avian.update();
        let motion = ask_avian(&mut avian, move |obstacle| obstacle.motion(&material, 0.1));
        assert_eq!(motion.unwrap().velocity, DVec3::ZERO, "after {ticks} ticks");
    }
    let body = move |obstacle: &dyn Obstacle| obstacle.rigid_body_id(&material);
    assert_eq!(ask_avian(&mut avian, body), carousel.to_bits());
    // With another shape the point is gone; with the first shape it is back.
    let shape = avian.world().get::<Collider>(carousel).cloned();
    for (shape, holds) in [(Some(Collider::sphere(0.1)), false), (shape, true)] {
        avian
            .world_mut()
            .entity_mut(carousel)
            .insert(shape.unwrap());
        let motion = ask_avian(&mut avian, move |obstacle| obstacle.motion(&material, 0.1));
        assert_eq!(motion.is_some(), holds, "of another shape: {motion:?}");
    }
    avian
        .world_mut()
        .entity_mut(carousel)
        .insert(avian3d::prelude::ColliderDisabled);
    let motion = ask_avian(&mut avian, move |obstacle| obstacle.motion(&material, 0.1));
    assert_eq!(motion, None, "disabled");
    avian.world_mut().despawn(carousel);
    let motion = ask_avian(&mut avian, move |obstacle| obstacle.motion(&material, 0.1));
    assert_eq!(motion, None, "despawned");
}

#[test]
fn child_colliders_are_hit_where_the_velocity_of_their_body_moves_them() {
    use avian3d::prelude::{
        AngularVelocity, Collider, LinearVelocity, PhysicsPlugins, Position, RigidBody, Rotation,
    };
    let mut app = app();
    app.add_plugins((PhysicsPlugins::default(), AvianObstaclesPlugin::default()));
    let velocity = LinearVelocity(Vec3::new(40.0, 0.0, 0.0));
    let turning = AngularVelocity(Vec3::new(0.0, 9.0, 0.0));
    let body = (
        RigidBody::Kinematic,
        velocity,
        turning,
        Transform::default(),
    );
    let body = app.world_mut().spawn(body).id();
    let ball = Collider::from(SharedShape::ball(0.25));
    let child = (ball, Transform::from_xyz(0.0, 2.0, 3.0), ChildOf(body));
    app.world_mut().spawn(child);
    let mut app = run(app);
    let mut before = None;
    for tick in 0..5 {
        app.update();
        let place = app.world().entity(body);
        let (rotation, position) = (place.get::<Rotation>(), place.get::<Position>());
        let rotation = rotation.unwrap().0.as_dquat().normalize();
        let center = rotation * DVec3::new(0.0, 2.0, 3.0) + position.unwrap().0.as_dvec3();
        let above = center + DVec3::Y;
        let (contact, motion) = ask_avian(&mut app, move |obstacle| {
            let ray = obstacle.cast_ray(above, DVec3::NEG_Y, 2.0).unwrap();
            let near = obstacle.closest_point(above, 2.0).unwrap();
            assert!((ray.point - near.point).length() < SAME, "{ray:?} {near:?}");
            (ray, obstacle.motion(&ray.material, 1.0 / RATE).unwrap())
        });
        let top = center + DVec3::Y * 0.25;
        // Far from the origin, f32 is no more exact.
        assert!(
            (contact.point - top).length() < 3e-5,
            "tick {tick}: {contact:?} {top}"
        );
        if let Some(before) = before {
            let was: DVec3 = before;
            let apart = (motion.previous_position - was).length();
            assert!(apart < 3e-5, "tick {tick}: {motion:?} {was}");
        }
        before = Some(top);
    }
}
