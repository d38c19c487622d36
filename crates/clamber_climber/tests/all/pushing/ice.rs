//! Ice: feet that slip neither push their ground nor brace on it, beyond the force of friction.

use clamber_climber::{
    ClimberConfig, ClimberEvent, ClimberInput, ContactQuery, ContactRule, StepRules,
};
use clamber_world::rapier3d::prelude::{RigidBodyBuilder, RigidBodyHandle};
use glam::DVec3;

use crate::cases::pairs;
use crate::input::{IDLE, walk};
use crate::pushing::scene::{MASS, Scene, boxed};

/// Half lengths of the body that the climber stands on, metres.
const FLOE: DVec3 = DVec3::new(30.0, 0.25, 9.0);

/// Sizes of the world, and rates, hertz.
const WORLDS: [(f64, f64); 5] = [
    (1.0, 60.0),
    (1.0, 30.0),
    (1.0, 240.0),
    (0.05, 60.0),
    (50.0, 60.0),
];

type Rule = dyn Fn(&ContactQuery<'_>) -> ContactRule;

/// A scene with a climber at a velocity that comes down to height 0.
fn scene(size: f64, rate: f64, at: DVec3, velocity: DVec3) -> Scene {
    let config = ClimberConfig::walker();
    let mut scene = Scene::with(config, size, 1.0 / rate, 9.81, at);
    scene.throw(velocity * size, DVec3::ZERO);
    scene
}

/// A box that moves along X and Z without turning.
fn add(scene: &mut Scene, size: f64, place: DVec3, half: DVec3, mass: f64) -> RigidBodyHandle {
    let body = RigidBodyBuilder::dynamic()
        .translation((place * size).as_vec3())
        .enabled_translations(true, false, true)
        .lock_rotations()
        .can_sleep(false);
    scene.add(body, [(boxed(half * size), mass)])
}

fn add_fixed(scene: &mut Scene, size: f64, place: DVec3, half: DVec3) {
    let collider = boxed(half * size).translation((place * size).as_vec3());
    scene.world.insert_collider(collider, None);
}

fn add_floor(scene: &mut Scene, size: f64) {
    add_fixed(scene, size, DVec3::NEG_Y * 0.25, FLOE);
}

fn tick(scene: &mut Scene, input: &ClimberInput, rule: &Rule) {
    scene.step_by(input, &StepRules::by(rule));
    scene.apply();
}

#[test]
fn walking_and_sliding_on_a_floe_keep_the_momentum_of_both() {
    for (size, rate) in WORLDS {
        for (mass, friction) in [
            (80.0, 0.5),
            (80.0, 0.1),
            (5.0, 0.5),
            (5.0, 0.0),
            (800.0, 0.3),
        ] {
            for speed in [0.0, 3.0, -6.0] {
                let at = DVec3::Y * 0.45;
                let mut scene = scene(size, rate, at, DVec3::X * speed);
                let floe = add(&mut scene, size, DVec3::NEG_Y * 0.25, FLOE, mass);
                let rule = move |query: &ContactQuery<'_>| query.usual().with_friction(friction);
                let had = MASS * speed * size;
                for count in 0..(4.0 * rate) as u32 {
                    let time = f64::from(count) / rate;
                    let input = if (1.0..1.5).contains(&time) {
                        walk(DVec3::NEG_X)
                    } else {
                        IDLE
                    };
                    tick(&mut scene, &input, &rule);
                    let off = scene.momenta(&[floe]).x - had;
                    let told = format!(
                        "size {size}, {rate} Hz, {mass} kg, friction {friction}, {speed} m/s at {time} s"
                    );
                    assert!(off.abs() < 0.01 * MASS * 3.0 * size, "{told}: {off} N s");
                }
                scene.assert_standing("floe");
                let apart = scene.velocity(floe).x - scene.climber.state().velocity.x;
                let slides = friction == 0.0 || speed == -6.0;
                assert!(
                    slides || apart.abs() < 0.05 * size,
                    "{mass}: {apart} m/s apart"
                );
            }
        }
    }
}

/// Neither a pier that stops the climber nor a crate that it strikes changes the velocity of its ground.
#[test]
fn a_collision_on_a_floe_is_none_of_the_floes() {
    let rule = |query: &ContactQuery<'_>| query.usual().with_friction(0.0);
    for (size, rate) in WORLDS {
        for (crate_mass, is_crate, speed) in [
            (80.0, true, 3.0),
            (5.0, true, 3.0),
            (0.0, false, 3.0),
            (80.0, true, 0.0),
        ] {
            let mut scene = scene(size, rate, DVec3::Y * 0.45, DVec3::X * speed);
            let floe = add(&mut scene, size, DVec3::NEG_Y * 0.25, FLOE, 400.0);
            let place = DVec3::new(2.0, 0.7, 0.0);
            let half = DVec3::new(0.5, 0.6, 0.5);
            let mut bodies = vec![floe];
            if is_crate {
                bodies.push(add(&mut scene, size, place, half, crate_mass));
            } else {
                add_fixed(&mut scene, size, place, half);
            }
            if speed == 0.0 {
                scene.set_velocity(bodies[1], DVec3::NEG_X * (3.0 * size));
            }
            let had = scene.momenta(&bodies).x;
            for _ in 0..(2.0 * rate) as u32 {
                tick(&mut scene, &IDLE, &rule);
            }
            let told = format!("size {size}, {rate} Hz, crate of {crate_mass} kg, {speed} m/s");
            scene.assert_standing(&told);
            let floe = scene.velocity(floe).x / size;
            assert!(floe.abs() < 0.01, "{told}: the floe goes at {floe} m/s");
            let off = scene.momenta(&bodies).x - had;
            assert!(
                !is_crate || off.abs() < 0.01 * MASS * 3.0 * size,
                "{told}: {off}"
            );
            let own = scene.climber.state().velocity.x / size;
            assert!(is_crate || own.abs() < 0.01, "{told}: {own} m/s");
        }
    }
}

/// A box before a wall stops a climber on ice as the wall would, and the climber does not keep a speed that it has
/// lost.
#[test]
fn a_light_box_before_a_wall_stops_who_slides() {
    for (size, rate) in WORLDS {
        for (mass, friction, speed) in [
            (1.0, 0.5, 0.0),
            (20.0, 0.5, 0.0),
            (1.0, 0.0, 2.9),
            (0.1, 0.2, 2.9),
        ] {
            let mut scene = scene(size, rate, DVec3::Y * 0.45, DVec3::X * speed);
            add_floor(&mut scene, size);
            let half = DVec3::new(0.5, 0.6, 0.5);
            add(&mut scene, size, DVec3::new(1.5, 0.7, 0.0), half, mass);
            add_fixed(&mut scene, size, DVec3::new(2.5, 0.7, 0.0), half);
            let rule = move |query: &ContactQuery<'_>| query.usual().with_friction(friction);
            let input = if speed == 0.0 { walk(DVec3::X) } else { IDLE };
            for _ in 0..(1.5 * rate) as u32 {
                tick(&mut scene, &input, &rule);
            }
            let own = scene.climber.state().velocity.x / size;
            let gained = 15.0 * friction / rate;
            let told = format!("size {size}, {rate} Hz, {mass} kg, friction {friction}: {own} m/s");
            scene.assert_standing(&told);
            assert!(own.abs() < 0.02 + gained, "{told}");
        }
    }
}

/// A climber that walks from a cart onto ice slides on at the cart's speed.
#[test]
fn who_walks_from_a_cart_onto_ice_slides_on() {
    for (size, rate) in WORLDS {
        let mut scene = scene(size, rate, DVec3::new(-4.0, 0.45, 0.0), DVec3::X * 5.0);
        let body = RigidBodyBuilder::kinematic_velocity_based()
            .translation((DVec3::new(-5.0, -0.25, 0.0) * size).as_vec3())
            .can_sleep(false);
        // The cart goes on above the ice, whose top is a centimetre lower.
        let cart = scene.add(body, [(boxed(DVec3::new(4.0, 0.25, 2.0) * size), 1.0)]);
        scene.set_velocity(cart, DVec3::X * (5.0 * size));
        let half = DVec3::new(25.0, 0.25, 9.0);
        add_fixed(&mut scene, size, DVec3::new(26.0, -0.26, 0.0), half);
        let ice = move |query: &ContactQuery<'_>| {
            let is_ice = query.contact.point.y < -0.005 * size;
            query.usual().with_friction(if is_ice { 0.0 } else { 1.0 })
        };
        let (mut on_ice, mut slowest) = (0, f64::INFINITY);
        for _ in 0..(1.6 * rate) as u32 {
            tick(&mut scene, &walk(DVec3::X), &ice);
            let state = scene.climber.state();
            if state.position.x > 2.0 * size {
                on_ice += 1;
                slowest = slowest.min(state.velocity.x / size);
            }
        }
        let told = format!("size {size}, {rate} Hz: {slowest} m/s in {on_ice} ticks");
        assert!(on_ice > (0.1 * rate) as u32 && slowest > 4.8, "{told}");
    }
}

/// Feet on ice do not brake a collision: both go on at one speed, as in the air.
#[test]
fn who_slides_on_ice_into_a_crate_shares_its_momentum() {
    let rule = |query: &ContactQuery<'_>| query.usual().with_friction(0.0);
    for ((size, rate), mass) in pairs(WORLDS, [1.0, 20.0, 80.0, 400.0]) {
        let mut scene = scene(size, rate, DVec3::Y * 0.405, DVec3::X * 2.9);
        add_floor(&mut scene, size);
        let (place, half) = (DVec3::new(2.0, 0.45, 0.0), DVec3::splat(0.4));
        let bodies = [add(&mut scene, size, place, half, mass)];
        for count in 0..(3.0 * rate) as u32 {
            tick(&mut scene, &IDLE, &rule);
            let has = scene.momenta(&bodies).x / (MASS * 2.9 * size);
            let told = format!("size {size}, {rate} Hz, {mass} kg, tick {count}: {has}");
            assert!((has - 1.0).abs() < 0.01, "{told}");
        }
        let apart = scene.velocity(bodies[0]).x - scene.climber.state().velocity.x;
        scene.assert_standing(&format!("size {size}, {rate} Hz, {mass} kg"));
        assert!(apart.abs() < 0.02 * size, "{mass} kg: {apart} m/s apart");
    }
}

/// Ice tilts until it is too steep to stand on. The climber keeps the speed at which it slides.
#[test]
fn who_slides_on_ice_that_tilts_keeps_its_speed() {
    let rule = |query: &ContactQuery<'_>| query.usual().with_friction(0.0);
    for (size, rate) in WORLDS {
        let mut scene = scene(size, rate, DVec3::new(-4.0, 0.405, 0.0), DVec3::X * 6.0);
        let plate = RigidBodyBuilder::kinematic_velocity_based().can_sleep(false);
        let low = DVec3::NEG_Y * (0.25 * size);
        let collider = boxed(FLOE * size).translation(low.as_vec3());
        let plate = scene.world.insert_body(plate);
        scene.world.insert_collider(collider, Some(plate));
        scene.world.detect_collisions(&(), &());
        let mut slipped = false;
        for count in 0..(1.5 * rate) as u32 {
            if f64::from(count) > 0.3 * rate {
                scene.world.bodies[plate].set_angvel((DVec3::X * 2.0).as_vec3(), true);
            }
            let before = scene.climber.state().velocity;
            let report = scene.step_by(&IDLE, &StepRules::by(&rule));
            if report.events.contains(&ClimberEvent::Slipped) {
                let lost = (scene.climber.state().velocity - before).length() / size;
                let told = format!("size {size}, {rate} Hz: {lost} m/s");
                assert!(lost < 0.5 + 2.0 * 9.81 / rate, "{told}");
                slipped = true;
            }
        }
        assert!(slipped, "size {size}, {rate} Hz");
    }
}
