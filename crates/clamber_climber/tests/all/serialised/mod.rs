//! A climber that is saved as JSON and loaded again continues with the same bits, in every mode.
//!
//! This needs `float_roundtrip` of serde_json, which reads numbers as the nearest float.

use clamber_climber::{
    Climber, ClimberConfig, ClimberInput, ClimberMode, CustomMode, Knockback, ModeContext,
    NextMode, StepRules,
};
use clamber_world::ObstacleId;
use glam::DVec3;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::input::IDLE;
use crate::random::scene::Scene;

/// A value after it was written as JSON and read again.
fn copy<T: Serialize + DeserializeOwned>(value: &T) -> T {
    let json = serde_json::to_string(value).unwrap();
    serde_json::from_str(&json).unwrap()
}

/// Number of ticks after which the run is saved and loaded.
const EVERY: u32 = 23;

/// Plays the ticks of one run, and counts how often each mode was restored.
fn run(seed: u64, ticks: u32, restored: &mut [u32; 7]) {
    let mut scene = Scene::new(seed);
    let mut climber = scene.climber();
    let mut other = climber.clone();
    for tick in 0..ticks {
        if tick % EVERY == 0 {
            let state = climber.state();
            // The new climber gets nothing except the JSON.
            other = Climber::new(copy(climber.config()), DVec3::ZERO).unwrap();
            other.restore(copy(state)).unwrap();
            let (a, b) = (state.fingerprint(), other.state().fingerprint());
            assert_eq!(a, b, "seed {seed} tick {tick}: {state:?}");
            let modes = ClimberMode::ALL.iter();
            restored[modes.take_while(|mode| **mode != state.mode).count()] += 1;
        }
        scene.advance();
        let input = scene.input(&climber);
        let report = scene.step(&mut climber, &input);
        let again = scene.step(&mut other, &copy(&input));
        let (a, b) = (climber.state(), other.state());
        let told = format!("seed {seed} tick {tick}: {a:?} {b:?}");
        assert_eq!(a.fingerprint(), b.fingerprint(), "{told}");
        assert_eq!(report, again, "{told}");
    }
}

#[test]
fn a_run_goes_on_with_the_same_bits_in_every_mode() {
    let mut restored = [0; 7];
    for seed in 0..60 {
        run(seed, 300, &mut restored);
    }
    assert!(restored.iter().all(|count| *count >= 5), "{restored:?}");
}

#[test]
fn configurations_keep_every_bit() {
    let mut thirds = ClimberConfig::colossus_climber();
    thirds.gravity = DVec3::new(1.0 / 3.0, -9.81 / 7.0, f64::MIN_POSITIVE);
    thirds.body.mass = 0.1 + 0.2;
    for config in [
        ClimberConfig::walker(),
        ClimberConfig::colossus_climber(),
        thirds,
    ] {
        assert_eq!(copy(&config), config);
        assert!(Climber::new(copy(&config), DVec3::ZERO).is_ok());
    }
}

#[test]
fn inputs_keep_every_bit() {
    let mut rng = fastrand::Rng::with_seed(5);
    for round in 0..1_000 {
        let mut point = |size: f64| {
            let mut one = || size * (rng.f64() - 0.5);
            DVec3::new(one(), one(), one())
        };
        let blow = Knockback {
            velocity: point(20.0),
            damage: point(1.0).x,
            by: (round % 2 == 0).then_some(ObstacleId(u64::MAX - round)),
        };
        let input = ClimberInput {
            walk: point(2.0),
            climb: -point(0.0),
            jump: round % 2 == 0,
            jump_held: round % 7 == 0,
            grip: round % 3 == 0,
            crouch: round % 4 == 0,
            actions: (round as u32).wrapping_mul(0x9e37_79b9),
            aim: point(1e3),
        };
        let read = (copy(&input), copy(&blow));
        let bits = |(input, blow): &(ClimberInput, Knockback)| {
            let vectors = [input.walk, input.climb, blow.velocity, input.aim];
            let bits = vectors.map(|v| v.to_array().map(f64::to_bits));
            let buttons = (input.jump, input.jump_held, input.grip, input.actions);
            (bits, blow.damage.to_bits(), blow.by, buttons)
        };
        assert_eq!(bits(&read), bits(&(input, blow)), "{input:?} {blow:?}");
    }
}

/// A custom mode that rises for a second, and counts the time in its memory.
struct Rise;

impl CustomMode for Rise {
    fn id(&self) -> u16 {
        700
    }

    fn begins(&self, context: &mut ModeContext<'_, '_>) -> bool {
        context.custom_slots()[7] = 1.0;
        context.input().actions == 1 << 31
    }

    fn step(&self, context: &mut ModeContext<'_, '_>) -> NextMode {
        context.custom_slots()[7] -= context.dt();
        if context.custom_slots()[7] <= 0.0 {
            return context.let_go();
        }
        context.move_by(context.input().aim);
        NextMode::Stay
    }
}

#[test]
fn a_custom_mode_continues_with_the_same_bits() {
    let mut climber = Climber::new(ClimberConfig::walker(), DVec3::ZERO).unwrap();
    let rules = StepRules::with_modes(&[&Rise]);
    let input = ClimberInput {
        actions: 1 << 31,
        aim: DVec3::new(0.1, 1.7, -0.3),
        ..IDLE
    };
    let mut rose = 0;
    for tick in 0..90 {
        let mut other = Climber::new(copy(climber.config()), DVec3::ZERO).unwrap();
        other.restore(copy(climber.state())).unwrap();
        let input = if tick < 5 {
            copy(&input)
        } else {
            ClimberInput {
                actions: 0,
                ..input
            }
        };
        climber.step_with(&input, &[], &rules, 1.0 / 60.0).unwrap();
        other.step_with(&input, &[], &rules, 1.0 / 60.0).unwrap();
        let (a, b) = (climber.state(), other.state());
        assert_eq!(a.fingerprint(), b.fingerprint(), "tick {tick}: {a:?} {b:?}");
        rose += u32::from(a.mode == ClimberMode::Custom(700));
    }
    assert!((59..=60).contains(&rose), "{rose}");
}
