//! Falling, sliding and tumbling: motion under gravity, with contacts.

use clamber_mover::Ground;
use glam::DVec3;

use super::ground::GRAZING;
use super::moving::Intent;
use super::{NextMode, Tick};
use crate::{ClimberEvent, ClimberMode};

/// A tumbling body bounces if its impact speed is above this share of the speed of a jump.
const BOUNCE: f64 = 0.1;

/// A tumbling body lies still if its speed relative to the ground is below this share of the speed of a jump.
const STILL: f64 = 0.1;

/// Memory of a climber that is in the air or slides: whether it rises from a jump. The climber's step sets it; a game
/// only stores it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct FlyingMemory {
    /// True while it rises from a jump.
    pub jumping: bool,
}

/// Memory of a climber that tumbles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct TumblingMemory {
    /// How long it has lain still, seconds.
    pub still: f64,
}

impl Tick<'_> {
    /// Falls, or slides down ground that is too steep.
    pub(super) fn fly(&mut self) -> NextMode {
        if self.state.coyote > 0.0 && self.state.jump_buffer > 0.0 {
            self.jump_late();
            if self.state.mode != ClimberMode::Falling {
                return NextMode::Change(ClimberMode::Falling);
            }
        }
        self.steer();
        let falling = self.fall();
        // After the movement: its position and those of the obstacles are then of the same time.
        match self.grip_or_catch() {
            Some(next) => next,
            None => self.land(falling),
        }
    }

    /// Jumps shortly after the ground has ended.
    fn jump_late(&mut self) {
        let up = self.config.up();
        let rising = (self.state.velocity - self.state.base_velocity).dot(up);
        let jump = self.config.ground.jump_speed;
        self.state.velocity += up * (jump + rising.max(0.0) - rising);
        self.begin_jump();
    }

    /// Changes the velocity in the air as the input asks.
    fn steer(&mut self) {
        let ground = &self.config.ground;
        let up = self.config.up();
        let walk = self.input.walk;
        let level = (walk - up * walk.dot(up)).clamp_length_max(1.0);
        if ground.air_acceleration == 0.0 || level == DVec3::ZERO {
            return;
        }
        let own = self.state.velocity - self.state.base_velocity;
        let along = own - up * own.dot(up);
        let wanted = level * ground.walk_speed;
        let steered = along.move_towards(wanted, ground.air_acceleration * self.dt());
        self.state.velocity += steered - along;
    }

    /// Moves the body through one tick of free fall. Returns the velocity that it would have had without contacts.
    ///
    /// Positions are exactly on the parabola at each tick's end: the acceleration is constant over the tick.
    fn fall(&mut self) -> DVec3 {
        self.has_flown = true;
        let (up, dt) = (self.config.up(), self.dt());
        let rising = (self.state.velocity - self.state.base_velocity).dot(up) > 0.0;
        self.state.flying.jumping &= rising;
        let weight = if self.state.flying.jumping && !self.input.jump_held {
            self.config.ground.jump_release_gravity
        } else {
            1.0
        };
        let change = self.config.gravity * (weight * dt);
        let target = self.state.position + (self.state.velocity + change * 0.5) * dt;
        let falling = self.state.velocity + change;
        let moved = self.slide_at(&self.path(target), Intent::Go, falling);
        self.state.position = moved.position;
        self.state.velocity = self.clipped(falling);
        falling
    }

    /// Stands on the ground that it came down on, or slides down it. A crushed climber does neither.
    fn land(&mut self, falling: DVec3) -> NextMode {
        if self.state.crushed {
            return NextMode::Stay;
        }
        let slope = self.config.ground.max_slope;
        if let Some(ground) = self.held_up(self.state.position, slope) {
            return self.land_on(&ground, falling);
        }
        let up = self.config.up();
        let touched = self.mover.touched();
        let is_steep = touched.iter().any(|touch| touch.normal.dot(up) > GRAZING);
        let was_sliding = self.state.mode == ClimberMode::Sliding;
        let is_sliding = is_steep || was_sliding && self.is_beside_slope(self.state.position);
        match (is_sliding, was_sliding) {
            (true, false) => NextMode::Change(ClimberMode::Sliding),
            (false, true) => NextMode::Change(ClimberMode::Falling),
            _ => NextMode::Stay,
        }
    }

    /// Lands on ground, and keeps its speed along it.
    fn land_on(&mut self, ground: &Ground, falling: DVec3) -> NextMode {
        let touch = &ground.touch;
        let own = falling - self.mover.velocity_of(touch);
        let speed = (-own.dot(touch.normal)).max(0.0);
        let along = own - touch.normal * own.dot(touch.normal);
        self.state.position = ground.position;
        self.attach(touch, ground.position);
        self.state.velocity = self.clipped(self.state.base_velocity + along);
        self.event(ClimberEvent::Landed {
            obstacle: touch.obstacle,
            speed,
        });
        self.change_to(ClimberMode::Standing);
        self.hurt_by_fall(speed);
        let falls_over = self
            .config
            .tumble
            .is_some_and(|tumble| speed.max(along.length()) > tumble.landing_speed);
        if falls_over {
            return self.begin_tumbling(None);
        }
        NextMode::Stay
    }

    /// Falls, bounces and slides to a halt, and gets up once it has lain still.
    pub(super) fn tumble(&mut self) -> NextMode {
        let Some(tumble) = self.config.tumble else {
            return NextMode::Change(ClimberMode::Falling);
        };
        let falling = self.fall();
        let slope = self.config.ground.max_slope;
        let held_up = self.held_up(self.state.position, slope);
        // A crushed climber does not get up.
        let Some(ground) = held_up.filter(|_| !self.state.crushed) else {
            self.state.tumbling.still = 0.0;
            return NextMode::Stay;
        };
        let touch = &ground.touch;
        let jump = self.config.ground.jump_speed;
        self.state.position = ground.position;
        let base = self.mover.velocity_of(touch);
        let speed = -(falling - base).dot(touch.normal);
        if speed > BOUNCE * jump {
            self.state.velocity += touch.normal * (speed * tumble.restitution);
            self.hurt_by_fall(speed);
        }
        let along = self.state.velocity - base;
        let sliding = along - touch.normal * along.dot(touch.normal);
        let braked = tumble.friction * self.config.gravity.length() * self.dt();
        let left = (sliding.length() - braked).max(0.0);
        self.state.velocity += sliding.normalize_or_zero() * left - sliding;
        let rest = (self.state.velocity - base).length();
        self.state.tumbling.still = if rest < STILL * jump {
            self.state.tumbling.still + self.dt()
        } else {
            0.0
        };
        self.state.base_velocity = base;
        if self.state.tumbling.still < tumble.recover_time {
            return NextMode::Stay;
        }
        self.attach(touch, ground.position);
        self.state.velocity = self.state.base_velocity;
        NextMode::Change(ClimberMode::Standing)
    }
}
