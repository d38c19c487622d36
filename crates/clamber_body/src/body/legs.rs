//! Legs that swing below the hips: a second pendulum below the climber's own.

use glam::{DQuat, DVec3};

use super::stance::arc;

/// Length of the pendulum, as a share of the leg's length.
const LENGTH: f64 = 0.6;

/// Rate at which the swing decays, per second.
const DAMPING: f64 = 2.5;

/// Longest step of the integrator, seconds.
const STEP: f64 = 1.0 / 240.0;

/// Most steps of the integrator in one frame. Longer frames take longer steps.
const MOST_STEPS: f64 = 64.0;

/// Cosine of the largest angle between the legs and the trunk's axis: 60°.
const LIMIT: f64 = 0.5;

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
            end: hips + down * (LENGTH * leg),
            velocity,
            hips,
        }
    }

    /// Lets the legs swing while the hips move to `hips`. `down` points along the trunk, away from the head.
    pub(crate) fn step(&mut self, hips: DVec3, down: DVec3, gravity: DVec3, leg: f64, dt: f64) {
        let length = LENGTH * leg;
        let steps = (dt / STEP).ceil().clamp(1.0, MOST_STEPS);
        let h = dt / steps;
        if dt > 0.0 {
            let hips_velocity = (hips - self.hips) / dt;
            let kept = libm::exp(-DAMPING * h);
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
    if along >= LIMIT {
        return arm;
    }
    let across = (arm - down * along).normalize_or(down.any_orthonormal_vector());
    down * LIMIT + across * (1.0 - LIMIT * LIMIT).sqrt()
}
