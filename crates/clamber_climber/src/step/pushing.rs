//! Weight on the support, and impulses on the obstacles in the climber's way, if they can be pushed.
//!
//! An airborne climber transfers its momentum to what it hits: the impulse that brings both to one speed, this tick's
//! gravity included. A climber that stands or holds on gives its support its weight, or the pull of its arms, and
//! obstacles in its way a push of limited force. Every push, and every change of its own velocity, has its reaction on
//! the support. Only what it hits in the air changes its own velocity, to the common one.

use clamber_mover::Touch;
use clamber_world::{Attachment, MaterialPoint, ObstacleId};
use glam::DVec3;

use super::Tick;
use super::carrying::Carried;
use crate::ClimberMode;
use crate::event::Push;

/// A support that accelerates by at most this multiple of gravity carries all of the climber's weight. From twice this
/// on, its whole acceleration counts. Physics engines let bodies at rest jitter by a part of it.
const JITTER: f64 = 0.03;

/// The largest square of the angle, radians, by which a light hold may swing in a tick under the pull of the arms.
/// Where it would swing farther, it gets less of their pull. At twice this, the pull of ticks that lag behind drives
/// the swing.
const STIFFEST: f64 = 0.15;

/// Cosine of the largest angle between the normals of contacts on the same side of the body: 60 degrees.
const SAME_SIDE: f64 = 0.5;

impl Tick<'_> {
    /// Pushes the obstacles that kept the body from moving at the velocity `wanted`, except those that it stands on or
    /// holds.
    pub(super) fn push_aside(&mut self, wanted: DVec3) {
        let body = &self.config.body;
        let dt = self.dt();
        let strikes = !self.state.mode.is_supported();
        self.recoil = DVec3::ZERO;
        self.after_hits = wanted;
        let most = if strikes {
            f64::INFINITY
        } else {
            body.push_force * dt
        };
        let first = self.report.pushes.len();
        for index in 0..self.mover.touched().len() {
            let touch = self.mover.touched()[index];
            let (obstacle, material) = (touch.obstacle, touch.contact.material);
            let response = self.mover.push_response(obstacle, &material, -touch.normal);
            if response == 0.0 || self.is_on(&touch) || self.is_pushed(obstacle, &material) {
                continue;
            }
            let closing = -(wanted - self.mover.velocity_of(&touch)).dot(touch.normal);
            if closing <= 0.0 {
                continue;
            }
            let together = closing / (response + 1.0 / body.mass);
            self.report.pushes.push(Push {
                obstacle,
                material,
                point: touch.contact.point,
                impulse: -touch.normal * together.min(most),
            });
        }
        // The obstacles may be colliders of one body, which the pushes together must not make faster than the climber.
        let pushes = &mut self.report.pushes[first..];
        let share = 1.0 / pushes.len() as f64;
        pushes.iter_mut().for_each(|push| push.impulse *= share);
        let given = pushes.iter().map(|push| push.impulse).sum();
        if strikes && self.carried.is_none() {
            let presses = |push: &&Push| !self.presses_on(-push.impulse);
            let hits = self.report.pushes[first..].iter().filter(presses);
            let taken: DVec3 = hits.map(|push| push.impulse).sum();
            self.recoil = -taken / self.config.body.mass;
            self.after_hits = wanted + self.recoil;
        } else {
            self.brace_against(given);
        }
    }

    /// True if it was pressed against the same side in the last tick already. What it pushed then has not given way, or
    /// both go on at one speed since.
    fn presses_on(&self, normal: DVec3) -> bool {
        let pressed = self.was_pressed.dot(normal);
        pressed > SAME_SIDE * self.was_pressed.length() * normal.length()
    }

    /// True for a contact with something that can be pushed, and was in the last tick.
    pub(super) fn hit_before(&self, touch: &Touch) -> bool {
        let material = &touch.contact.material;
        self.presses_on(touch.normal)
            && self
                .mover
                .push_response(touch.obstacle, material, -touch.normal)
                > 0.0
    }

    /// The velocity of a contact that moves at `velocity`, after the last movement has hit it. Along the contact's
    /// normal it is no slower than the climber, which has shared its momentum with all that it hit.
    pub(super) fn velocity_after_hit(&self, touch: &Touch, velocity: DVec3) -> DVec3 {
        let normal = touch.normal;
        let closing = (velocity - self.after_hits).dot(normal);
        let is_hit = self.recoil != DVec3::ZERO
            && closing > 0.0
            && self.is_pushed(touch.obstacle, &touch.contact.material)
            && !self.presses_on(normal);
        if is_hit {
            velocity - normal * closing
        } else {
            velocity
        }
    }

    /// Gives the reaction to an impulse to what the climber stands on or holds, if that can be pushed. Without it a
    /// passenger would drive its cart by pushing against the cart's wall.
    fn brace_against(&mut self, impulse: DVec3) {
        if let Some(carried) = self.carried {
            self.push_support(&carried.support.attachment, -impulse);
        }
    }

    /// Gives its support the reaction to a jump off it: all of the momentum that it takes along.
    pub(super) fn push_off(&mut self) {
        if let Some(attachment) = self.attachment() {
            let change = self.state.velocity - self.rides;
            self.push_support(&attachment, -change * self.config.body.mass);
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
            self.state.load = self.load_on(&attachment);
            let weight = self.weight(self.state.load);
            match self.pull {
                Some(pull) => self.pull_on(&attachment, pull, weight),
                None => self.recoil(&attachment),
            }
            if self.state.load > 0.0 {
                self.add_to_support(&attachment, weight);
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

    /// The impulse of a share of its weight over the tick.
    fn weight(&self, share: f64) -> DVec3 {
        self.config.gravity * (self.config.body.mass * self.dt() * share)
    }

    /// The share of its weight that its support gets in this tick: mass times gravity, less the support's acceleration.
    /// Zero for a support that cannot be pushed.
    ///
    /// The support's acceleration includes what the weight gave to it in the last tick, as far as nothing held it. So
    /// the share is that of two bodies which move on together, of any masses: a light one is neither pulled down faster
    /// than gravity nor weighed down by turns.
    fn load_on(&self, attachment: &Attachment) -> f64 {
        let gravity = self.config.gravity;
        let response = self.response_of(attachment, gravity);
        if response == 0.0 {
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
        let sinks = change.dot(gravity) / (gravity.length_squared() * self.dt());
        let relative = response * self.config.body.mass;
        let share = (1.0 - without_jitter(sinks) + self.state.load * relative) / (1.0 + relative);
        share.max(0.0)
    }

    /// What the weight of the last tick has changed its support's velocity by, if nothing held that.
    pub(super) fn change_by_load(&self) -> DVec3 {
        let Some(attachment) = self.attachment() else {
            return DVec3::ZERO;
        };
        let weight = self.weight(self.state.load);
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
    /// together, so a light raft is not kicked away.
    fn recoil(&mut self, attachment: &Attachment) {
        let change = self.state.velocity - self.rides;
        let response = self.response_of(attachment, -change);
        if response > 0.0 {
            let together = 1.0 / (response + 1.0 / self.config.body.mass);
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

    /// Adds an impulse to what the support gets in this tick.
    fn add_to_support(&mut self, attachment: &Attachment, impulse: DVec3) {
        let (obstacle, material) = (attachment.obstacle, attachment.material);
        let is_same =
            |push: &&mut Push| (push.obstacle, push.material.key) == (obstacle, material.key);
        if let Some(push) = self.report.pushes.iter_mut().find(is_same) {
            push.impulse += impulse;
            return;
        }
        self.report.pushes.push(Push {
            obstacle,
            material,
            point: attachment.point,
            impulse,
        });
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

    fn is_pushed(&self, obstacle: ObstacleId, point: &MaterialPoint) -> bool {
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
