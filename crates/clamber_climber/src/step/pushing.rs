//! The support feels the climber's weight, and obstacles in its way are pushed, if they can be.
//!
//! An airborne climber transfers its momentum to what it hits: the impulse that brings both to one speed, this tick's
//! gravity included. A climber that stands or holds on does not strike its support, however firmly walking presses it
//! there: the support feels its weight, and other obstacles in the way feel a push of limited force. None of this changes
//! where the climber goes.

use clamber_mover::Touch;
use clamber_world::{MaterialPoint, ObstacleId};
use glam::DVec3;

use super::Tick;
use crate::ClimberMode;
use crate::event::Push;

impl Tick<'_> {
    /// Pushes what kept the body from where it wanted to be, but for what it is on.
    pub(super) fn push_aside(&mut self, wanted: DVec3) {
        let body = &self.config.body;
        let dt = self.dt();
        let strikes = !self.state.mode.is_supported();
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
        // Colliders may belong to one body, which all of them together must not make faster than the climber.
        let pushes = &mut self.report.pushes[first..];
        let share = 1.0 / pushes.len() as f64;
        pushes.iter_mut().for_each(|push| push.impulse *= share);
    }

    /// Puts its weight on what supports it. In a tick in the air, what it struck has felt it already.
    pub(super) fn weigh_down(&mut self) {
        let Some(support) = self.state.support else {
            return;
        };
        let attachment = support.attachment;
        if self.has_flown {
            if self.is_pushed(attachment.obstacle, &attachment.material) {
                // It will go otherwise than it went, which is no shake.
                self.state.support_velocity = None;
            }
            return;
        }
        let (obstacle, gravity) = (attachment.obstacle, self.config.gravity);
        let down = gravity.normalize_or_zero();
        if self
            .mover
            .push_response(obstacle, &attachment.material, down)
            == 0.0
        {
            return;
        }
        self.report.pushes.push(Push {
            obstacle,
            material: attachment.material,
            point: attachment.point,
            impulse: gravity * (self.config.body.mass * self.dt()),
        });
    }

    /// It stands on this or holds it: its support, and what else is level enough to be underfoot.
    fn is_on(&self, touch: &Touch) -> bool {
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
