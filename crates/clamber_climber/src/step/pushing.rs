//! Weight on the support, and impulses on the obstacles in the climber's way, if they can be pushed.
//!
//! An airborne climber transfers its momentum to what it hits: the impulse that brings both to one speed, this tick's
//! gravity included. A climber that stands or holds on transfers no momentum to its support, however firmly walking
//! presses it there: the support gets its weight, and other obstacles in the way get a push of limited force. None of
//! this changes where the climber goes.

use clamber_mover::Touch;
use clamber_world::{MaterialPoint, ObstacleId};
use glam::DVec3;

use super::Tick;
use crate::ClimberMode;
use crate::event::Push;

impl Tick<'_> {
    /// Pushes the obstacles that kept the body from moving at the velocity `wanted`, except those that it stands on or
    /// holds.
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
        // The obstacles may be colliders of one body, which the pushes together must not make faster than the climber.
        let pushes = &mut self.report.pushes[first..];
        let share = 1.0 / pushes.len() as f64;
        pushes.iter_mut().for_each(|push| push.impulse *= share);
    }

    /// Puts its weight on its support, except after a movement through the air: then the support got the impulse of the
    /// hit.
    pub(super) fn weigh_down(&mut self) {
        let Some(support) = self.state.support else {
            return;
        };
        let attachment = support.attachment;
        if self.has_flown {
            if self.is_pushed(attachment.obstacle, &attachment.material) {
                // The impulse will change the support's velocity, which must not count as shake.
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

    /// True for contacts that it stands on or holds: its support, and while standing all that are level enough to be
    /// underfoot.
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
