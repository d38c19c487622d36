//! In the air, or down what is too steep: gravity, and what is in the way.

use glam::DVec3;

use super::Step;
use crate::mover::Touch;
use crate::{ClimberEvent, ClimberMode};

impl Step<'_> {
    pub(super) fn fly(&mut self) {
        let is_tumbling = self.state.mode == ClimberMode::Tumbling;
        if !is_tumbling && self.grip_or_catch() {
            return;
        }
        let (start, dt) = (self.state.position, self.dt());
        if !is_tumbling && self.state.coyote > 0.0 && self.state.jump_buffer > 0.0 {
            self.state.jump_buffer = 0.0;
            self.state.coyote = 0.0;
            let up = self.config.up();
            let rising = self.state.velocity.dot(up).max(0.0);
            let jump = self.config.ground.jump_speed;
            self.state.velocity += up * (jump + rising - self.state.velocity.dot(up));
            self.event(ClimberEvent::Jumped);
            self.change_to(ClimberMode::Falling);
        }
        self.has_flown = true;
        self.state.velocity += self.config.gravity * dt;
        let falling = self.state.velocity;
        let moved = self.slide(start, start + falling * dt, true);
        self.state.position = moved.position;
        self.state.velocity = self.world.stopped(falling, None);
        if is_tumbling {
            self.lie(falling);
        } else {
            self.land(falling);
        }
    }

    /// Stands on what it came down on, or slides down it.
    fn land(&mut self, falling: DVec3) {
        let up = self.config.up();
        let slope = self.config.ground.max_slope;
        if let Some(touch) = self.held_up_by(slope) {
            let ground = self.world.velocity_of(&touch);
            let speed = -(falling - ground).dot(touch.away);
            self.attach(&touch);
            self.state.velocity = ground;
            self.event(ClimberEvent::Landed {
                obstacle: touch.obstacle,
                speed: speed.max(0.0),
            });
            self.change_to(ClimberMode::Standing);
            self.hit_the_ground(speed.max(0.0));
            return;
        }
        let is_steep = self
            .world
            .touched()
            .iter()
            .any(|touch| touch.away.dot(up) > GRAZING);
        let mode = if is_steep || self.is_beside_slope() {
            ClimberMode::Sliding
        } else {
            ClimberMode::Falling
        };
        self.change_to(mode);
    }

    /// Who slides goes on sliding as long as the slope is within the skin width.
    fn is_beside_slope(&mut self) -> bool {
        if self.state.mode != ClimberMode::Sliding {
            return false;
        }
        let up = self.config.up();
        let mut body = super::body(self.config, &self.state);
        body.radius += self.config.body.skin_width;
        let is_slope = |touch: &Touch| touch.away.dot(up) > GRAZING;
        self.world.touching(&body).iter().any(is_slope)
    }

    /// Bounces, slides to a halt, and gets up once it has lain still.
    fn lie(&mut self, falling: DVec3) {
        let Some(tumble) = &self.config.tumble else {
            self.change_to(ClimberMode::Falling);
            return;
        };
        let slope = self.config.ground.max_slope;
        let Some(touch) = self.held_up_by(slope) else {
            self.state.calm = 0.0;
            return;
        };
        let ground = self.world.velocity_of(&touch);
        let speed = -(falling - ground).dot(touch.away);
        if speed > BOUNCE {
            self.state.velocity += touch.away * (speed * tumble.restitution);
            self.hurt_by_fall(speed);
        }
        let along = self.state.velocity - ground;
        let sliding = along - touch.away * along.dot(touch.away);
        let braked = tumble.friction * self.config.gravity.length() * self.dt();
        let left = (sliding.length() - braked).max(0.0);
        self.state.velocity += sliding.normalize_or_zero() * left - sliding;
        let rest = (self.state.velocity - ground).length();
        self.state.calm = if rest < STILL {
            self.state.calm + self.dt()
        } else {
            0.0
        };
        if self.state.calm >= tumble.recover_time {
            self.attach(&touch);
            self.state.velocity = ground;
            self.change_to(ClimberMode::Standing);
            self.state.calm = 0.0;
        }
    }
}

/// Cosine of the angle from up at which a wall is a slope.
pub(super) const GRAZING: f64 = 0.05;

/// What comes down more slowly does not bounce, metres a second.
const BOUNCE: f64 = 0.5;

/// Slower than this, relative to the ground, is lying still, metres a second.
const STILL: f64 = 0.5;
