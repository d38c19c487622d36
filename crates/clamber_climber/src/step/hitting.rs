//! Impulses on the obstacles in the climber's way, if they can be pushed.
//!
//! An airborne climber transfers its momentum to the obstacles that it hits: the impulse that brings both to one speed,
//! this tick's gravity included. A climber that stands or holds on gives obstacles in its way a push of limited force.
//! Only hits in the air change the climber's own velocity, to the common one.
//!
//! Another object may hold the obstacle that was hit: a crate that lies against a wall stops a climber as the wall
//! would. This shows one tick later, when the obstacle has not given way.

use clamber_mover::MoverContact;
use glam::DVec3;

use super::Tick;
use super::pushing::SUPPORT_JITTER;
use crate::ClimberMode;
use crate::event::Push;

/// Cosine of the largest angle between the normals of contacts on the same side of the body: 60 degrees.
const SAME_SIDE: f64 = 0.5;

/// Share of the expected change of velocity below which an obstacle has not given way, and counts as held.
const HELD_CHANGE_SHARE: f64 = 0.1;

/// Share of its way below which a climber that slides on ice counts as stopped.
const STOPPED_WAY_SHARE: f64 = 0.5;

/// Largest speed at which a body that rests on another one meets it, as a multiple of the speed that gravity adds in a
/// tick: also in a lift that speeds up by as much as gravity.
const LYING_SPEED_FACTOR: f64 = 4.0;

/// Distance at the start of the tick, as a multiple of the margin, within which an obstacle was touched then.
const TOUCHED_DISTANCE: f64 = 2.0;

impl Tick<'_> {
    /// Pushes the obstacles that kept the body from moving at the velocity `wanted`, except the obstacles that the
    /// climber stands on or holds.
    pub(super) fn push_aside(&mut self, wanted: DVec3) {
        self.motion.recoil = DVec3::ZERO;
        self.motion.wanted = wanted;
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
            self.motion.recoil = -taken * share / self.config.body.mass;
        } else {
            let given = pushes.iter().map(|push| push.impulse).sum();
            self.brace_against(given);
        }
    }

    /// True for an obstacle that the climber hit in the last tick and that has not given way since: another object
    /// holds it, or it rests against the climber.
    ///
    /// A stream of bodies looks the same. So an obstacle counts as held only if it does no more than stop the climber.
    /// An obstacle that would make the climber faster through the air is treated by its mass.
    fn is_held(&self, touch: &MoverContact) -> bool {
        let Some((before, now)) = self.met_again(touch) else {
            return false;
        };
        let normal = touch.normal;
        // The last hit should have slowed the obstacle to the climber's velocity.
        let asked = before - self.before.velocity.dot(normal);
        let stays =
            self.slips() || asked <= self.jitter() || before - now < HELD_CHANGE_SHARE * asked;
        let (wanted, air) = (
            self.motion.wanted.dot(normal),
            self.judge.rules.air_velocity.dot(normal),
        );
        let rests = now - wanted <= self.rests_at();
        stays && (rests || now - air <= air - wanted)
    }

    /// The velocities of a contact along its normal, in the last tick and in this one. `None` if the climber did not
    /// touch the obstacle in the last tick, or if a blow has driven the climber into it since.
    fn met_again(&self, touch: &MoverContact) -> Option<(f64, f64)> {
        let normal = touch.normal;
        let is_known = self.presses_on(normal) && self.was_touched(touch);
        let blow = self
            .judge
            .rules
            .knockback
            .map_or(DVec3::ZERO, |blow| blow.velocity);
        let is_struck = -blow.dot(normal) > self.rests_at();
        let now = self.mover.velocity_of(touch).dot(normal);
        let before = if self.slips() {
            now
        } else {
            self.before.base_velocity.dot(normal)
        };
        // An obstacle that rests on another one may be lifted with it.
        let is_same = is_known && !is_struck && now <= before + self.rests_at();
        is_same.then_some((before, now))
    }

    /// Largest contact speed of a body at rest on another one that may speed up, metres a second.
    fn rests_at(&self) -> f64 {
        LYING_SPEED_FACTOR * self.config.gravity.length() * self.dt()
    }

    fn jitter(&self) -> f64 {
        SUPPORT_JITTER * self.config.gravity.length() * self.dt()
    }

    /// True if the climber stands on ice.
    pub(super) fn slips(&self) -> bool {
        self.state.mode == ClimberMode::Standing && self.is_slippery()
    }

    /// True if the climber was already pressed against the same side in the last tick: for a climber that stands, if it
    /// did not get on in that direction.
    fn presses_on(&self, normal: DVec3) -> bool {
        if self.carried.is_some() {
            let went_on = -self.state.own_way.dot(normal);
            let own = (self.before.base_velocity - self.before.velocity).dot(normal) * self.dt();
            return own > 0.0 && went_on < STOPPED_WAY_SHARE * own;
        }
        let pressed = self.before.pressed.dot(normal);
        pressed > SAME_SIDE * self.before.pressed.length() * normal.length()
    }

    /// True if the climber touched a contact's material at the start of the tick.
    fn was_touched(&self, touch: &MoverContact) -> bool {
        let body = self.body();
        self.mover.path_of(touch).is_some_and(|path| {
            let axis = body
                .at(self.before.position)
                .nearest_on_axis(path.previous_position);
            (axis - path.previous_position).dot(touch.normal)
                <= body.radius + TOUCHED_DISTANCE * body.margin
        })
    }

    /// True for a contact with an obstacle that can be pushed, if the climber also touched it in the last tick.
    pub(super) fn hit_before(&self, touch: &MoverContact) -> bool {
        self.response_at(touch, -touch.normal) > 0.0 && self.met_again(touch).is_some()
    }

    /// The velocity of a contact that moves at `velocity`, after the last movement has hit it. Along the contact's
    /// normal it is no slower than the climber, which has shared its momentum with all obstacles that it hit.
    pub(super) fn velocity_after_hit(&self, touch: &MoverContact, velocity: DVec3) -> DVec3 {
        let normal = touch.normal;
        let closing = (velocity - self.motion.wanted - self.motion.recoil).dot(normal);
        let is_hit = self.motion.recoil != DVec3::ZERO
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
