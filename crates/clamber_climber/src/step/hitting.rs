//! Impulses on the obstacles in the climber's way, if they can be pushed.
//!
//! An airborne climber transfers its momentum to what it hits: the impulse that brings both to one speed, this tick's
//! gravity included. A climber that stands or holds on gives obstacles in its way a push of limited force. Only what it
//! hits in the air changes its own velocity, to the common one.
//!
//! What was hit may be held by something else: a crate that lies against a wall stops a climber as the wall would. That
//! shows one tick later, when it has not given way.

use clamber_mover::Touch;
use glam::DVec3;

use super::Tick;
use super::pushing::JITTER;
use crate::ClimberMode;
use crate::event::Push;

/// Cosine of the largest angle between the normals of contacts on the same side of the body: 60 degrees.
const SAME_SIDE: f64 = 0.5;

/// What gives way by less than this share of what its own mass would is held.
const HELD: f64 = 0.1;

/// Who slides on ice was stopped if it went on by less than this share of its way.
const STOPPED: f64 = 0.5;

/// A body that rests on something meets it at no more than this multiple of the speed that gravity adds in a tick, also
/// in a lift that speeds up by as much as gravity.
const LIES: f64 = 4.0;

/// What was nearer than this multiple of the margin at the start of the tick was touched then.
const TOUCHED: f64 = 2.0;

impl Tick<'_> {
    /// Pushes the obstacles that kept the body from moving at the velocity `wanted`, except those that it stands on or
    /// holds.
    pub(super) fn push_aside(&mut self, wanted: DVec3) {
        self.recoil = DVec3::ZERO;
        self.wanted = wanted;
        if self.mover.touched().is_empty() {
            return;
        }
        let body = &self.config.body;
        let dt = self.dt();
        let slips = self.slips();
        let strikes = slips || !self.state.mode.is_supported();
        let is_free = slips || strikes && self.carried.is_none();
        let most = if strikes {
            f64::INFINITY
        } else {
            body.push_force * dt
        };
        let first = self.report.pushes.len();
        let mut taken = DVec3::ZERO;
        for index in 0..self.mover.touched().len() {
            let touch = self.mover.touched()[index];
            let (obstacle, material) = (touch.obstacle, touch.contact.material);
            let response = self.response_at(&touch, -touch.normal);
            if response == 0.0 || self.is_on(&touch) || self.is_pushed(obstacle, &material) {
                continue;
            }
            let closing = -(wanted - self.mover.velocity_of(&touch)).dot(touch.normal);
            if closing <= 0.0 {
                continue;
            }
            let together = closing / (response + 1.0 / body.mass);
            let impulse = -touch.normal * together.min(most);
            if is_free && !self.is_held(&touch) {
                taken += impulse;
            }
            self.report.pushes.push(Push {
                obstacle,
                material,
                point: touch.contact.point,
                impulse,
            });
        }
        // The obstacles may be colliders of one body, which the pushes together must not make faster than the climber.
        let pushes = &mut self.report.pushes[first..];
        let share = 1.0 / pushes.len().max(1) as f64;
        pushes.iter_mut().for_each(|push| push.impulse *= share);
        if is_free {
            self.recoil = -taken * share / self.config.body.mass;
        } else {
            let given = pushes.iter().map(|push| push.impulse).sum();
            self.brace_against(given);
        }
    }

    /// True for something that the climber hit in the last tick and that has not given way since: something else holds
    /// it, or it rests against the climber.
    ///
    /// A stream of bodies looks the same. So a held one only stops the climber: what would make it faster through the
    /// air is weighed.
    fn is_held(&self, touch: &Touch) -> bool {
        let Some((before, now)) = self.met_again(touch) else {
            return false;
        };
        let normal = touch.normal;
        // The last hit was to slow it to the climber's velocity.
        let asked = before - self.was.dot(normal);
        let stays = self.slips() || asked <= self.jitter() || before - now < HELD * asked;
        let (wanted, air) = (self.wanted.dot(normal), self.rules.air_velocity.dot(normal));
        let rests = now - wanted <= self.rests_at();
        stays && (rests || now - air <= air - wanted)
    }

    /// The velocities of a contact along its normal, in the last tick and in this one. `None` if the climber did not
    /// touch it in the last tick, or if something else has hit it since.
    fn met_again(&self, touch: &Touch) -> Option<(f64, f64)> {
        let normal = touch.normal;
        let is_known = self.presses_on(normal) && self.was_touched(touch);
        let blow = self.input.blow.map_or(DVec3::ZERO, |blow| blow.velocity);
        let is_struck = -blow.dot(normal) > self.rests_at();
        let now = self.mover.velocity_of(touch).dot(normal);
        let before = if self.slips() {
            now
        } else {
            self.base_was.dot(normal)
        };
        // What rests on something may be lifted with it.
        let is_same = is_known && !is_struck && now <= before + self.rests_at();
        is_same.then_some((before, now))
    }

    /// The fastest contact of a body at rest on something that may speed up.
    fn rests_at(&self) -> f64 {
        LIES * self.config.gravity.length() * self.dt()
    }

    fn jitter(&self) -> f64 {
        JITTER * self.config.gravity.length() * self.dt()
    }

    /// True if it stands on ice.
    pub(super) fn slips(&self) -> bool {
        self.state.mode == ClimberMode::Standing && self.is_slippery()
    }

    /// True if it was pressed against the same side in the last tick already. A climber that stands was, if it did not
    /// get on in that direction.
    fn presses_on(&self, normal: DVec3) -> bool {
        if self.carried.is_some() {
            let went_on = -self.state.own_way.dot(normal);
            let own = (self.base_was - self.was).dot(normal) * self.dt();
            return own > 0.0 && went_on < STOPPED * own;
        }
        let pressed = self.was_pressed.dot(normal);
        pressed > SAME_SIDE * self.was_pressed.length() * normal.length()
    }

    /// True if it touched a contact's material at the start of the tick.
    fn was_touched(&self, touch: &Touch) -> bool {
        let body = self.body();
        self.mover.path_of(touch).is_some_and(|path| {
            let axis = body.at(self.began).nearest_on_axis(path.previous_position);
            (axis - path.previous_position).dot(touch.normal) <= body.radius + TOUCHED * body.margin
        })
    }

    /// True for a contact with something that can be pushed, and was in the last tick.
    pub(super) fn hit_before(&self, touch: &Touch) -> bool {
        self.response_at(touch, -touch.normal) > 0.0 && self.met_again(touch).is_some()
    }

    /// The velocity of a contact that moves at `velocity`, after the last movement has hit it. Along the contact's
    /// normal it is no slower than the climber, which has shared its momentum with all that it hit.
    pub(super) fn velocity_after_hit(&self, touch: &Touch, velocity: DVec3) -> DVec3 {
        let normal = touch.normal;
        let closing = (velocity - self.wanted - self.recoil).dot(normal);
        let is_hit = self.recoil != DVec3::ZERO
            && closing > 0.0
            && self.is_pushed(touch.obstacle, &touch.contact.material)
            && !self.is_held(touch);
        if is_hit {
            velocity - normal * closing
        } else {
            velocity
        }
    }
}
