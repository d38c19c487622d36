//! By its hands: a pendulum that can only hold on.

use glam::DVec3;

use super::{Carried, Step};
use crate::config::GripConfig;
use crate::mover::Arm;
use crate::pendulum::{Pendulum, PendulumTick};
use crate::planes::Plane;
use crate::{ClimberEvent, ClimberMode};

/// How fast it pulls itself in once its hold is calm, metres a second.
const PULL_SPEED: f64 = 2.0;

/// Below this share of what made it hang, shake is calm.
const CALM: f64 = 0.7;

/// Arms that something stretches beyond their length by this factor let go.
const STRETCH: f64 = 1.5;

/// As close to its hands as this share of its radius, it climbs again.
const CLOSE: f64 = 1.25;

impl Step<'_> {
    pub(super) fn hang(&mut self) {
        let Some(grip) = self.config.grip else {
            self.leave(ClimberMode::Falling);
            return self.fly();
        };
        let was = self.state.velocity;
        let pivot_was = self.state.support_velocity;
        let Some(carried) = self.carry() else {
            self.event(ClimberEvent::LostFooting);
            self.leave(ClimberMode::Falling);
            return self.fly();
        };
        if !self.input.grip {
            self.event(ClimberEvent::Released);
            self.state.open_handed = super::holding::OPEN_HANDED;
            self.state.velocity = was;
            self.leave(ClimberMode::Falling);
            return self.fly();
        }
        let now = carried.motion.velocity;
        let pivot_was = if carried.swept {
            pivot_was.unwrap_or(now)
        } else {
            now
        };
        let relative = if carried.swept {
            was - pivot_was
        } else {
            DVec3::ZERO
        };
        self.reach_or_pull(&carried, &grip);
        self.swing(&carried, pivot_was, relative);
    }

    /// Lets its arms go long, or pulls itself in once it has been calm.
    fn reach_or_pull(&mut self, carried: &Carried, grip: &GripConfig) {
        let leans_over = self.config.slope(carried.support.normal_in_world()) > grip.max_overhang;
        let shakes = self.state.shake.length() > CALM * grip.hang_acceleration;
        let dt = self.dt();
        let is_calm = !shakes && !leans_over;
        self.state.calm = if is_calm { self.state.calm + dt } else { 0.0 };
        if is_calm && self.state.calm >= grip.calm_time {
            let reach = self
                .state
                .position
                .distance(carried.motion.previous_position);
            self.state.arm = (self.state.arm.min(reach) - PULL_SPEED * dt).max(0.0);
        }
    }

    /// Swings below its hands, which moved at `pivot_was` until now; `relative` is its own velocity beyond that.
    pub(super) fn swing(&mut self, carried: &Carried, pivot_was: DVec3, relative: DVec3) {
        let dt = self.dt();
        let hang = &self.config.hang;
        let pivot = carried.motion.position;
        if self.state.calm == 0.0 {
            self.state.arm = hang.arm_length;
        }
        let mut pendulum = Pendulum {
            arm: carried.start - carried.motion.previous_position,
            velocity: relative,
        };
        pendulum.step(&PendulumTick {
            length: self.state.arm.max(self.config.body.radius),
            gravity: self.config.gravity,
            pivot_change: carried.motion.velocity - pivot_was,
            damping: hang.damping,
            dt,
        });
        let legs = pendulum.arm.normalize_or(-self.config.up()) * hang.leg_length;
        let mut path = self.path(carried.start, pivot + pendulum.arm, carried.swept);
        path.axis = [DVec3::ZERO, legs];
        path.arm = Some(Arm {
            pivot,
            length: self.state.arm.max(self.config.body.radius),
        });
        let moved = self.slide_along(&path);
        let velocity = carried.motion.velocity + pendulum.velocity;
        self.settle(carried, moved.position);
        self.state.velocity = if moved.position == path.target {
            velocity
        } else {
            self.stopped(velocity, carried, moved.position - pivot)
        };
        let longest = hang.arm_length.max(self.config.body.radius) * STRETCH;
        if moved.position.distance(pivot) > longest {
            // Something in its way has torn it off.
            self.event(ClimberEvent::LostFooting);
            self.state.open_handed = super::holding::OPEN_HANDED;
            self.leave(ClimberMode::Falling);
            return;
        }
        let close = CLOSE * self.config.body.radius;
        let is_in = moved.position.distance(pivot) <= close;
        if self.state.calm > 0.0 && is_in {
            self.change_to(ClimberMode::Holding);
            self.state.arm = 0.0;
            self.state.calm = 0.0;
        }
    }

    /// A velocity without its parts into what it touches and beyond its arms.
    fn stopped(&self, velocity: DVec3, carried: &Carried, arm: DVec3) -> DVec3 {
        let inward = -arm.normalize_or(DVec3::Y);
        let is_taut = arm.length() >= self.state.arm * (1.0 - 1e-6);
        let taut = is_taut.then(|| Plane {
            normal: inward,
            offset: inward.dot(carried.motion.velocity),
        });
        self.world.stopped(velocity, taut)
    }
}
