//! Configurations with every number drawn at random, including the ends of its range.

use clamber_climber::{
    BodyConfig, ClimberConfig, GripConfig, GroundConfig, HangConfig, HealthConfig, LedgeConfig,
    Others, StaminaConfig, TumbleConfig,
};
use glam::DVec3;

/// A number of any magnitude between two, or sometimes zero.
fn any(rng: &mut fastrand::Rng, low: f64, high: f64) -> f64 {
    if rng.u8(0..10) == 0 {
        0.0
    } else {
        some(rng, low, high)
    }
}

/// A number of any magnitude between two.
fn some(rng: &mut fastrand::Rng, low: f64, high: f64) -> f64 {
    low * libm::pow(high / low, rng.f64())
}

/// A limit, which may be infinite.
fn limit(rng: &mut fastrand::Rng, low: f64, high: f64) -> f64 {
    if rng.u8(0..6) == 0 {
        f64::INFINITY
    } else {
        any(rng, low, high)
    }
}

/// Draws a configuration. Lengths are of the order of the radius, and speeds of the order that a body of this size has
/// under its gravity.
pub(crate) fn config(rng: &mut fastrand::Rng) -> ClimberConfig {
    let radius = some(rng, 0.05, 2.0);
    let gravity = some(rng, 2.0, 30.0);
    let speed = libm::sqrt(gravity * radius);
    ClimberConfig {
        gravity: DVec3::NEG_Y * gravity,
        shake_time: some(rng, 0.02, 0.5),
        body: BodyConfig {
            radius,
            height: any(rng, 0.1 * radius, 4.0 * radius),
            margin: some(rng, 1e-3 * radius, 0.5 * radius),
            mass: some(rng, 1.0, 1_000.0),
            push_force: any(rng, 1.0, 1_000.0),
            others: [Others::Block, Others::Push, Others::Pass][rng.usize(0..3)],
        },
        ground: GroundConfig {
            max_slope: some(rng, 0.02, 1.5),
            walk_speed: any(rng, 0.05 * speed, 5.0 * speed),
            jump_speed: any(rng, 0.05 * speed, 5.0 * speed),
            snap_distance: any(rng, 0.01 * radius, radius),
            step_height: any(rng, 0.01 * radius, radius),
            coyote_time: any(rng, 0.01, 0.5),
            jump_buffer: any(rng, 0.01, 0.5),
            acceleration: any(rng, gravity, 300.0 * gravity),
            friction: any(rng, 0.1 * gravity, 10.0 * gravity),
            air_acceleration: any(rng, 0.1 * gravity, 10.0 * gravity),
            terminal_speed: some(rng, 5.0 * speed, 100.0 * speed),
            slide_friction: any(rng, 0.01, 5.0),
            jump_release_gravity: some(rng, 1.0, 5.0),
            throw_acceleration: limit(rng, 0.1 * gravity, 10.0 * gravity),
        },
        grip: Some(GripConfig {
            reach: any(rng, 0.02 * radius, 2.0 * radius),
            climb_speed: any(rng, 0.05 * speed, 2.0 * speed),
            max_overhang: some(rng, 0.1, core::f64::consts::PI),
            hang_acceleration: limit(rng, 0.1 * gravity, 10.0 * gravity),
            calm_time: any(rng, 0.01, 2.0),
            jump_speed: any(rng, 0.05 * speed, 5.0 * speed),
            catch_speed: limit(rng, 0.1 * speed, 20.0 * speed),
        }),
        hang: HangConfig {
            arm_length: some(rng, 0.1 * radius, 5.0 * radius),
            leg_length: any(rng, 0.1 * radius, 4.0 * radius),
            damping: any(rng, 0.01, 10.0),
        },
        ledge: Some(LedgeConfig {
            reach_up: any(rng, 0.3 * radius, 4.0 * radius),
            reach: any(rng, 0.02 * radius, 2.0 * radius),
            drop: any(rng, 0.1 * radius, 3.0 * radius),
            shimmy_speed: any(rng, 0.05 * speed, 2.0 * speed),
            pull_up_time: some(rng, 0.003, 3.0),
            catch_speed: limit(rng, 0.1 * speed, 20.0 * speed),
        }),
        stamina: rng.bool().then(|| StaminaConfig {
            hold_drain: any(rng, 1e-3, 0.2),
            shake_threshold: any(rng, 0.1 * gravity, gravity),
            shake_drain: any(rng, 1e-3, 0.1),
            refill: any(rng, 0.01, 1.0),
            jump_cost: any(rng, 1e-3, 0.5),
            catch_cost: any(rng, 1e-4, 0.1),
            mantle_cost: any(rng, 1e-3, 0.5),
        }),
        tumble: rng.bool().then(|| TumbleConfig {
            knock_acceleration: limit(rng, gravity, 10.0 * gravity),
            knock_speed: limit(rng, 0.1 * speed, 5.0 * speed),
            landing_speed: limit(rng, 0.1 * speed, 10.0 * speed),
            friction: any(rng, 0.01, 3.0),
            restitution: rng.f64(),
            recover_time: any(rng, 0.01, 2.0),
        }),
        health: rng.bool().then(|| HealthConfig {
            safe_speed: limit(rng, speed, 10.0 * speed),
            fall_damage: any(rng, 1e-3, 1.0),
        }),
    }
}
