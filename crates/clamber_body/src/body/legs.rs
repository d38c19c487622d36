//! Legs that swing below the hips: a second pendulum below the climber's own.

use glam::{DQuat, DVec3};

use super::stance::arc;

/// Length of the pendulum, as a share of the leg's length.
const PENDULUM_LENGTH: f64 = 0.6;

/// Rate at which the swing decays, per second.
const SWING_DAMPING: f64 = 2.5;

/// Longest step of the integrator, seconds.
const INTEGRATION_STEP: f64 = 1.0 / 240.0;

/// Most steps of the integrator in one frame. Longer frames take longer steps.
const MOST_STEPS: f64 = 64.0;

/// Cosine of the largest angle between the legs and the trunk's axis: 60°.
const MAX_SWING_COSINE: f64 = 0.5;

/// The end of the pendulum, its velocity, and the hips from which it hangs, in world space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Legs {
    end: DVec3,
    velocity: DVec3,
    hips: DVec3,
}

impl Legs {
    pub(crate) fn at_rest(hips: DVec3, down: DVec3, velocity: DVec3, leg: f64) -> Self {
        Self {
            end: hips + down * (PENDULUM_LENGTH * leg),
            velocity,
            hips,
        }
    }

    /// Lets the legs swing while the hips move to `hips`. `down` points along the trunk, away from the head.
    pub(crate) fn step(&mut self, hips: DVec3, down: DVec3, gravity: DVec3, leg: f64, dt: f64) {
        let length = PENDULUM_LENGTH * leg;
        let steps = (dt / INTEGRATION_STEP).ceil().clamp(1.0, MOST_STEPS);
        let h = dt / steps;
        if dt > 0.0 {
            let hips_velocity = (hips - self.hips) / dt;
            let kept = libm::exp(-SWING_DAMPING * h);
            for step in 1..=steps as u32 {
                let pivot = self.hips.lerp(hips, f64::from(step) / steps);
                let was = self.end;
                let swing = (self.velocity + gravity * h - hips_velocity) * kept;
                let next = was + (hips_velocity + swing) * h;
                let arm = limited((next - pivot).normalize_or(down), down);
                self.end = pivot + arm * length;
                self.velocity = (self.end - was) / h;
            }
        }
        self.hips = hips;
    }

    /// The legs' rotation relative to the trunk.
    pub(crate) fn turn(&self, down: DVec3) -> DQuat {
        arc(down, (self.end - self.hips).normalize_or(down))
    }
}

fn limited(arm: DVec3, down: DVec3) -> DVec3 {
    let along = arm.dot(down);
    if along >= MAX_SWING_COSINE {
        return arm;
    }
    let across = (arm - down * along).normalize_or(down.any_orthonormal_vector());
    down * MAX_SWING_COSINE + across * (1.0 - MAX_SWING_COSINE * MAX_SWING_COSINE).sqrt()
}
