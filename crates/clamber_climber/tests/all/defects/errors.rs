//! Error messages name the wrong value, and are true of it.

use clamber_climber::{Climber, ClimberConfig, ClimberError, ClimberState};
use clamber_mover::{Mover, MoverBody, MoverMemory};
use clamber_surface::mesh::TriangleId;
use clamber_surface::surface::{Anchor, SkinnedSurface};
use clamber_world::rapier3d::prelude::PhysicsWorld;
use clamber_world::{Debris, DebrisConfig};
use glam::{DVec3, Quat, Vec3};

use crate::cases::pairs;
use crate::input::IDLE;
use crate::numbers::numbers;
use crate::scene::{STONE, cuboid};

/// Numbers of every kind that a range can refuse or accept.
const NUMBERS: [f64; 8] = [
    f64::NEG_INFINITY,
    -1.0,
    -f64::MIN_POSITIVE,
    0.0,
    1.0,
    2.0,
    f64::INFINITY,
    f64::NAN,
];

/// True if a number is in a range that is given in words.
fn holds(range: &str, x: f64) -> bool {
    match range {
        "positive" => x > 0.0,
        "positive and finite" | "longer than 0 s and finite" => x > 0.0 && x.is_finite(),
        "not negative" => x >= 0.0,
        "not negative and finite" => x >= 0.0 && x.is_finite(),
        "from 0 to 1" => (0.0..=1.0).contains(&x),
        "in radians, not negative and finite" => x >= 0.0 && x.is_finite(),
        "in radians, from 0.0175 (one degree) to below 1.5708 (a right angle)" => {
            (1f64.to_radians()..core::f64::consts::FRAC_PI_2).contains(&x)
        }
        "at least 1" => x >= 1.0,
        "at least 1 and finite" => x >= 1.0 && x.is_finite(),
        "1" => x == 1.0,
        // The test's body has a radius of 0.4 m.
        "not negative and less than the radius" => (0.0..0.4).contains(&x),
        "from a thousandth to half of the radius" => (0.0004..=0.2).contains(&x),
        _ => panic!("this test does not know the range {range}"),
    }
}

fn assert_true(told: &str, error: &ClimberError, number: f64) {
    match error {
        ClimberError::OutOfRange { name, range, found } => {
            let is_it = found.to_bits() == number.to_bits();
            assert!(is_it, "{told}: {error}: set to {number}");
            assert!(!holds(range, *found), "{told}: {name} is {range}: {error}");
            assert!(
                error.to_string().contains(&format!("found {found}")),
                "{error}"
            );
        }
        ClimberError::NotFinite(_) => assert!(!number.is_finite(), "{told}: {error}: {number}"),
        other => panic!("{told}: {other}"),
    }
}

type Set<T> = fn(&mut T, f64);

#[test]
fn messages_about_configurations_are_true() {
    let usual = ClimberConfig::colossus_climber();
    let mut refused = 0;
    let mut check = |told: &str, config: ClimberConfig, number: f64| {
        if let Err(error) = Climber::new(config, DVec3::ZERO) {
            refused += 1;
            assert_true(&format!("{told} = {number}"), &error, number);
        }
    };
    for number in NUMBERS {
        let mut config = usual;
        config.gravity = DVec3::new(0.0, number, 0.0);
        check("gravity", config, number);
        for index in 0..numbers(&mut config).len() {
            let mut config = usual;
            let field = numbers(&mut config).swap_remove(index);
            *field.value = number;
            check(field.name, config, number);
        }
    }
    assert!(refused > 200, "{refused}");
}

/// A user that sets degrees reads that radians are expected.
#[test]
fn messages_about_angles_name_radians() {
    let sets: [Set<ClimberConfig>; 2] = [
        |c, x| c.ground.max_slope = x,
        |c, x| c.grip.as_mut().unwrap().max_overhang = x,
    ];
    for (set, number) in pairs(sets, [-50.0, f64::INFINITY]) {
        let mut config = ClimberConfig::colossus_climber();
        set(&mut config, number);
        let text = Climber::new(config, DVec3::ZERO).unwrap_err().to_string();
        assert!(text.contains("radians"), "{number}: {text}");
    }
}

#[test]
fn messages_about_steps_inputs_and_states_are_true() {
    for number in NUMBERS {
        let mut climber = Climber::new(ClimberConfig::colossus_climber(), DVec3::ZERO).unwrap();
        match climber.step(&IDLE, &[], number) {
            Err(error) => assert_true("dt", &error, number),
            Ok(_) => assert!(number > 0.0 && number.is_finite(), "dt {number}"),
        }
        let mut input = IDLE;
        input.walk.x = number;
        match climber.step(&input, &[], 0.1) {
            Err(error) => assert_true("walk", &error, number),
            Ok(_) => assert!(number.is_finite(), "walk {number}"),
        }
        let sets: [Set<ClimberState>; 6] = [
            |state, x| state.stamina = x,
            |state, x| state.hit_points = x,
            |state, x| state.hanging.arm = x,
            |state, x| state.coyote = x,
            |state, x| state.velocity.x = x,
            |state, x| state.heading = DVec3::X * x.abs(),
        ];
        for (index, set) in sets.iter().enumerate() {
            let mut state = *climber.state();
            set(&mut state, number);
            if let Err(error) = climber.restore(state) {
                // For a heading the message has its length, which may underflow.
                let found = match &error {
                    ClimberError::OutOfRange { found, .. } if index == 5 => *found,
                    _ => number,
                };
                assert_true(&format!("state {index}"), &error, found);
            }
        }
    }
}

#[test]
fn messages_about_movers_are_true() {
    for number in NUMBERS {
        let mut memory = MoverMemory::default();
        if let Err(error) = Mover::new(&[], number, &mut memory) {
            assert_true("dt", &error.into(), number);
        }
        for (body, name) in [
            (MoverBody::ball(number, 0.0), "radius"),
            (MoverBody::ball(0.4, number), "margin"),
            (MoverBody::capsule(DVec3::Y * number, 0.4, 0.01), "axis"),
        ] {
            if let Err(error) = body.validate() {
                assert_true(name, &error.into(), number);
            }
        }
    }
}

#[test]
fn messages_about_debris_and_surfaces_are_true() {
    let surface: SkinnedSurface = cuboid(Vec3::ONE, STONE);
    let anchor = Anchor {
        mesh: surface.mesh().id(),
        triangle: TriangleId(0),
        barycentric: [1.0, 0.0, 0.0],
        frame: Quat::IDENTITY,
    };
    for number in NUMBERS {
        let is_tick = number > 0.0 && number.is_finite();
        let mut world = PhysicsWorld::default();
        let mut debris = Debris::new(DebrisConfig::default());
        let found = debris.before_step(&[], &mut world.bodies, &mut world.colliders, number);
        assert_eq!(found.is_ok(), is_tick, "{number}");
        if let Err(error) = found {
            let text = error.to_string();
            let expected = format!("longer than 0 s and finite, found {number} s");
            assert!(text.contains(&expected), "{text}");
        }
        let found = surface.in_model().motion(&anchor, number);
        if let Err(error) = found {
            let text = error.to_string();
            let is_short = number > 0.0 && number.is_finite();
            let expected = if is_short {
                "long enough for velocities that fit in f32"
            } else {
                "positive and finite"
            };
            let expected = format!("the length of a tick must be {expected}, found {number}");
            assert_eq!(text, expected);
        }
    }
}
