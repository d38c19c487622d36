//! Weight on the support, and the reaction to every push and to every change of the climber's own velocity, if the
//! support can be pushed.

use clamber_mover::MoverContact;
use clamber_world::{Attachment, MaterialPoint, ObstacleId};
use glam::DVec3;

use super::Tick;
use super::carrying::Carried;
use crate::ClimberMode;
use crate::event::Push;

/// Acceleration of a support, as a multiple of gravity, up to which it carries all of the climber's weight. From twice
/// this on, its whole acceleration counts. Physics engines let bodies at rest jitter by a part of this.
pub(super) const SUPPORT_JITTER: f64 = 0.03;

/// Largest square of the angle, radians, by which a light hold may swing in a tick under the pull of the arms. A hold
/// that would swing farther gets less of the pull. At twice this value, the pull, which lags behind by a tick, drives
/// the swing.
const MAX_HOLD_SWING: f64 = 0.15;

impl Tick<'_> {
    /// Gives the climber's support the reaction to an impulse, if the support can be pushed. Without the reaction, a
    /// passenger would drive its cart by pushing against the cart's wall.
    pub(super) fn brace_against(&mut self, impulse: DVec3) {
        if impulse == DVec3::ZERO {
            return;
        }
        if let Some(carried) = self.carried {
            self.push_support(&carried.support.attachment, -impulse);
        }
    }

    /// Gives the support the reaction to a jump off it: all of the momentum that the climber takes along. A light
    /// support that another object holds up passes the rest on to that object: feet give the support no more speed than
    /// the climber gets.
    pub(super) fn push_off(&mut self) {
        let Some(attachment) = self.attachment() else {
            return;
        };
        let change = self.state.velocity - self.rides;
        let relative = self.response_of(&attachment, change) * self.config.body.mass;
        let held = self.is_held_up();
        let share = held * (1.0 / relative).min(1.0) + (1.0 - held);
        self.push_support(&attachment, -change * (self.config.body.mass * share));
    }

    /// Share of its jump speed that the climber gets. Off a support that another object holds up, it gets all of it;
    /// off a support that falls freely, the share that the two masses leave it.
    pub(super) fn jump_share(&self) -> f64 {
        let held = self.is_held_up();
        held + (1.0 - held) / (1.0 + self.relative(self.config.up()))
    }

    /// The climber's mass as a multiple of its support's, for impulses in a direction. 0 if the support cannot be
    /// pushed.
    pub(super) fn relative(&self, direction: DVec3) -> f64 {
        self.attachment().map_or(0.0, |attachment| {
            self.response_of(&attachment, direction) * self.config.body.mass
        })
    }

    /// Share of the ground's weight that another object holds up: 1 if it holds all of it, 0 if the ground and the
    /// climber fall freely. 1 in the tick after a hit, when it is not known yet how far the ground gives way.
    fn is_held_up(&self) -> f64 {
        if self.state.mode != ClimberMode::Standing {
            return 0.0;
        }
        let sinks = self.support_change.map_or(0.0, |change| self.sinks(change));
        let load = self.state.load;
        let relative = self.relative(self.config.gravity);
        // After a landing, the climber has not given any weight yet.
        let held = if load == 0.0 {
            1.0 - sinks
        } else {
            (1.0 - sinks + load * relative) / (1.0 + relative)
        };
        held.clamp(0.0, 1.0)
    }

    /// Acceleration of the support along gravity, in multiples of gravity, without a solver's possible jitter.
    fn sinks(&self, change: DVec3) -> f64 {
        let gravity = self.config.gravity;
        without_jitter(change.dot(gravity) / (gravity.length_squared() * self.dt()))
    }

    /// Brakes the climber's velocity `along` a contact, relative to the contact, by at most `braked`, and gives the
    /// contact the reaction. The braking ends when both have the same speed. Returns the speed that is left.
    pub(super) fn rub(&mut self, touch: &MoverContact, along: DVec3, braked: f64) -> f64 {
        let way = along.normalize_or_zero();
        let mass = self.config.body.mass;
        let response = self.response_at(touch, way);
        let speed = along.length();
        let most = speed / (1.0 + response * mass);
        let left = speed - braked.min(most);
        let change = way * left - along;
        self.change_against(touch, change);
        left
    }

    /// Changes the climber's velocity against a contact, which gets the reaction.
    fn change_against(&mut self, touch: &MoverContact, change: DVec3) {
        self.state.velocity += change;
        self.rides += change;
        if self.response_at(touch, change.normalize_or_zero()) > 0.0 {
            self.push(Push {
                obstacle: touch.obstacle,
                material: touch.contact.material,
                point: touch.contact.point,
                impulse: -change * self.config.body.mass,
            });
        }
    }

    /// Puts the climber's weight on its support, except after a movement through the air: then the support got the
    /// impulse of the hit. The support also gets the reaction to changes of the climber's own velocity, or to the pull
    /// of its arms.
    pub(super) fn weigh_down(&mut self) {
        let Some(attachment) = self.attachment() else {
            self.state.load = 0.0;
            return;
        };
        if !self.motion.has_flown {
            let response = self.response_of(&attachment, self.config.gravity);
            let borne = if response > 0.0 {
                self.mass_borne()
            } else {
                0.0
            };
            let mass = self.config.body.mass;
            self.state.load = self.load_on(&attachment, response * (mass + borne));
            let weight = self.weight(mass);
            match self.pull {
                Some(pull) => self.pull_on(&attachment, pull, weight),
                None => self.recoil(&attachment),
            }
            if self.state.load > 0.0 {
                self.add_to_support(&attachment, weight + self.weight(borne));
            }
            return;
        }
        self.state.load = 0.0;
        let was_hit = self.is_pushed(attachment.obstacle, &attachment.material);
        self.recoil(&attachment);
        if was_hit {
            // The impulse will change the support's velocity, which must not count as shake.
            self.state.support_velocity = None;
        }
    }

    /// The impulse of a mass's weight over the tick, as far as the support gets it.
    fn weight(&self, mass: f64) -> DVec3 {
        self.config.gravity * (mass * self.dt() * self.state.load)
    }

    /// Mass of all climbers that stand on this one or hold it, directly or through others, kg.
    fn mass_borne(&self) -> f64 {
        let characters = self.obstacles.iter();
        characters
            .filter_map(|(_, obstacle)| obstacle.character())
            .filter(|other| other.carried_by.is_some() && other.carried_by == self.judge.rules.id)
            .map(|other| other.mass)
            .sum()
    }

    /// Share of its weight that the climber's support gets in this tick: gravity less the support's acceleration along
    /// it. `relative` is the mass of the climber and of the climbers on it, as a multiple of the support's mass. Zero
    /// for a support that cannot be pushed.
    ///
    /// The support's acceleration includes the effect of the last tick's weight, unless another object held the
    /// support. So the share is correct for two bodies which move on together, of any masses: a light support is
    /// neither pulled down faster than gravity, nor loaded only in every other tick.
    fn load_on(&self, attachment: &Attachment, relative: f64) -> f64 {
        if relative == 0.0 {
            return 0.0;
        }
        let key = |attachment: &Attachment| (attachment.obstacle, attachment.material.key);
        let same = |carried: &Carried| key(&carried.support.attachment) == key(attachment);
        let change = self
            .support_change
            .filter(|_| self.carried.as_ref().is_some_and(same));
        let Some(change) = change else {
            // A body that was hit gives way by the next tick. Feet stand on it then; hands only begin to pull.
            return if self.state.mode == ClimberMode::Standing {
                1.0
            } else {
                self.state.load
            };
        };
        let share = (1.0 - self.sinks(change) + self.state.load * relative) / (1.0 + relative);
        share.max(0.0)
    }

    /// Change of the support's velocity by the weight of the last tick, if no other object held the support.
    pub(super) fn change_by_load(&self) -> DVec3 {
        let Some(attachment) = self.attachment() else {
            return DVec3::ZERO;
        };
        let weight = self.weight(self.config.body.mass);
        weight * self.response_of(&attachment, weight)
    }

    /// Gives the hold the reaction to the pull of the arms. The arms hold one body at each end, so the hold gets the
    /// share that its inertia leaves. `weight`, the climber's weight, is subtracted, since the hold gets it in any
    /// case.
    fn pull_on(&mut self, attachment: &Attachment, pull: DVec3, weight: DVec3) {
        // Slack arms do not pull: this takes the weight back.
        let response = self.response_of(attachment, pull);
        let relative = response * self.config.body.mass;
        // A hold with a hundredth of the climber's mass that another object holds swings faster than the ticks follow.
        let dt = self.dt();
        let length = self.state.hanging.arm.max(self.config.body.radius);
        let stiffness = relative * self.config.gravity.length() * dt * dt / length;
        let given = -pull * (MAX_HOLD_SWING / stiffness).min(1.0) / (1.0 + relative);
        self.push_support(attachment, given - weight);
    }

    /// Gives the support the reaction to starting, stopping and turning, and to the change to the support's velocity.
    /// Climber and support move on together, so a light raft is not kicked away. Ice does not move on with the climber,
    /// and gets all of the reaction.
    fn recoil(&mut self, attachment: &Attachment) {
        let change = self.state.velocity - self.rides;
        if change == DVec3::ZERO {
            return;
        }
        let response = self.response_of(attachment, -change);
        let mass = self.config.body.mass;
        if response > 0.0 {
            let together = if self.slips() {
                mass
            } else {
                1.0 / (response + 1.0 / mass)
            };
            self.push_support(attachment, -change * together);
        }
    }

    /// Gives the support an impulse, if it can be pushed. The change of velocity by this impulse will not count as
    /// shake.
    fn push_support(&mut self, attachment: &Attachment, impulse: DVec3) {
        let response = self.response_of(attachment, impulse);
        if response == 0.0 {
            return;
        }
        if let Some(velocity) = &mut self.state.support_velocity {
            *velocity += impulse * response;
        }
        self.add_to_support(attachment, impulse);
    }

    /// Bounces off a contact at a speed, reduced to the share that the two masses leave the climber, and gives the
    /// contact the reaction.
    pub(super) fn bounce(&mut self, touch: &MoverContact, speed: f64) {
        let mass = self.config.body.mass;
        let response = self.response_at(touch, touch.normal);
        let change = touch.normal * (speed / (1.0 + response * mass));
        self.change_against(touch, change);
    }

    /// Adds an impulse to the impulses that the support gets in this tick.
    fn add_to_support(&mut self, attachment: &Attachment, impulse: DVec3) {
        self.push(Push {
            obstacle: attachment.obstacle,
            material: attachment.material,
            point: attachment.point,
            impulse,
        });
    }

    /// Adds a push to the tick's pushes; pushes on the same material are summed.
    pub(super) fn push(&mut self, new: Push) {
        let key = |push: &Push| (push.obstacle, push.material.key);
        let mut pushes = self.report.pushes.iter_mut();
        match pushes.find(|push| key(push) == key(&new)) {
            Some(push) => push.impulse += new.impulse,
            None => self.report.pushes.push(new),
        }
    }

    /// The speed along a direction that the support gains from an impulse of 1 N s in this direction.
    pub(super) fn response_of(&self, attachment: &Attachment, direction: DVec3) -> f64 {
        let direction = direction.normalize_or_zero();
        if direction == DVec3::ZERO {
            return 0.0;
        }
        let (obstacle, material) = (attachment.obstacle, &attachment.material);
        self.mover
            .inverse_effective_mass(obstacle, material, direction)
    }

    /// The speed along a unit vector that a contact gains from an impulse of 1 N s in this direction.
    pub(super) fn response_at(&self, touch: &MoverContact, direction: DVec3) -> f64 {
        let material = &touch.contact.material;
        self.mover
            .inverse_effective_mass(touch.obstacle, material, direction)
    }

    /// True for contacts that the climber stands on or holds: its support, and while it stands, all contacts that are
    /// level enough to be underfoot.
    pub(super) fn is_on(&self, touch: &MoverContact) -> bool {
        let is_underfoot = self.state.mode == ClimberMode::Standing
            && self.config.slope(touch.normal) <= self.standing_slope();
        let is_support = self.attachment().is_some_and(|attachment| {
            let material = (attachment.obstacle, attachment.material.key);
            material == (touch.obstacle, touch.contact.material.key)
        });
        is_underfoot || is_support
    }

    pub(super) fn is_pushed(&self, obstacle: ObstacleId, point: &MaterialPoint) -> bool {
        let mut pushes = self.report.pushes.iter();
        pushes.any(|push| (push.obstacle, push.material.key) == (obstacle, point.key))
    }
}

/// The acceleration of a support, in multiples of gravity, without a solver's possible jitter.
fn without_jitter(acceleration: f64) -> f64 {
    let beyond = (acceleration.abs() - SUPPORT_JITTER).clamp(0.0, SUPPORT_JITTER) * 2.0;
    if beyond < 2.0 * SUPPORT_JITTER {
        beyond.copysign(acceleration)
    } else {
        acceleration
    }
}
