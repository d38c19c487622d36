//! What it runs into is pushed, if it can be.

use super::Step;
use crate::event::Push;
use crate::mover::Path;

impl Step<'_> {
    /// Pushes everything that kept the body from where it wanted to be.
    pub(super) fn push_aside(&mut self, path: &Path) {
        let body = &self.config.body;
        let dt = self.dt();
        let wanted = (path.target - path.start) / dt;
        for index in 0..self.world.touched().len() {
            let touch = self.world.touched()[index];
            let response = self.world.push_response(&touch, -touch.away);
            if response == 0.0 {
                continue;
            }
            let already = self.report.pushes.iter().any(|push| {
                (push.obstacle, push.material.key) == (touch.obstacle, touch.contact.material.key)
            });
            if already {
                continue;
            }
            let closing = -(wanted - self.world.velocity_of(&touch)).dot(touch.away);
            let together = closing.max(0.0) / (response + 1.0 / body.mass);
            self.report.pushes.push(Push {
                obstacle: touch.obstacle,
                material: touch.contact.material,
                point: touch.contact.point,
                impulse: -touch.away * together.min(body.push_force * dt),
            });
        }
    }
}
