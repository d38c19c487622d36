//! The bot climbs the giant in little more than the least time, at every size and tick rate.

#![allow(clippy::unwrap_used, reason = "a test")]

#[path = "../examples/climbs/bot.rs"]
mod bot;
#[path = "../examples/climbs/stage.rs"]
mod stage;

use bot::{ClimbOptions, Climbed, climb_by};
use clamber::climber::ClimberConfig;
use clamber_scenes::giant;

/// Largest ratio of the bot's time to the least time.
const MOST: f64 = 1.3;

/// Climbs a giant with a climber, both scaled by `size`. Times scale with √size.
fn climb(size: f64, height: f64, rate: f64) -> Climbed {
    let root = size.sqrt();
    let options = ClimbOptions {
        height: height * size,
        rate: rate / root,
        seconds: 120.0 * root,
        moving: false,
        forecast: false,
    };
    let climber = ClimberConfig::colossus_climber().scaled(size);
    let climbed = climb_by(climber, &giant::giant().unwrap(), &options).unwrap();
    let ratio = climbed.ratio().unwrap_or(f64::INFINITY);
    let told = format!("size {size}, {height} m, {rate} Hz");
    assert!(ratio <= MOST, "{told}: {ratio}, {climbed:?}");
    // The least time is a lower bound: no climb is more than a tenth faster.
    assert!(ratio > 0.9, "{told}: {ratio}");
    climbed
}

#[test]
fn tall_giants_are_climbed_without_detours() {
    for height in [20.0, 40.0] {
        climb(1.0, height, 60.0);
    }
}

#[test]
fn the_tick_rate_does_not_matter() {
    for rate in [30.0, 120.0] {
        climb(1.0, 20.0, rate);
    }
}

#[test]
fn a_climber_and_a_giant_of_another_size_climb_alike() {
    let [small, same, large] = [0.25f64, 1.0, 4.0].map(|size| {
        let climbed = climb(size, 20.0, 60.0);
        [climbed.least, climbed.times[1].unwrap()].map(|time| time / size.sqrt())
    });
    for other in [small, large] {
        assert!((other[0] - same[0]).abs() < 0.02 * same[0]);
        let [a, b] = [other[1], same[1]];
        assert!((a - b).abs() < 1.0, "{a} s, but {b} s");
    }
}
