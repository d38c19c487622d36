//! What shakes, tires and hurts a climber.

use clamber_world::PointMotion;
use glam::DVec3;

use super::Step;
use crate::shake::{Shake, excess};
use crate::{ClimberEvent, ClimberMode};

/// For how long it grips nothing after its strength was used up, seconds.
const EXHAUSTED: f64 = 1.0;

impl Step<'_> {
    /// Feels how its support moves. What was put elsewhere, or is just found, has no acceleration.
    pub(super) fn feel(&mut self, motion: &PointMotion, was_placed: bool) {
        let change = match self.state.support_velocity {
            Some(before) if !was_placed => motion.velocity - before,
            _ => DVec3::ZERO,
        };
        self.shake_by(change);
        self.state.support_velocity = (!was_placed).then_some(motion.velocity);
    }

    fn shake_by(&mut self, velocity_change: DVec3) {
        let mut shake = Shake {
            acceleration: self.state.shake,
        };
        shake.step(velocity_change, self.config.shake_time, self.dt());
        self.state.shake = shake.acceleration;
    }

    /// Drains or refills stamina, and opens the grip when it is used up.
    pub(super) fn tire(&mut self, shake_before: DVec3) {
        if !self.state.mode.is_supported() {
            self.shake_by(DVec3::ZERO);
        }
        let Some(stamina) = &self.config.stamina else {
            return;
        };
        let dt = self.dt();
        let shakes = [shake_before, self.state.shake].map(|acceleration| Shake { acceleration });
        let beyond = excess(&shakes[0], &shakes[1], stamina.shake_threshold, dt);
        if self.state.mode.is_holding() {
            let spent = stamina.hold_drain * dt + stamina.shake_drain * beyond;
            self.state.stamina = (self.state.stamina - spent).max(0.0);
            if self.state.stamina == 0.0 {
                let shake = self.state.shake.length();
                self.event(ClimberEvent::ShakenOff { shake });
                self.state.open_handed = EXHAUSTED;
                self.leave(ClimberMode::Falling);
            }
        } else if self.state.mode == ClimberMode::Standing && beyond == 0.0 {
            self.state.stamina = (self.state.stamina + stamina.refill * dt).min(1.0);
        }
    }

    /// The ground goes away from under its feet, faster than it falls and than they follow: `was` is its
    /// velocity until then.
    pub(super) fn is_thrown(&mut self, normal: DVec3, was: DVec3) -> bool {
        let pulled = -self.state.shake.dot(normal) - -self.config.gravity.dot(normal);
        let is_thrown = pulled > self.config.ground.throw_acceleration;
        if is_thrown {
            self.event(ClimberEvent::Thrown {
                acceleration: pulled,
            });
            self.state.velocity = was;
            self.leave(ClimberMode::Falling);
        }
        is_thrown
    }

    /// A shake knocks it off its feet.
    pub(super) fn is_knocked_down(&mut self, was: DVec3) -> bool {
        let Some(tumble) = &self.config.tumble else {
            return false;
        };
        let is_knocked = self.state.shake.length() > tumble.knock_acceleration;
        if is_knocked {
            self.state.velocity = was;
            self.tumble();
        }
        is_knocked
    }

    fn tumble(&mut self) {
        self.event(ClimberEvent::Tumbled);
        self.leave(ClimberMode::Tumbling);
    }

    /// What struck it since the last tick.
    pub(super) fn be_struck(&mut self) {
        let Some(blow) = self.input.blow else {
            return;
        };
        self.hurt(blow.damage);
        let knocks = self
            .config
            .tumble
            .is_some_and(|tumble| blow.velocity.length() > tumble.knock_speed);
        if knocks || !self.state.mode.is_supported() {
            self.state.velocity += blow.velocity;
        }
        if knocks && self.state.mode != ClimberMode::Tumbling {
            self.tumble();
        }
    }

    /// After a landing at a speed.
    pub(super) fn hit_the_ground(&mut self, speed: f64) {
        self.hurt_by_fall(speed);
        let falls_over = self
            .config
            .tumble
            .is_some_and(|tumble| speed > tumble.landing_speed);
        if falls_over {
            self.tumble();
        }
    }

    pub(super) fn hurt_by_fall(&mut self, speed: f64) {
        if let Some(health) = &self.config.health {
            self.hurt((speed - health.safe_speed).max(0.0) * health.fall_damage);
        }
    }

    fn hurt(&mut self, damage: f64) {
        if self.config.health.is_some() && damage > 0.0 {
            let damage = damage.min(self.state.hit_points);
            self.state.hit_points -= damage;
            if damage > 0.0 {
                self.event(ClimberEvent::Hurt { damage });
            }
        }
    }
}
