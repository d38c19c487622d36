//! Bodies that are light: hit in rows, stood on, jumped off, walked on and fallen on.

use clamber_climber::{
    ClimberConfig, ClimberEvent, ClimberInput, ClimberMode, StepRules, TumbleConfig,
};
use clamber_world::rapier3d::prelude::{
    ColliderBuilder, FixedJointBuilder, RigidBodyBuilder, RigidBodyHandle, Vector,
};
use glam::DVec3;

use crate::cases::{pairs, triples};
use crate::events::{count, is_tumbled};
use crate::input::{IDLE, blow, high_jump, walk};
use crate::pushing::scene::{MASS, Scene, boxed};

/// Sizes of the world, and rates, hertz.
const WORLDS: [(f64, f64); 6] = [
    (1.0, 60.0),
    (1.0, 30.0),
    (1.0, 120.0),
    (1.0, 240.0),
    (0.05, 60.0),
    (50.0, 60.0),
];

/// A body at a place, which does not fall asleep.
fn awake(place: DVec3) -> RigidBodyBuilder {
    RigidBodyBuilder::dynamic()
        .translation(place.as_vec3())
        .can_sleep(false)
}

fn floating(size: f64, rate: f64, frame: DVec3) -> Scene {
    let config = ClimberConfig {
        gravity: DVec3::ZERO,
        ..ClimberConfig::walker()
    };
    let mut scene = Scene::with(config, size, 1.0 / rate, 0.0, DVec3::ZERO);
    scene.throw(DVec3::ZERO, frame);
    scene
}

/// Kinetic energy of the bodies and the climber, in a frame.
fn energy(scene: &Scene, bodies: &[RigidBodyHandle], frame: DVec3) -> f64 {
    let own = scene.climber.state().velocity - frame;
    let of_bodies = bodies.iter().map(|body| {
        let body = &scene.world.bodies[*body];
        let moves = f64::from(body.mass()) * (body.linvel().as_dvec3() - frame).length_squared();
        let spin = body.rotation().inverse() * body.angvel();
        let turns = spin.dot(body.mass_properties().local_mprops.principal_inertia() * spin);
        0.5 * (moves + f64::from(turns))
    });
    0.5 * MASS * own.length_squared() + of_bodies.sum::<f64>()
}

/// The last of a row of balls hits the one before it, which still touches the climber.
#[test]
fn balls_in_a_row_give_a_floating_climber_their_momentum_and_no_more() {
    for (size, rate) in WORLDS {
        for (count, mass, speed, side) in [
            (1, 1.0, 20.0, DVec3::X),
            (2, 1.0, 20.0, DVec3::X),
            (2, 0.1, 20.0, DVec3::NEG_Z),
            (5, 0.1, 20.0, DVec3::X),
            (9, 0.5, 8.0, DVec3::NEG_Y),
            (2, 40.0, 5.0, DVec3::NEG_X),
        ] {
            let frame = side.cross(DVec3::new(3.0, -7.0, 5.0)) * size;
            let mut scene = floating(size, rate, frame);
            let balls: Vec<_> = (0..count)
                .map(|index| {
                    let place = -1.0 - f64::from(index) * (speed / rate).max(0.25);
                    let body = awake(side * (place * size));
                    let ball = ColliderBuilder::ball((0.1 * size) as f32).friction(0.0);
                    scene.add(body, [(ball, mass)])
                })
                .collect();
            for ball in &balls {
                scene.set_velocity(*ball, side * (speed * size) + frame);
            }
            let given = mass * speed * size * f64::from(count);
            let had = scene.momenta(&balls);
            let joules = energy(&scene, &balls, frame);
            for tick in 0..(2.0 * rate) as u32 {
                scene.step_and_apply(&IDLE);
                let told = format!(
                    "size {size}, {rate} Hz, {count} of {mass} kg along {side}, tick {tick}: {:?}",
                    scene.climber.state().velocity - frame
                );
                let off = (scene.momenta(&balls) - had).length();
                assert!(off < 0.02 * given, "{told}: {off} of {given} N s");
                let has = energy(&scene, &balls, frame);
                assert!(has < 1.01 * joules, "{told}: {joules} J became {has}");
            }
            let own = (scene.climber.state().velocity - frame).dot(side) * MASS;
            assert!(
                own > 0.5 * given,
                "size {size}, {rate} Hz: {own} of {given}"
            );
        }
    }
}

/// Two corners of a box strike one after the other.
#[test]
fn a_box_that_spins_makes_no_energy_of_its_second_corner() {
    let boxes = [(5.0, 30.0, 6.0), (20.0, 20.0, 3.0), (20.0, 10.0, 2.0)];
    for ((size, rate), (mass, spin, speed), shift) in triples(WORLDS, boxes, 0..12) {
        let mut scene = floating(size, rate, DVec3::ZERO);
        let place = DVec3::new(-1.3 - 0.03 * f64::from(shift), 0.0, 0.1);
        let hull = (boxed(DVec3::splat(0.3 * size)), mass);
        let bodies = [scene.add(awake(place * size), [hull])];
        scene.set_velocity(bodies[0], DVec3::X * (speed * size));
        scene.world.bodies[bodies[0]].set_angvel((DVec3::Z * spin).as_vec3(), true);
        let joules = energy(&scene, &bodies, DVec3::ZERO);
        for tick in 0..(1.5 * rate) as u32 {
            scene.step_and_apply(&IDLE);
            let has = energy(&scene, &bodies, DVec3::ZERO);
            // At 30 Hz the box turns by a radian in a tick, and its corners move on arcs.
            let most = if rate < 50.0 { 1.15 } else { 1.05 };
            assert!(
                has < most * joules,
                "size {size}, {rate} Hz, {mass} kg, {spin} rad/s, {shift}, tick {tick}: {joules} J became {has}"
            );
        }
    }
}

/// Velocities of the floor and of all bodies on it, metres a second: at rest, a train, and lifts.
const FRAMES: [DVec3; 4] = [
    DVec3::ZERO,
    DVec3::new(30.0, 0.0, -10.0),
    DVec3::new(0.0, 10.0, 0.0),
    DVec3::new(0.0, -10.0, 0.0),
];

/// A floor, a box on it, and a climber above the box.
fn above_a_box(world: (f64, f64), frame: DVec3, half: DVec3, mass: f64, drop: f64) -> Scene {
    let (size, rate) = world;
    let start = DVec3::Y * (2.0 * half.y + 0.4 + drop);
    let mut scene = Scene::with(ClimberConfig::walker(), size, 1.0 / rate, 9.81, start);
    let floor = boxed(DVec3::new(50.0, 0.5, 50.0) * size).friction(1.0);
    let floor = floor.translation((DVec3::NEG_Y * (0.5 * size)).as_vec3());
    let ground = if frame == DVec3::ZERO {
        RigidBodyBuilder::fixed()
    } else {
        RigidBodyBuilder::kinematic_velocity_based()
    };
    let floor = scene.add(ground, [(floor, 1.0)]);
    let body = awake(DVec3::Y * (half.y * size));
    let hull = boxed(half * size).friction(1.0);
    let body = scene.add(body, [(hull, mass)]);
    for body in [floor, body] {
        scene.set_velocity(body, frame * size);
    }
    scene.throw(DVec3::ZERO, frame * size);
    scene
}

/// The climber's height above the floor that moves with a frame, in its own size, after `ticks`.
fn height(scene: &Scene, (size, rate): (f64, f64), frame: DVec3, ticks: u32) -> f64 {
    scene.climber.state().position.y / size - frame.y * f64::from(ticks) / rate
}

#[test]
fn a_jump_off_a_light_box_on_the_floor_is_as_high_as_off_the_floor() {
    for (world, frame) in pairs(WORLDS, FRAMES) {
        for (half, mass) in [
            ([0.15, 0.15, 0.15], 1.0),
            ([0.3, 0.3, 0.3], 2.0),
            ([0.5, 0.25, 0.5], 1.0),
            ([0.5, 0.5, 0.5], 40.0),
            ([0.5, 0.5, 0.5], 4_000.0),
        ] {
            let half = DVec3::from_array(half);
            let mut scene = above_a_box(world, frame, half, mass, 0.0);
            let told = format!("{world:?}, frame {frame}, {mass} kg");
            let rests = (0.5 * world.1) as u32;
            scene.ticks(rests, &IDLE);
            scene.assert_standing(&told);
            let start = height(&scene, world, frame, rests);
            let mut high = 0.0f64;
            for tick in 0..(0.9 * world.1) as u32 {
                scene.tick(&high_jump(tick == 0));
                high = high.max(height(&scene, world, frame, rests + tick + 1) - start);
            }
            assert!((1.2..1.3).contains(&high), "{told}: {high} m");
        }
    }
}

/// A jump that was asked for shortly before the landing follows it at once.
#[test]
fn a_jump_right_after_a_landing_on_a_box_is_as_high_as_off_the_floor() {
    for (world, frame) in pairs(WORLDS, FRAMES) {
        for (half, mass, drop) in [
            (0.5, 10.0, 0.3),
            (0.5, 40.0, 0.02),
            (0.5, 400.0, 1.0),
            (0.5, 4_000.0, 1.0),
        ] {
            let mut scene = above_a_box(world, frame, DVec3::splat(half), mass, drop);
            let (mut jumps, mut top) = (0, 0.0f64);
            for tick in 0..(1.2 * world.1) as u32 {
                let report = scene.tick(&high_jump(jumps == 0));
                jumps += count(&report.events, |event| *event == ClimberEvent::Jumped);
                if jumps > 0 {
                    top = top.max(height(&scene, world, frame, tick + 1));
                }
            }
            let high = top - 2.0 * half - 0.4;
            let told = format!("{world:?}, frame {frame}, {mass} kg, from {drop} m: {high} m");
            assert!(jumps == 1 && (1.15..1.33).contains(&high), "{told}");
        }
    }
}

/// A jump off a crate that falls with the climber is weaker than off the ground: both get the same momentum.
#[test]
fn a_jump_off_a_crate_that_falls_keeps_the_momentum_of_both() {
    for ((size, rate), mass) in pairs(WORLDS, [40.0, 80.0, 400.0]) {
        let config = ClimberConfig::walker();
        let start = DVec3::Y * 0.9;
        let mut scene = Scene::with(config, size, 1.0 / rate, 9.81, start);
        let body = awake(DVec3::Y * (0.25 * size))
            .gravity_scale(0.0)
            .lock_rotations();
        let deck = (boxed(DVec3::new(1.0, 0.25, 1.0) * size), mass);
        let bodies = [scene.add(body, [deck])];
        // The crate's gravity begins when the climber stands. From then on, the climber has no weight on it.
        for _ in 0..3 {
            scene.step(&IDLE);
            scene.pushes.clear();
        }
        scene.assert_standing("begins to fall");
        scene.world.bodies[bodies[0]].set_gravity_scale(1.0, true);
        scene.ticks((3.0 * rate) as u32, &IDLE);
        scene.assert_standing(&format!("falls: size {size}, {rate} Hz, {mass} kg"));
        let before = scene.climber.state().velocity.y;
        scene.step(&ClimberInput { jump: true, ..IDLE });
        let gained = (scene.climber.state().velocity.y - before) / size;
        let told = format!("size {size}, {rate} Hz, {mass} kg: gained {gained} m/s");
        let jump = scene.climber.config().ground.jump_speed / size;
        let share = jump * mass / (mass + MASS);
        // Gravity adds the speed of a tick's fall with the crate, and of another one in the air.
        let gained = gained + 2.0 * 9.81 / rate;
        assert!((gained - share).abs() < 0.01 * jump, "{told}, not {share}");
        let impulse: f64 = scene.pushes.iter().map(|push| push.impulse.y).sum();
        let given = impulse / size + MASS * share;
        assert!(given.abs() < 0.02 * MASS * jump, "{told}: {impulse} N s");
    }
}

/// The floor holds the plank, so the climber's push does not move it, and must not count as shake.
#[test]
fn who_turns_round_on_a_light_plank_that_is_held_feels_no_shake() {
    for (size, rate) in WORLDS {
        for (mass, is_pushed) in [
            (1.0, true),
            (5.0, true),
            (20.0, true),
            (400.0, true),
            (5.0, false),
        ] {
            let config = ClimberConfig::colossus_climber();
            let mut scene = Scene::with(config, size, 1.0 / rate, 9.81, DVec3::Y * 0.6);
            let floor = scene.world.insert_body(RigidBodyBuilder::fixed());
            let body = awake(DVec3::Y * (0.1 * size));
            let plank = scene.add(body, [(boxed(DVec3::new(3.0, 0.1, 2.0) * size), mass)]);
            let joint = FixedJointBuilder::new().local_anchor1((DVec3::Y * (0.1 * size)).as_vec3());
            scene
                .world
                .insert_impulse_joint(floor, plank, joint.build());
            let mut most = 0.0f64;
            for tick in 0..(4.0 * rate) as u32 {
                let time = f64::from(tick) / rate;
                let is_ahead = time % 1.0 < 0.5;
                let ahead = if is_ahead { DVec3::X } else { DVec3::NEG_X };
                let input = if time < 0.5 { IDLE } else { walk(ahead) };
                scene.step(&input);
                if is_pushed {
                    scene.apply();
                }
                if time > 0.4 {
                    most = most.max(scene.climber.state().shake.length() / size);
                }
            }
            let told = format!("size {size}, {rate} Hz, {mass} kg, pushed {is_pushed}");
            scene.assert_standing(&told);
            assert!(most < 1.0, "{told}: {most} m/s²");
        }
    }
}

/// A blow knocks a climber over on a cart, or it is thrown onto one: the reaction to its braking takes the cart along.
#[test]
fn who_tumbles_on_a_cart_keeps_the_momentum_of_both() {
    for (size, rate) in WORLDS {
        for (mass, cart_speed, speed) in [
            (80.0, 0.0, 6.0),
            (80.0, 6.0, -6.0),
            (20.0, 0.0, 6.0),
            (800.0, -2.0, 5.0),
        ] {
            let config = ClimberConfig {
                tumble: Some(TumbleConfig {
                    restitution: 0.0,
                    ..ClimberConfig::colossus_climber().tumble.unwrap()
                }),
                ..ClimberConfig::walker()
            };
            let mut scene = Scene::with(config, size, 1.0 / rate, 9.81, DVec3::Y * 0.9);
            let body = awake(DVec3::Y * (0.25 * size))
                .enabled_translations(true, false, false)
                .lock_rotations();
            let deck = (boxed(DVec3::new(30.0, 0.25, 9.0) * size), mass);
            let cart = scene.add(body, [deck]);
            let frame = DVec3::X * (cart_speed * size);
            scene.set_velocity(cart, frame);
            scene.throw(frame, frame);
            scene.ticks((0.2 * rate) as u32, &IDLE);
            let told =
                format!("size {size}, {rate} Hz, {mass} kg at {cart_speed} m/s, blow {speed}");
            scene.assert_standing(&told);
            let change = DVec3::X * (speed * size);
            let had = scene.momenta(&[cart]).x + change.x * MASS;
            let rules = StepRules {
                knockback: blow(change),
                ..StepRules::default()
            };
            let report = scene.step_by(&IDLE, &rules);
            scene.apply();
            let fell = report.events.iter().any(is_tumbled);
            assert!(fell, "{told}: {:?}", report.events);
            for tick in 0..(4.0 * rate) as u32 {
                scene.step_and_apply(&IDLE);
                let off = (scene.momenta(&[cart]).x - had).abs();
                let given = MASS * speed.abs() * size;
                assert!(
                    off < 0.02 * given,
                    "{told}, tick {tick}: {off} N s of {given}"
                );
            }
            let apart = scene.climber.state().velocity.x - scene.velocity(cart).x;
            assert!(apart.abs() < 0.05 * size, "{told}: {apart} m/s apart");
        }
    }
}

/// A wedge of 60 degrees on ice slides away below a climber that slides down it.
#[test]
fn who_slides_down_a_free_wedge_gives_it_its_own_momentum() {
    let wedges = [(20.0, 0.0), (80.0, 0.0), (80.0, 0.3), (800.0, 0.3)];
    for ((size, rate), (mass, friction)) in pairs(WORLDS, wedges) {
        let mut config = ClimberConfig::walker();
        config.ground.slide_friction = friction;
        let start = DVec3::new(1.4, 4.2, 0.0);
        let mut scene = Scene::with(config, size, 1.0 / rate, 9.81, start).with_floor();
        let corners = [(0.0, 0.0), (3.0, 0.0), (0.0, 5.2)];
        let points: Vec<Vector> = [-2.0, 2.0]
            .into_iter()
            .flat_map(|z| corners.map(|(x, y)| (DVec3::new(x, y, z) * size).as_vec3()))
            .collect();
        let hull = ColliderBuilder::convex_hull(&points).unwrap().friction(0.0);
        let body = awake(DVec3::ZERO)
            .enabled_translations(true, false, false)
            .lock_rotations();
        let wedge = scene.add(body, [(hull, mass)]);
        let mut slid = 0;
        for tick in 0..(1.5 * rate) as u32 {
            scene.step_and_apply(&IDLE);
            let state = scene.climber.state();
            if state.mode == ClimberMode::Standing {
                break;
            }
            slid += u32::from(state.mode == ClimberMode::Sliding);
            let off = scene.momenta(&[wedge]).x.abs();
            let told = format!(
                "size {size}, {rate} Hz, {mass} kg, friction {friction}, tick {tick}: {} and {} m/s",
                state.velocity.x,
                scene.velocity(wedge).x
            );
            assert!(off < 0.15 * MASS * size, "{told}: {off} N s");
        }
        assert!(
            slid > (0.2 * rate) as u32,
            "size {size}, {rate} Hz: {slid} ticks"
        );
    }
}
