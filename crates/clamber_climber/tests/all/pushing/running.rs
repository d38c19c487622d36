//! Running into bodies, and bodies that cannot be pushed.

use clamber_climber::{Climber, ClimberConfig, ClimberInput};
use clamber_world::rapier3d::prelude::{RigidBodyBuilder, RigidBodyHandle, Vector};
use clamber_world::{BodyPoses, Obstacle, ObstacleId, RapierTerrain};
use glam::DVec3;

use crate::cases::triples;
use crate::input::{IDLE, walk};
use crate::pushing::scene::{Scene, cuboid, sum};
use crate::scene::DT;

/// Largest force with which the climber pushes, newtons.
const FORCE: f64 = 600.0;

/// Walking speed of the climber, metres a second.
const SPEED: f64 = 3.0;

/// Largest allowed speed of the box's centre, metres a second. The pushed point moves at [`SPEED`]; the box rocks a
/// little, so that its centre is faster by up to a thousandth.
const FASTEST: f64 = SPEED * 1.001;

/// A climber on the floor, half a metre from a box with a mass and sides of a metre.
fn before_a_box(mass: f64) -> (Scene, RigidBodyHandle) {
    let mut scene = Scene::new(9.81, DVec3::new(0.0, 0.4, 0.0)).with_floor();
    let place = Vector::new(1.4, 0.5, 0.0);
    let body = RigidBodyBuilder::dynamic().translation(place);
    let handle = scene.add(body, [(cuboid(0.5, 0.5, 0.5), mass)]);
    (scene, handle)
}

#[test]
fn a_box_gains_the_momentum_that_it_is_given_and_never_outruns_the_climber() {
    let (mut scene, handle) = before_a_box(20.0);
    let mut fastest = 0.0_f64;
    for tick in 0..240 {
        let given = sum(&scene.pushes);
        let before = scene.momentum(handle);
        scene.apply();
        let gained = scene.momentum(handle) - before;
        let told = format!("tick {tick}: given {given}, gained {gained}");
        assert!(gained.distance(given) < 1e-4, "{told}");
        assert!(given.length() <= FORCE * DT * (1.0 + 1e-9), "{told}");
        scene.step(&walk(DVec3::X));
        // No other body pushes the box along the floor.
        let over_the_tick = scene.momentum(handle) - before;
        assert!(
            (over_the_tick - given).x.abs() < 1e-3,
            "{told}: {over_the_tick}"
        );
        fastest = fastest.max(scene.velocity(handle).x);
        // The climber that runs after the box has not passed into it.
        let ahead = scene.place(handle).x - scene.climber.state().position.x;
        assert!(ahead > 0.88, "{told}: {ahead}");
    }
    assert!(fastest <= FASTEST, "{fastest}");
    assert!(fastest > SPEED * 0.99, "{fastest}");
    assert!(scene.place(handle).x > 8.0, "{}", scene.place(handle));
}

#[test]
fn a_heavy_body_gains_no_more_than_the_push_force_gives() {
    let (mut scene, handle) = before_a_box(10_000.0);
    let most = FORCE * DT / 10_000.0;
    let mut pushed = 0;
    for tick in 0..240 {
        let before = scene.velocity(handle).x;
        scene.tick(&walk(DVec3::X));
        let gained = scene.velocity(handle).x - before;
        assert!(gained <= most * 1.001, "tick {tick}: {gained}");
        pushed += u32::from(!scene.pushes.is_empty());
    }
    assert!(pushed > 200, "{pushed}");
    // Without friction, all of the force accelerates the body from the first contact on.
    let expected = most * f64::from(pushed);
    let speed = scene.velocity(handle).x;
    assert!(
        (speed / expected - 1.0).abs() < 0.05,
        "{speed} of {expected}"
    );
}

#[test]
fn two_contacts_share_the_push_force_on_one_body_or_two() {
    for is_one in [true, false] {
        let mut scene = Scene::new(9.81, DVec3::new(0.0, 0.4, 0.0)).with_floor();
        // The gap between both is half as wide as the climber's ball.
        let sides = [-0.7, 0.7];
        let handles: Vec<RigidBodyHandle> = if is_one {
            let body = RigidBodyBuilder::dynamic().translation(Vector::new(1.4, 0.5, 0.0));
            let half = |z| cuboid(0.5, 0.5, 0.5).translation(Vector::new(0.0, 0.0, z));
            vec![scene.add(body, sides.map(|z| (half(z), 10.0)))]
        } else {
            let body = |z| RigidBodyBuilder::dynamic().translation(Vector::new(1.4, 0.5, z));
            let add = |z| scene.add(body(z), [(cuboid(0.5, 0.5, 0.5), 10.0)]);
            sides.map(add).to_vec()
        };
        let mut both = 0;
        for tick in 0..240 {
            scene.tick(&walk(DVec3::X));
            let given = sum(&scene.pushes);
            let told = format!("one body {is_one}, tick {tick}: {:?}", scene.pushes);
            assert!(given.length() <= FORCE * DT * (1.0 + 1e-9), "{told}");
            both += u32::from(scene.pushes.len() == 2);
            for handle in &handles {
                let speed = scene.velocity(*handle).x;
                assert!(speed <= FASTEST, "{told}: {speed}");
            }
        }
        assert!(both > 4, "one body {is_one}: {both}");
    }
}

/// The climber's pushes, tick by tick, on a box that hangs beside a step that it climbs. All bodies move with a frame.
fn pushes_beside_a_step(frame: DVec3, rise: f32, low: f32, beside: f32) -> Vec<DVec3> {
    let mut scene = Scene::new(0.0, DVec3::new(0.0, 0.4, 0.0));
    let block = |from: f32, until: f32, top: f32| {
        let (long, middle) = ((until - from) / 2.0, (until + from) / 2.0);
        let at = Vector::new(middle, top - 2.0, 0.0);
        (cuboid(long, 2.0, 2.0).translation(at), 1.0)
    };
    let floors = [block(-5.0, 0.8, 0.0), block(0.8, 9.0, rise)];
    let floors = scene.add(RigidBodyBuilder::kinematic_velocity_based(), floors);
    let at = Vector::new(0.0, low + 2.0, beside + 2.0);
    let hangs = RigidBodyBuilder::dynamic().translation(at);
    let hangs = scene.add(hangs, [(cuboid(9.0, 2.0, 2.0), 1.0)]);
    for body in [floors, hangs] {
        scene.set_velocity(body, frame);
    }
    scene.throw(DVec3::ZERO, frame);
    let pushes = (0..40).map(|_| {
        scene.step(&walk(DVec3::X));
        sum(&scene.pushes)
    });
    pushes.collect()
}

/// After the movement, the climber is set down on the step, where it may touch another body. The push on that body
/// belongs to the movement.
#[test]
fn pushes_beside_a_step_are_the_same_in_every_frame() {
    let mut given = 0;
    for (rise, low, beside) in triples([0.15, 0.2, 0.3], 0..10, 0..10) {
        let (low, beside) = (0.5 + 0.06 * low as f32, 0.04 * beside as f32);
        let at_rest = pushes_beside_a_step(DVec3::ZERO, rise, low, beside);
        given += at_rest.iter().filter(|push| push.length() > 0.1).count();
        for frame in [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z, DVec3::Y] {
            let moving = pushes_beside_a_step(frame * 30.0, rise, low, beside);
            for (tick, (push, other)) in at_rest.iter().zip(&moving).enumerate() {
                let told = format!("{rise} m, {low} m, {beside} m, {frame}, tick {tick}");
                let off = push.distance(*other);
                assert!(off < 0.05, "{told}: {push}, {other}");
            }
        }
    }
    assert!(given > 100, "{given}");
}

/// Stands, walks against a wall, jumps and lands.
fn course(tick: u32) -> ClimberInput {
    ClimberInput {
        jump: tick % 50 == 20,
        ..if tick < 60 { IDLE } else { walk(DVec3::X) }
    }
}

#[test]
fn bodies_that_cannot_be_pushed_get_no_push_and_allocate_nothing() {
    let bodies = [
        RigidBodyBuilder::fixed(),
        RigidBodyBuilder::kinematic_velocity_based().linvel(Vector::new(-0.5, 0.0, 0.0)),
        RigidBodyBuilder::kinematic_position_based(),
    ];
    for body in bodies {
        let mut scene = Scene::new(9.81, DVec3::new(0.0, 0.6, 0.0)).with_floor();
        let wall = body.translation(Vector::new(3.0, 0.5, 0.0));
        scene.add(wall, [(cuboid(0.5, 0.5, 5.0), 50.0)]);
        // A body that could be pushed, but is far away.
        let far = RigidBodyBuilder::dynamic().translation(Vector::new(-30.0, 0.5, 0.0));
        scene.add(far, [(cuboid(0.5, 0.5, 0.5), 50.0)]);
        for tick in 0..300 {
            let report = scene.tick(&course(tick));
            assert_eq!(report.pushes.capacity(), 0, "tick {tick}: {report:?}");
        }
    }
}

#[test]
fn pushes_do_not_depend_on_the_order_of_obstacles() {
    // Two worlds with a box each, and a gap between the boxes that is too narrow. The climber stands on a raft in a
    // third world.
    let (mut boxes, mut befores) = (Vec::new(), Vec::new());
    for z in [-0.7, 0.7] {
        let mut scene = Scene::new(0.0, DVec3::ZERO);
        let body = RigidBodyBuilder::dynamic().translation(Vector::new(1.4, 0.5, z));
        scene.add(body, [(cuboid(0.5, 0.5, 0.5), 50_000.0)]);
        boxes.push(scene.world);
        befores.push(BodyPoses::new());
    }
    let mut scene = Scene::new(0.0, DVec3::ZERO);
    let raft = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, -0.5, 0.0));
    scene.add(raft, [(cuboid(9.0, 0.5, 9.0), 50_000.0)]);
    boxes.push(scene.world);
    befores.push(BodyPoses::new());
    let worlds: Vec<RapierTerrain<'_>> = boxes
        .iter()
        .zip(&befores)
        .map(|(world, before)| RapierTerrain::of_world(world, before))
        .collect();
    let orders = [[0, 1, 2], [2, 1, 0], [1, 2, 0], [0, 2, 1]];
    let mut climbers =
        orders.map(|_| Climber::new(ClimberConfig::walker(), DVec3::new(0.0, 0.6, 0.0)).unwrap());
    let mut most = 0;
    for tick in 0..120 {
        let reports = std::array::from_fn::<_, 4, _>(|k| {
            let obstacles = orders[k].map(|w| {
                let world: &dyn Obstacle = &worlds[w];
                (ObstacleId(w as u64), world)
            });
            climbers[k].step(&walk(DVec3::X), &obstacles, DT).unwrap()
        });
        for report in &reports {
            assert_eq!(*report, reports[0], "tick {tick}");
        }
        most = most.max(reports[0].pushes.len());
    }
    assert_eq!(most, 3, "two boxes and the raft");
}
