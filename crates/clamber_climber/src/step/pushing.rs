//! What holds it up feels its weight, and what is in its way is pushed, if it can be.
//!
//! Who is in the air strikes: what it meets takes the momentum that brings both to one speed, this tick's gravity with
//! it. Who is on its feet or holds on does not strike what it is on, however firmly walking presses it there: that
//! feels its weight, and what else is in the way a push of limited force. Nothing of this changes where it goes.

use clamber_world::{MaterialPoint, ObstacleId};

use super::Step;
use crate::event::Push;
use crate::mover::{Path, Touch};
use crate::{ClimberMode, Support};

impl Step<'_> {
    /// Pushes what kept the body from where it wanted to be, but for what it is on.
    pub(super) fn push_aside(&mut self, path: &Path) {
        let body = &self.config.body;
        let dt = self.dt();
        let wanted = (path.target - path.start) / dt;
        let strikes = !self.state.mode.is_supported();
        let most = if strikes {
            f64::INFINITY
        } else {
            body.push_force * dt
        };
        let first = self.report.pushes.len();
        for index in 0..self.world.touched().len() {
            let touch = self.world.touched()[index];
            let (obstacle, material) = (touch.obstacle, touch.contact.material);
            let response = self.world.push_response(obstacle, &material, -touch.away);
            if response == 0.0 || self.is_on(&touch) || self.is_pushed(obstacle, &material) {
                continue;
            }
            let closing = -(wanted - self.world.velocity_of(&touch)).dot(touch.away);
            if closing <= 0.0 {
                continue;
            }
            let together = closing / (response + 1.0 / body.mass);
            self.report.pushes.push(Push {
                obstacle,
                material,
                point: touch.contact.point,
                impulse: -touch.away * together.min(most),
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
        if self.has_flown {
            if self.is_pushed(support.obstacle, &support.point) {
                // It will go otherwise than it went, which is no shake.
                self.state.support_velocity = None;
            }
            return;
        }
        let (obstacle, gravity) = (support.obstacle, self.config.gravity);
        let down = gravity.normalize_or_zero();
        if self.world.push_response(obstacle, &support.point, down) == 0.0 {
            return;
        }
        self.report.pushes.push(Push {
            obstacle,
            material: support.point,
            point: support.contact,
            impulse: gravity * (self.config.body.mass * self.dt()),
        });
    }

    /// It stands on this or holds it: its support, and what else is level enough to be underfoot.
    fn is_on(&self, touch: &Touch) -> bool {
        let is_underfoot = self.state.mode == ClimberMode::Standing
            && self.config.slope(touch.away) <= self.stood_on();
        let is_support = |support: &Support| {
            let material = (support.obstacle, support.point.key);
            material == (touch.obstacle, touch.contact.material.key)
        };
        is_underfoot || self.state.support.as_ref().is_some_and(is_support)
    }

    fn is_pushed(&self, obstacle: ObstacleId, point: &MaterialPoint) -> bool {
        let mut pushes = self.report.pushes.iter();
        pushes.any(|push| (push.obstacle, push.material.key) == (obstacle, point.key))
    }
}
