//! A climber of another size moves in the same way under the same gravity, in √size times the time.

mod play;
mod scenes;

use clamber_climber::{Climber, ClimberConfig};
use glam::DVec3;

use crate::cases::pairs;
use crate::numbers::{Unit, numbers};
use play::play;
use scenes::{person, scenes};

/// Sizes of the climber, relative to the usual one.
const SIZES: [f64; 4] = [0.02, 0.1, 10.0, 100.0];

/// Largest difference that counts as rounding, relative to the usual size: skin is in f32.
const ROUNDING: f64 = 1e-6;

#[test]
fn every_number_scales_by_its_unit() {
    for (size, mut config) in pairs(SIZES, [person(), ClimberConfig::walker()]) {
        let mut scaled = config.scaled(size);
        assert_eq!(scaled.gravity, config.gravity);
        assert_eq!(scaled.body.others, config.body.others);
        for (before, after) in numbers(&mut config).iter().zip(numbers(&mut scaled)) {
            let Unit { metres, seconds } = before.unit;
            let power = f64::from(metres) + 0.5 * f64::from(seconds);
            let due = *before.value * libm::pow(size, power);
            let told = format!(
                "size {size}, {}: {} became {}",
                before.name, before.value, after.value
            );
            assert!(
                (*after.value - due).abs() <= 1e-14 * due,
                "{told}, not {due}"
            );
        }
    }
}

#[test]
fn scenes_are_played_alike_at_every_size() {
    for rate in [30.0, 60.0, 240.0] {
        for scene in scenes() {
            let usual = play(&scene, scene.person(), 1.0, rate);
            let told = format!("{}, {rate} Hz", scene.name);
            assert!(
                usual.iter().any(|seen| seen.mode == scene.shows),
                "{told}: never {:?}",
                scene.shows
            );
            for size in SIZES {
                let other = play(&scene, scene.person().scaled(size), size, rate);
                for (index, (a, b)) in usual.iter().zip(&other).enumerate() {
                    let apart = a.apart(b);
                    assert!(
                        apart <= ROUNDING,
                        "{told}, size {size}, tick {index}: {apart}\n{a:?}\n{b:?}"
                    );
                }
            }
        }
    }
}

/// Otherwise playing would not find a number that does not scale.
#[test]
fn every_number_matters_in_a_scene() {
    // These numbers only have an effect on obstacles that can be pushed.
    let unfelt = ["BodyConfig::mass", "BodyConfig::push_force"];
    let usual: Vec<_> = scenes()
        .iter()
        .map(|scene| play(scene, scene.person(), 1.0, 30.0))
        .collect();
    let count = numbers(&mut person()).len();
    let mut missing = Vec::new();
    for index in 0..count {
        let name = numbers(&mut person())[index].name;
        let matters = [0.8, 1.25].into_iter().any(|factor| {
            scenes().iter().zip(&usual).any(|(scene, usual)| {
                let mut config = scene.person();
                *numbers(&mut config)[index].value *= factor;
                let other = play(scene, config, 1.0, 30.0);
                usual
                    .iter()
                    .zip(&other)
                    .any(|(a, b)| a.apart(b) > 100.0 * ROUNDING)
            })
        });
        if matters == unfelt.contains(&name) {
            missing.push(name);
        }
    }
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn the_result_of_a_size_out_of_range_is_refused() {
    let sizes = [0.0, -0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    for (size, config) in pairs(sizes, [person(), ClimberConfig::walker()]) {
        let refused = Climber::new(config.scaled(size), DVec3::ZERO);
        assert!(refused.is_err(), "size {size}");
        let mut climber = Climber::new(config, DVec3::ZERO).unwrap();
        assert!(
            climber.set_config(config.scaled(size)).is_err(),
            "size {size}"
        );
        assert_eq!(*climber.config(), config);
    }
}

#[test]
fn what_is_accepted_at_one_size_is_accepted_at_any_other() {
    let mut rng = fastrand::Rng::with_seed(3);
    for round in 0..10_000 {
        let mut config = person();
        config.body.radius = 0.01 + rng.f64();
        // The ends of the margin's range.
        let share = [1e-3, 0.5][round % 2];
        config.body.margin = config.body.radius * share;
        let infinite = &mut config.tumble.as_mut().unwrap().knock_speed;
        *infinite = f64::INFINITY;
        assert!(Climber::new(config, DVec3::ZERO).is_ok());
        let size = libm::pow(10.0, 8.0 * rng.f64() - 4.0);
        let scaled = Climber::new(config.scaled(size), DVec3::ZERO);
        assert!(scaled.is_ok(), "{size}: {scaled:?}");
        let back = config.scaled(size).scaled(1.0 / size);
        assert!((back.ground.walk_speed - config.ground.walk_speed).abs() < 1e-14 * 3.0);
    }
}
