//! The bot climbs the giant: in little more than the least time, at every size and tick rate.

#![allow(clippy::unwrap_used, reason = "a test")]

use clamber::climber::ClimberConfig;
use clamber_scenes::climbs::{Climbed, ClimbsOptions, climb_by};
use clamber_scenes::giant;

/// It may take so many times the least time.
const MOST: f64 = 1.3;

fn climb(climber: ClimberConfig, height: f64, rate: f64) -> Climbed {
    let options = ClimbsOptions {
        height,
        rate,
        ..ClimbsOptions::default()
    };
    let climbed = climb_by(climber, &giant::giant().unwrap(), &options).unwrap();
    let ratio = climbed.ratio().unwrap_or(f64::INFINITY);
    assert!(ratio <= MOST, "{height} m, {rate} Hz: {ratio}, {climbed:?}");
    // No plan promises less.
    assert!(ratio > 0.9, "{height} m, {rate} Hz: {ratio}");
    climbed
}

/// A climber so many times as large, in a world so many times as large.
fn scaled(scale: f64) -> ClimberConfig {
    let mut climber = ClimberConfig::colossus_climber();
    climber.gravity *= scale;
    let body = &mut climber.body;
    for length in [
        &mut body.radius,
        &mut body.height,
        &mut body.margin,
        &mut body.push_force,
    ] {
        *length *= scale;
    }
    let ground = &mut climber.ground;
    for length in [
        &mut ground.walk_speed,
        &mut ground.jump_speed,
        &mut ground.snap_distance,
        &mut ground.step_height,
        &mut ground.acceleration,
        &mut ground.air_acceleration,
        &mut ground.throw_acceleration,
    ] {
        *length *= scale;
    }
    let grip = climber.grip.as_mut().unwrap();
    for length in [
        &mut grip.reach,
        &mut grip.climb_speed,
        &mut grip.hang_acceleration,
        &mut grip.jump_speed,
    ] {
        *length *= scale;
    }
    climber.hang.arm_length *= scale;
    climber.hang.leg_length *= scale;
    if let Some(ledge) = &mut climber.ledge {
        for length in [
            &mut ledge.reach_up,
            &mut ledge.reach,
            &mut ledge.drop,
            &mut ledge.shimmy_speed,
        ] {
            *length *= scale;
        }
    }
    if let Some(stamina) = &mut climber.stamina {
        stamina.shake_threshold *= scale;
        stamina.shake_drain /= scale;
    }
    if let Some(tumble) = &mut climber.tumble {
        tumble.knock_acceleration *= scale;
        tumble.knock_speed *= scale;
        tumble.landing_speed *= scale;
    }
    if let Some(health) = &mut climber.health {
        health.safe_speed *= scale;
        health.fall_damage /= scale;
    }
    climber
}

#[test]
fn tall_giants_are_climbed_without_detours() {
    for height in [20.0, 40.0] {
        climb(ClimberConfig::colossus_climber(), height, 60.0);
    }
}

#[test]
fn the_tick_rate_does_not_matter() {
    for rate in [30.0, 120.0] {
        climb(ClimberConfig::colossus_climber(), 20.0, rate);
    }
}

#[test]
fn a_world_of_another_size_is_climbed_alike() {
    let [small, same, large] =
        [0.25, 1.0, 4.0].map(|scale| climb(scaled(scale), 20.0 * scale, 60.0));
    for other in [small, large] {
        assert!((other.least - same.least).abs() < 0.02 * same.least);
        let [a, b] = [&other, &same].map(|climbed| climbed.times[1].unwrap());
        assert!((a - b).abs() < 1.0, "{a} s, but {b} s");
    }
}
