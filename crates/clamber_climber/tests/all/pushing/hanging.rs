//! A climber that holds on to a body, and does not tear it about, however light the body is.

use clamber_climber::{ClimberConfig, ClimberMode, StepRules};
use clamber_world::rapier3d::prelude::{
    RigidBodyBuilder, RigidBodyHandle, SphericalJointBuilder, Vector,
};
use glam::DVec3;

use crate::cases::{pairs, triples};
use crate::input::{HOLD, blow};
use crate::pushing::scene::{FUR, MASS, Scene, cuboid};
use crate::stage::tireless;

/// Gravity, metres a second squared.
const GRAVITY: f64 = 9.81;

/// Size, rate, and the mass of the climber as a multiple of the body's.
const CASES: [(f64, f64, f64); 19] = [
    (1.0, 30.0, 0.01),
    (1.0, 30.0, 0.1),
    (1.0, 30.0, 1.0),
    (1.0, 30.0, 10.0),
    (1.0, 30.0, 100.0),
    (1.0, 60.0, 0.01),
    (1.0, 60.0, 0.3),
    (1.0, 60.0, 1.0),
    (1.0, 60.0, 3.0),
    (1.0, 60.0, 10.0),
    (1.0, 60.0, 100.0),
    (1.0, 240.0, 0.01),
    (1.0, 240.0, 1.0),
    (1.0, 240.0, 10.0),
    (1.0, 240.0, 100.0),
    (0.02, 60.0, 1.0),
    (0.02, 60.0, 10.0),
    (100.0, 60.0, 1.0),
    (100.0, 60.0, 10.0),
];

/// A climber that never tires. If it `hangs`, it hangs from any surface as steep as a wall.
fn climber(hangs: bool) -> ClimberConfig {
    let mut config = tireless();
    let grip = config.grip.as_mut().unwrap();
    if hangs {
        grip.max_overhang = 0.5;
    }
    config
}

/// A box with fur and sides of a metre, at the climber's right.
fn beside_a_box(
    hangs: bool,
    (size, rate, ratio): (f64, f64, f64),
    body: RigidBodyBuilder,
) -> (Scene, RigidBodyHandle) {
    let place = DVec3::new(-0.9, 0.0, 0.0);
    let mut scene = Scene::with(climber(hangs), size, 1.0 / rate, GRAVITY, place);
    let half = (0.5 * size) as f32;
    let fur = cuboid(half, half, half).user_data(FUR);
    let handle = scene.add(body.can_sleep(false), [(fur, MASS / ratio)]);
    scene.world.bodies[handle].wake_up(true);
    (scene, handle)
}

/// Kinetic and potential energy of body and climber at size 1, joules.
fn energies(scene: &Scene, body: RigidBodyHandle, size: f64) -> (f64, f64) {
    let (state, gravity) = (scene.climber.state(), GRAVITY);
    let body = &scene.world.bodies[body];
    let moves = f64::from(body.kinetic_energy()) / (size * size)
        + 0.5 * MASS * (state.velocity / size).length_squared();
    let height = f64::from(body.mass()) * f64::from(body.translation().y) / size
        + MASS * state.position.y / size;
    (moves, height * gravity)
}

#[test]
fn who_holds_a_body_that_falls_falls_as_gravity_lets_both() {
    for (hangs, case, turns) in triples([false, true], CASES, [false, true]) {
        // A light body that turns about the hands of a climber is faster than a common fall.
        if turns && hangs {
            continue;
        }
        let body = RigidBodyBuilder::dynamic();
        let body = if turns { body } else { body.lock_rotations() };
        let (mut scene, body) = beside_a_box(hangs, case, body);
        let (size, rate, _) = case;
        let mut seconds = 0.0;
        for _ in 0..rate as u32 {
            scene.tick(&HOLD);
            seconds += 1.0 / rate;
            let state = scene.climber.state();
            let told = format!("hangs {hangs}, {case:?}, turns {turns}, {seconds} s");
            assert!(state.mode.is_holding(), "{told}: {state:?}");
            let [own, bodys] = [state.velocity, scene.velocity(body)].map(|v| v.length() / size);
            let most = GRAVITY * (1.05 * seconds + 3.0 / rate) + 0.5;
            assert!(own.max(bodys) < most, "{told}: {own} and {bodys} m/s");
        }
    }
}

/// The climber hangs from a body on a rope or from one that falls, and blows set it swinging.
#[test]
fn hanging_from_a_body_makes_no_energy() {
    let plays = [(true, false), (true, true), (false, false)];
    for ((size, rate, ratio), (roped, blows)) in pairs(CASES, plays) {
        let case = (size, rate, ratio);
        let body = RigidBodyBuilder::dynamic().angular_damping(0.2);
        let (mut scene, body) = beside_a_box(true, case, body);
        if roped {
            let up = Vector::new(0.0, (3.5 * size) as f32, 0.0);
            let anchor = scene
                .world
                .insert_body(RigidBodyBuilder::fixed().translation(up));
            let joint = SphericalJointBuilder::new().local_anchor2(up).build();
            scene.world.insert_impulse_joint(anchor, body, joint);
        }
        let told = format!("{case:?}, roped {roped}, blows {blows}");
        let (mut lowest, mut all, mut seen) = (f64::INFINITY, None, 0);
        for tick in 0..(if roped { 6.0 } else { 1.0 } * rate) as u32 {
            let struck = blows && tick % rate as u32 == rate as u32 / 2;
            let mut rules = StepRules::default();
            if struck {
                rules.knockback = blow(DVec3::Z * (1.5 * size));
            }
            let before = scene.climber.state().velocity / size;
            scene.apply();
            scene.step_by(&HOLD, &rules);
            match scene.climber.state().mode {
                ClimberMode::Hanging => {}
                _ if seen == 0 => continue,
                _ => break,
            }
            seen += 1;
            let (moves, height) = energies(&scene, body, size);
            let all = all.get_or_insert(moves + height);
            if struck {
                let after = before + DVec3::Z * 1.5;
                *all += 0.5 * MASS * (after.length_squared() - before.length_squared()).max(0.0);
            }
            lowest = lowest.min(height);
            // A few per cent of the energy from gravity so far, and of a fall of half a metre.
            let slack = 0.06 * (*all - lowest) + 0.5 * MASS * GRAVITY;
            assert!(
                moves + height < *all + slack,
                "{told}, tick {tick}: {moves} + {height} of {all} J"
            );
        }
        assert!(seen > 5, "{told}: {seen}");
    }
}
