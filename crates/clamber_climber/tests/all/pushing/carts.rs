//! Carts, rafts and ships with a passenger: only gravity and fixed bodies change the momentum of bodies and climber.

use clamber_climber::{ClimberInput, ClimberMode};
use clamber_world::rapier3d::prelude::{
    ColliderBuilder, Pose, RevoluteJointBuilder, RigidBodyBuilder, RigidBodyHandle, SharedShape,
    Vector,
};
use glam::DVec3;

use crate::cases::pairs;
use crate::input::{IDLE, walk};
use crate::pushing::scene::{MASS, Scene, cuboid};

/// A cart on rails along X, with walls at both ends. Its deck is at height 1.1.
fn cart(kind: &str) -> (Scene, RigidBodyHandle) {
    let mut scene = Scene::new(0.0, DVec3::new(0.0, 1.5, 0.0));
    let body = RigidBodyBuilder::dynamic()
        .translation(Vector::new(0.0, 1.0, 0.0))
        .lock_rotations()
        .enabled_translations(true, false, false)
        .can_sleep(false);
    let handle = if kind == "one collider" {
        let wall = |x: f32| {
            let place = Pose::from_translation(Vector::new(x, 1.0, 0.0));
            (place, SharedShape::cuboid(0.1, 1.0, 1.0))
        };
        let deck = (
            Pose::from_translation(Vector::ZERO),
            SharedShape::cuboid(2.0, 0.1, 1.0),
        );
        let whole = ColliderBuilder::compound(vec![deck, wall(1.9), wall(-1.9)]);
        scene.add(body, [(whole.friction(0.0), 200.0)])
    } else {
        let place = |x: f32| Vector::new(x, 1.0, 0.0);
        let wall = |x: f32| (cuboid(0.1, 1.0, 1.0).translation(place(x)), 25.0);
        let deck = (cuboid(2.0, 0.1, 1.0), 150.0);
        scene.add(body, [deck, wall(1.9), wall(-1.9)])
    };
    (scene, handle)
}

#[test]
fn a_passenger_does_not_drive_its_cart() {
    // The support does not feel the climber's inertia, so that jumps between the shoves of a crate leave some speed.
    let plays = [
        (false, 0, 0.05),
        (false, 97, 0.05),
        (true, 0, 0.05),
        (true, 97, 1.5),
    ];
    for (kind, (loaded, jumps, most)) in pairs(["one collider", "three colliders"], plays) {
        let (mut scene, cart) = cart(kind);
        let mut bodies = vec![cart];
        if loaded {
            let crate_body = RigidBodyBuilder::dynamic()
                .translation(Vector::new(1.2, 1.41, 0.0))
                .lock_rotations()
                .can_sleep(false);
            bodies.push(scene.add(crate_body, [(cuboid(0.3, 0.3, 0.3), 30.0)]));
        }
        for tick in 0..1_200 {
            // The climber pushes against the front wall, then against the rear one, and jumps sometimes.
            let ahead = if tick / 200 % 2 == 0 { 1.0 } else { -1.0 };
            let mut input = if tick < 30 {
                IDLE
            } else {
                walk(DVec3::X * ahead)
            };
            input.jump = jumps > 0 && tick % jumps == 50;
            scene.tick(&input);
            let speed = scene.velocity(cart).x;
            let told = format!("{kind}, loaded {loaded}, tick {tick}: {speed} m/s");
            assert!(speed.abs() < 3.0, "{told}");
            assert!(!scene.climber.state().crushed, "{told}");
        }
        // The cart is at rest in the end, at any place.
        scene.ticks(240, &IDLE);
        let speed = scene.velocity(cart).x;
        let told = format!("{kind}, loaded {loaded}, jumps {jumps}: {speed} m/s");
        assert!(speed.abs() < most, "{told}");
    }
}

#[test]
fn walking_stopping_and_jumping_on_a_raft_keep_the_momentum_of_both() {
    for mass in [20.0, 80.0, 400.0, 8_000.0] {
        let mut scene = Scene::new(0.0, DVec3::new(0.0, 0.41, 0.0));
        let body = RigidBodyBuilder::dynamic()
            .translation(Vector::new(0.0, -0.5, 0.0))
            .lock_rotations()
            .enabled_translations(true, false, true)
            .can_sleep(false);
        let raft = scene.add(body, [(cuboid(60.0, 0.5, 60.0), mass)]);
        scene.ticks(20, &IDLE);
        for tick in 0..600u32 {
            let angle = 0.02 * f64::from(tick);
            let stick = DVec3::new(libm::cos(angle), 0.0, libm::sin(2.0 * angle));
            let mut input = if tick % 150 < 100 { walk(stick) } else { IDLE };
            input.jump = tick % 150 == 60;
            scene.tick(&input);
            // Pushes of this tick reach the raft in the next one, together with the velocity that they change.
            scene.apply();
            let own = scene.climber.state().velocity - scene.climber.state().base_velocity;
            let in_air = scene.climber.state().mode == ClimberMode::Falling;
            let climber = if in_air {
                scene.climber.state().velocity
            } else {
                scene.velocity(raft) + own
            };
            let sum = (scene.momentum(raft) + climber * MASS) * DVec3::new(1.0, 0.0, 1.0);
            let told = format!("{mass} kg, tick {tick}: {sum} N s");
            assert!(sum.length() < 0.01 * MASS * 3.0, "{told}");
        }
    }
}

#[test]
fn a_hinged_door_on_a_ship_opens() {
    let mut scene = Scene::new(0.0, DVec3::new(-1.0, 0.41, -0.3));
    let body = RigidBodyBuilder::dynamic()
        .translation(Vector::new(0.0, -0.5, 0.0))
        .lock_rotations()
        .enabled_translations(true, false, true);
    let (ship, _) = scene
        .world
        .insert(body, cuboid(9.0, 0.5, 9.0).mass(5_000.0));
    let door = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 1.02, 0.0));
    let (door, _) = scene.world.insert(door, cuboid(0.05, 1.0, 0.5).mass(40.0));
    let hinge = RevoluteJointBuilder::new(Vector::Y)
        .contacts_enabled(false)
        .local_anchor1(Vector::new(0.0, 1.52, 0.5))
        .local_anchor2(Vector::new(0.0, 0.0, 0.5));
    scene.world.insert_impulse_joint(ship, door, hinge);
    scene.world.step();
    let mut most = 0.0f64;
    for tick in 0..240 {
        let input: ClimberInput = if tick < 20 { IDLE } else { walk(DVec3::X) };
        scene.tick(&input);
        let turned = scene.world.bodies[door].rotation().to_scaled_axis().y;
        most = most.max(f64::from(turned.abs()));
    }
    assert!(most > 0.5, "the door turns by {most}");
    let speed = scene.velocity(ship).length();
    assert!(speed < 0.2, "the ship goes at {speed} m/s");
    assert!(scene.momenta(&[ship, door]).x.abs() < 30.0);
}
