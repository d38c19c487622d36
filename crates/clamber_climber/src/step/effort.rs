//! Blows, shakes, stamina and damage.

use clamber_mover::MoverContact;
use clamber_world::{ObstacleId, PointMotion};
use glam::DVec3;

use super::air::nearest_between;
use super::holding::GRIP_COOLDOWN;
use super::{NextMode, Tick};
use crate::config::StaminaConfig;
use crate::{ClimberEvent, ClimberMode, Shake};

/// Time for which the climber grips nothing after its stamina was used up, seconds.
const EXHAUSTED_TIME: f64 = 1.0;

impl Tick<'_> {
    /// Applies the blow that struck the climber since the last tick.
    ///
    /// A blow faster than the knock speed knocks the climber over, if it can tumble. For other blows:
    ///
    /// - In the air, while sliding or tumbling, and in a custom mode, the blow's velocity is added.
    /// - A standing climber slides along the ground until friction has braked it, or is lifted off if the blow points
    ///   away from the ground.
    /// - A blow faster than a jump off a hold takes a climber off its hold or ledge. A slower one makes it swing from
    ///   its hold, and does nothing to a climber that hangs from a ledge.
    pub(super) fn be_struck(&mut self) {
        let Some(blow) = self.judge.rules.knockback else {
            return;
        };
        self.hurt(blow.damage);
        let speed = blow.velocity.length();
        let mode = self.state.mode;
        let knocks = self.config.tumble.map(|tumble| speed > tumble.knock_speed);
        let takes_off = mode.is_holding() && speed > self.holds_against();
        if knocks == Some(true) {
            self.state.velocity = self.off_the_ground(self.state.velocity) + blow.velocity;
            if mode != ClimberMode::Tumbling {
                let next = self.begin_tumbling(blow.by);
                self.follow_at_once(next);
            }
        } else if takes_off {
            self.state.velocity += blow.velocity;
            let next = self.be_knocked_off();
            self.follow_at_once(next);
        } else if mode.is_supported() {
            self.struck = blow.velocity;
            if mode == ClimberMode::Standing || mode == ClimberMode::Hanging {
                self.state.velocity += blow.velocity;
            }
            self.state.standing.shoved |=
                mode == ClimberMode::Standing && blow.velocity != DVec3::ZERO;
        } else {
            self.state.velocity += blow.velocity;
        }
        self.before.velocity = self.state.velocity;
    }

    /// A velocity without its component into the ground underfoot, so that a climber that is knocked over while it
    /// walks onto the edge of a step does not bounce off it.
    fn off_the_ground(&self, velocity: DVec3) -> DVec3 {
        let Some(support) = self.state.support else {
            return velocity;
        };
        let normal = support.normal_in_world();
        let into = (velocity - self.state.base_velocity).dot(normal).min(0.0);
        velocity - normal * into
    }

    /// Speed of the fastest blow that does not take the climber off its hold, metres a second.
    fn holds_against(&self) -> f64 {
        let grip = self.config.grip;
        grip.map_or(self.config.ground.jump_speed, |grip| grip.jump_speed)
    }

    fn follow_at_once(&mut self, next: NextMode) {
        if let NextMode::Change(mode) = next {
            self.change_to(mode);
        }
    }

    /// Leaves the support because of a blow, with the climber's current velocity.
    pub(super) fn be_knocked_off(&mut self) -> NextMode {
        let by = self.judge.rules.knockback.and_then(|blow| blow.by);
        if let Some(from) = self.attachment() {
            self.event(ClimberEvent::KnockedOff { from, by });
        }
        self.leave(ClimberMode::Falling)
    }

    /// Updates the shake from the motion of the support. A support that was teleported, or whose last velocity is not
    /// known, adds no acceleration.
    pub(super) fn feel(&mut self, motion: &PointMotion, was_placed: bool) {
        let before = self.state.support_velocity.filter(|_| !was_placed);
        // The climber's own push has moved a free support as expected, a held support not at all, and others in
        // between.
        self.support_change = before.map(|before| {
            let expected = nearest_between(before, self.before.base_velocity, motion.velocity);
            motion.velocity - expected
        });
        self.shake_by(self.support_change.unwrap_or(DVec3::ZERO));
        self.state.support_velocity = (!was_placed).then_some(motion.velocity);
    }

    fn shake_by(&mut self, velocity_change: DVec3) {
        let mut shake = Shake {
            acceleration: self.state.shake,
        };
        shake.step(velocity_change, self.config.shake_time, self.dt());
        self.state.shake = shake.acceleration;
    }

    /// Spends stamina on a single effort. False if stamina does not suffice; none is spent then.
    pub(super) fn spend(&mut self, cost: impl Fn(&StaminaConfig) -> f64) -> bool {
        let Some(stamina) = &self.config.stamina else {
            return true;
        };
        let left = self.state.stamina - cost(stamina);
        if left < 0.0 {
            return false;
        }
        self.state.stamina = left;
        true
    }

    /// True if hands in flight can hold a contact: it does not pass them too fast, and stamina suffices. A catch costs
    /// stamina by its speed; up to the walking speed, it is free.
    pub(super) fn catches(&mut self, touch: &MoverContact, fastest: f64) -> bool {
        // The speed is taken before contacts: whether the tick ends in a contact is chance.
        let velocity = self.motion.flew_at.unwrap_or(self.state.velocity);
        let speed = (velocity - self.mover.velocity_of(touch)).length();
        let hard = (speed - self.config.ground.walk_speed).max(0.0);
        if speed <= fastest && self.spend(|stamina| stamina.catch_cost * hard) {
            return true;
        }
        self.state.grip_cooldown = GRIP_COOLDOWN;
        self.event(ClimberEvent::HandsSlipped {
            obstacle: touch.obstacle,
            speed,
        });
        false
    }

    /// Drains or refills stamina, and opens the grip when stamina is used up.
    pub(super) fn update_stamina(&mut self, shake_before: DVec3) {
        if !self.state.mode.is_supported() {
            self.shake_by(DVec3::ZERO);
        }
        let Some(stamina) = &self.config.stamina else {
            return;
        };
        let dt = self.dt();
        let [before, after] =
            [shake_before, self.state.shake].map(|acceleration| Shake { acceleration });
        let beyond = after.excess(&before, stamina.shake_threshold, dt);
        if self.state.mode.is_holding() {
            // Arms that draw the body up cost as much as climbing over the same distance.
            let climb_speed = self.config.grip.map_or(0.0, |grip| grip.climb_speed);
            let drawing = if climb_speed > 0.0 {
                self.drawn_up / climb_speed
            } else {
                0.0
            };
            let spent = stamina.hold_drain * (dt + drawing) + stamina.shake_drain * beyond;
            self.state.stamina = (self.state.stamina - spent).max(0.0);
            if self.state.stamina == 0.0 {
                self.be_shaken_off();
            }
        } else if self.state.mode == ClimberMode::Standing && beyond == 0.0 {
            self.state.stamina = (self.state.stamina + stamina.refill * dt).min(1.0);
        }
    }

    fn be_shaken_off(&mut self) {
        let shake = self.state.shake.length();
        if let Some(from) = self.attachment() {
            self.event(ClimberEvent::ShakenOff { shake, from });
        }
        self.state.grip_cooldown = EXHAUSTED_TIME;
        let next = self.leave(ClimberMode::Falling);
        self.follow_at_once(next);
    }

    /// Throws the climber off if the ground accelerates away from its feet by more than the threshold beyond gravity.
    pub(super) fn be_thrown(&mut self, normal: DVec3) -> Option<NextMode> {
        let acceleration = -self.state.shake.dot(normal) - -self.config.gravity.dot(normal);
        if acceleration <= self.config.ground.throw_acceleration {
            return None;
        }
        if let Some(from) = self.attachment() {
            self.event(ClimberEvent::Thrown { acceleration, from });
        }
        self.state.velocity = self.before.velocity;
        Some(self.leave(ClimberMode::Falling))
    }

    /// Knocks the climber over if the ground shakes too hard.
    pub(super) fn be_knocked_down(&mut self) -> Option<NextMode> {
        let tumble = self.config.tumble?;
        if self.state.shake.length() <= tumble.knock_acceleration {
            return None;
        }
        self.state.velocity = self.before.velocity;
        Some(self.begin_tumbling(None))
    }

    pub(super) fn begin_tumbling(&mut self, by: Option<ObstacleId>) -> NextMode {
        let from = self.attachment();
        self.event(ClimberEvent::Tumbled { from, by });
        self.leave(ClimberMode::Tumbling)
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
