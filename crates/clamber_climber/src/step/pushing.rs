//! Weight on the support, and the reaction to every push and to every change of the climber's own velocity, if the
//! support can be pushed.

use clamber_mover::Touch;
use clamber_world::{Attachment, MaterialPoint, ObstacleId};
use glam::DVec3;

use super::Tick;
use super::carrying::Carried;
use crate::ClimberMode;
use crate::event::Push;

/// A support that accelerates by at most this multiple of gravity carries all of the climber's weight. From twice this
/// on, its whole acceleration counts. Physics engines let bodies at rest jitter by a part of it.
pub(super) const JITTER: f64 = 0.03;

/// The largest square of the angle, radians, by which a light hold may swing in a tick under the pull of the arms.
/// Where it would swing farther, it gets less of their pull. At twice this, the pull of ticks that lag behind drives
/// the swing.
const STIFFEST: f64 = 0.15;

impl Tick<'_> {
    /// Gives the reaction to an impulse to what the climber stands on or holds, if that can be pushed. Without it a
    /// passenger would drive its cart by pushing against the cart's wall.
    pub(super) fn brace_against(&mut self, impulse: DVec3) {
        if impulse == DVec3::ZERO {
            return;
        }
        if let Some(carried) = self.carried {
            self.push_support(&carried.support.attachment, -impulse);
        }
    }

    /// Gives its support the reaction to a jump off it: all of the momentum that it takes along. What is light and held
    /// up by something else passes the rest on to that: feet give it no more speed than the climber gets.
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

    /// The share of its jump speed that it gets from its support: all of it from what is held up by something else, and
    /// from what falls freely the share that the masses leave.
    pub(super) fn jump_share(&self) -> f64 {
        let held = self.is_held_up();
        held + (1.0 - held) / (1.0 + self.relative(self.config.up()))
    }

    /// The climber's mass as a multiple of its support's, for impulses in a direction. 0 if that cannot be pushed.
    pub(super) fn relative(&self, direction: DVec3) -> f64 {
        self.attachment().map_or(0.0, |attachment| {
            self.response_of(&attachment, direction) * self.config.body.mass
        })
    }

    /// How far something else holds up what it stands on: 1 if all of its weight is carried, 0 if both fall freely. 1 in
    /// the tick after a hit: how far what was hit gives way is not known yet.
    fn is_held_up(&self) -> f64 {
        if self.state.mode != ClimberMode::Standing {
            return 0.0;
        }
        let sinks = self.support_change.map_or(0.0, |change| self.sinks(change));
        let load = self.state.load;
        let relative = self.relative(self.config.gravity);
        // After a landing it has not given any weight yet.
        let held = if load == 0.0 {
            1.0 - sinks
        } else {
            (1.0 - sinks + load * relative) / (1.0 + relative)
        };
        held.clamp(0.0, 1.0)
    }

    /// The acceleration of its support along gravity, in multiples of that, without what may be a solver's jitter.
    fn sinks(&self, change: DVec3) -> f64 {
        let gravity = self.config.gravity;
        without_jitter(change.dot(gravity) / (gravity.length_squared() * self.dt()))
    }

    /// Brakes its velocity `along` a contact, relative to that, by at most `braked`, and gives the contact the reaction.
    /// Both come to one speed at most. Returns the speed that is left.
    pub(super) fn rub(&mut self, touch: &Touch, along: DVec3, braked: f64) -> f64 {
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

    /// Changes its velocity against a contact, which gets the reaction.
    fn change_against(&mut self, touch: &Touch, change: DVec3) {
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

    /// Puts its weight on its support, except after a movement through the air: then the support got the impulse of the
    /// hit. It also gets the reaction to changes of the climber's own velocity, or to the pull of its arms.
    pub(super) fn weigh_down(&mut self) {
        let Some(attachment) = self.attachment() else {
            self.state.load = 0.0;
            return;
        };
        if !self.has_flown {
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

    /// The impulse over the tick of the weight of a mass, as far as its support gets it.
    fn weight(&self, mass: f64) -> DVec3 {
        self.config.gravity * (mass * self.dt() * self.state.load)
    }

    /// The mass of all climbers that stand on it or hold it, or stand on those, kg.
    fn mass_borne(&self) -> f64 {
        let characters = self.obstacles.iter();
        characters
            .filter_map(|(_, obstacle)| obstacle.character())
            .filter(|other| other.carried_by.is_some() && other.carried_by == self.rules.id)
            .map(|other| other.mass)
            .sum()
    }

    /// The share of its weight that its support gets in this tick: mass times gravity, less the support's acceleration.
    /// `relative` is the mass, with that of those it bears, as a multiple of the support's. Zero for a support that
    /// cannot be pushed.
    ///
    /// The support's acceleration includes what the weight gave to it in the last tick, as far as nothing held it. So
    /// the share is that of two bodies which move on together, of any masses: a light one is neither pulled down faster
    /// than gravity nor weighed down by turns.
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

    /// What the weight of the last tick has changed its support's velocity by, if nothing held that.
    pub(super) fn change_by_load(&self) -> DVec3 {
        let Some(attachment) = self.attachment() else {
            return DVec3::ZERO;
        };
        let weight = self.weight(self.config.body.mass);
        weight * self.response_of(&attachment, weight)
    }

    /// Gives its hold the reaction to the pull of its arms: as the arms hold one body at each end, by the share of the
    /// hold's inertia. `weight` of it is the climber's weight, which it gets in any case.
    fn pull_on(&mut self, attachment: &Attachment, pull: DVec3, weight: DVec3) {
        // Slack arms do not pull: then the weight is taken back.
        let response = self.response_of(attachment, pull);
        let relative = response * self.config.body.mass;
        // A hold of a hundredth of the climber's mass that something else holds swings faster than the ticks follow.
        let dt = self.dt();
        let length = self.state.hanging.arm.max(self.config.body.radius);
        let stiffness = relative * self.config.gravity.length() * dt * dt / length;
        let given = -pull * (STIFFEST / stiffness).min(1.0) / (1.0 + relative);
        self.push_support(attachment, given - weight);
    }

    /// The reaction to starting, stopping and turning, and to being brought to the support's velocity. Both move on
    /// together, so a light raft is not kicked away. Ice does not take the climber along: it gets all of the reaction.
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

    /// Gives the support an impulse, if it can be pushed. The change of velocity that this makes will not count as
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

    /// Bounces off a contact at a speed, of which it gets the share that the masses leave, and gives the contact the
    /// reaction.
    pub(super) fn bounce(&mut self, touch: &Touch, speed: f64) {
        let mass = self.config.body.mass;
        let response = self.response_at(touch, touch.normal);
        let change = touch.normal * (speed / (1.0 + response * mass));
        self.change_against(touch, change);
    }

    /// Adds an impulse to what the support gets in this tick.
    fn add_to_support(&mut self, attachment: &Attachment, impulse: DVec3) {
        self.push(Push {
            obstacle: attachment.obstacle,
            material: attachment.material,
            point: attachment.point,
            impulse,
        });
    }

    /// Adds a push to those of this tick.
    pub(super) fn push(&mut self, new: Push) {
        let key = |push: &Push| (push.obstacle, push.material.key);
        let mut pushes = self.report.pushes.iter_mut();
        match pushes.find(|push| key(push) == key(&new)) {
            Some(push) => push.impulse += new.impulse,
            None => self.report.pushes.push(new),
        }
    }

    /// The speed along a direction that an impulse of 1 N s in it gives to the support.
    pub(super) fn response_of(&self, attachment: &Attachment, direction: DVec3) -> f64 {
        let direction = direction.normalize_or_zero();
        if direction == DVec3::ZERO {
            return 0.0;
        }
        let (obstacle, material) = (attachment.obstacle, &attachment.material);
        self.mover.push_response(obstacle, material, direction)
    }

    /// The speed along a unit vector that an impulse of 1 N s in this direction gives to a contact.
    pub(super) fn response_at(&self, touch: &Touch, direction: DVec3) -> f64 {
        let material = &touch.contact.material;
        self.mover
            .push_response(touch.obstacle, material, direction)
    }

    /// True for contacts that it stands on or holds: its support, and while standing all that are level enough to be
    /// underfoot.
    pub(super) fn is_on(&self, touch: &Touch) -> bool {
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

/// The acceleration of a support, in multiples of gravity, without what may be a solver's jitter.
fn without_jitter(acceleration: f64) -> f64 {
    let beyond = (acceleration.abs() - JITTER).clamp(0.0, JITTER) * 2.0;
    if beyond < 2.0 * JITTER {
        beyond.copysign(acceleration)
    } else {
        acceleration
    }
}
