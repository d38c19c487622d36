//! Crouched on what it grips.

use clamber_mover::Touch;
use glam::{DQuat, DVec3};

use super::carrying::Carried;
use super::moving::Intent;
use super::{NextMode, Tick};
use crate::config::GripConfig;
use crate::{ClimberConfig, ClimberEvent, ClimberInput, ClimberMode};

/// How fast arms draw the body to what they grip, as a share of the climbing speed.
const DRAW: f64 = 8.0 / 3.0;

/// After a jump off a hold, or after letting go, it grips nothing for so many seconds.
pub(super) const OPEN_HANDED: f64 = 0.3;

/// Faces that differ by more than this meet in a corner, radians: 40 degrees.
const CORNER: f64 = 0.7;

/// Cosine of the angle up to which it lies flat on a face: 10 degrees.
const FLAT: f64 = 0.985;

/// A climber that makes less than this share of a step upwards is as high as the hold goes, and looks for a ledge.
const STUCK: f64 = 0.25;

/// With this share of its input along the hold it climbs at full speed; with less slower.
const FULL: f64 = 0.1;

/// What opposes its way by more than this cosine is climbed onto rather than along.
const AHEAD: f64 = 0.3;

impl Tick<'_> {
    /// Grips what is in reach, or catches a ledge, if it is asked to and has the strength.
    pub(super) fn grip_or_catch(&mut self) -> Option<NextMode> {
        if !self.input.grip || self.state.stamina == 0.0 || self.state.open_handed > 0.0 {
            return None;
        }
        let place = self.place();
        if let Some(grip) = self.config.grip
            && let Some(touch) = self.find_grip(place, &grip, None)
        {
            return Some(self.take_hold(&touch, place));
        }
        self.catch_ledge(place)
    }

    /// Grips something from a position.
    pub(super) fn take_hold(&mut self, touch: &Touch, place: DVec3) -> NextMode {
        self.attach(touch, place);
        self.face(-touch.normal);
        self.state.velocity = self.state.base_velocity;
        self.event(ClimberEvent::Grabbed {
            obstacle: touch.obstacle,
            point: touch.contact.point,
        });
        NextMode::Change(ClimberMode::Holding)
    }

    pub(super) fn hold(&mut self) -> NextMode {
        let (Some(grip), Some(carried)) = (self.config.grip, self.carried) else {
            return self.leave(ClimberMode::Falling);
        };
        let normal = carried.normal();
        if !self.input.grip {
            return self.let_go(&carried);
        }
        if self.state.jump_buffer > 0.0 {
            return self.jump_off(normal, grip.jump_speed);
        }
        let leans_over = self.config.slope(normal) > grip.max_overhang;
        let shakes = self.state.shake.length() > grip.hang_acceleration;
        if leans_over || shakes || self.struck != DVec3::ZERO {
            self.state.hanging.arm = self.config.hang.arm_length;
            return NextMode::Change(ClimberMode::Hanging);
        }
        let wish = climb_direction(self.config, self.input, normal);
        self.climb(&carried, &grip, wish)
    }

    /// Opens its hands.
    fn let_go(&mut self, carried: &Carried) -> NextMode {
        self.event(ClimberEvent::Released);
        if self.config.slope(carried.normal()) <= self.config.ground.max_slope {
            return NextMode::Change(ClimberMode::Standing);
        }
        self.state.open_handed = OPEN_HANDED;
        self.leave(ClimberMode::Falling)
    }

    /// Away from its hold, and up.
    pub(super) fn jump_off(&mut self, normal: DVec3, speed: f64) -> NextMode {
        let up = self.config.up();
        self.state.velocity += (normal + up).normalize_or(normal) * speed;
        self.begin_jump();
        self.state.open_handed = OPEN_HANDED;
        self.leave(ClimberMode::Falling)
    }

    fn climb(&mut self, carried: &Carried, grip: &GripConfig, wish: DVec3) -> NextMode {
        let dt = self.dt();
        let normal = carried.normal();
        let offset = carried.position - carried.motion.position;
        let too_far = (offset.dot(normal) - self.config.body.radius).max(0.0);
        let drawn = normal * too_far.min(DRAW * grip.climb_speed * dt);
        let velocity = wish * grip.climb_speed;
        let step = velocity * dt;
        let target = carried.position + step - drawn;
        let intent = if wish == DVec3::ZERO {
            Intent::Stay
        } else {
            Intent::Go
        };
        let moved = self.slide(&self.path(target), intent);
        let position = moved.position;
        if position.distance(carried.motion.position) > self.reach(grip) {
            self.state.position = position;
            return self.be_torn_off(carried);
        }
        if wish == DVec3::ZERO && position.distance(target) <= self.config.body.margin {
            self.settle(carried, position, carried.velocity());
            return NextMode::Stay;
        }
        self.state.position = position;
        let wanted = carried.velocity() + velocity;
        let made = (position - carried.position).dot(wish.normalize_or_zero());
        let is_stuck = made < STUCK * step.length();
        if is_stuck
            && wish.dot(self.config.up()) > 0.0
            && let Some(next) = self.catch_ledge(position)
        {
            return next;
        }
        let clipped = self.clipped(wanted);
        if let Some(touch) = self.find_grip(position, grip, Some(normal)) {
            self.climb_on_to(carried, &touch, position);
            self.state.velocity = clipped;
            self.face(-touch.normal);
            return NextMode::Stay;
        }
        if let Some(next) = self.stand_where_it_hangs() {
            return next;
        }
        if let Some(next) = self.catch_ledge(position) {
            return next;
        }
        // Nothing to grip there: it stays.
        let moved = self.slide(&self.path(carried.position), Intent::Stay);
        self.settle(carried, moved.position, carried.velocity());
        NextMode::Stay
    }

    /// Farthest that its centre may be from what it holds, metres: arms at full stretch, and what they give.
    fn reach(&self, grip: &GripConfig) -> f64 {
        self.config.body.radius * 1.25 + grip.reach
    }

    /// Something has pushed it off, farther than its arms reach.
    pub(super) fn be_torn_off(&mut self, carried: &Carried) -> NextMode {
        self.state.open_handed = OPEN_HANDED;
        // Not with the speed of being pressed out.
        self.state.velocity = carried.velocity();
        self.lose_footing()
    }

    /// What it touches at its place can be stood on: it does.
    pub(super) fn stand_where_it_hangs(&mut self) -> Option<NextMode> {
        let ground = self.held_up(self.state.position, self.config.ground.max_slope)?;
        self.state.position = ground.position;
        self.attach(&ground.touch, ground.position);
        self.state.velocity = self.state.base_velocity;
        Some(NextMode::Change(ClimberMode::Standing))
    }

    /// What it grips at a position: the nearest that can be gripped and reached, and of those as near the one that it
    /// climbs onto: against which it pushes, and which does not lead it back against what it `holds` now, in a crease.
    pub(super) fn find_grip(
        &mut self,
        position: DVec3,
        grip: &GripConfig,
        holds: Option<DVec3>,
    ) -> Option<Touch> {
        let (config, input, rules) = (self.config, self.input, self.rules);
        let body = self.body();
        let touch = self.mover.find_grip(
            &body,
            position,
            grip.reach,
            |touch| (rules.can_grip)(touch.obstacle, &touch.contact),
            |touch| holds.map_or(0.0, |held| leads_on(config, input, held, touch.normal)),
        )?;
        self.carries(&touch).then_some(touch)
    }

    /// Attaches it to what it climbs on to. A corner is turned when it lies flat on a face that differs from the last.
    fn climb_on_to(&mut self, carried: &Carried, touch: &Touch, position: DVec3) {
        let face = carried.support.attachment.frame * carried.support.face;
        self.attach(touch, position);
        let lies_flat = touch.normal.dot(touch.contact.normal) > FLAT;
        let Some(support) = &mut self.state.support else {
            return;
        };
        if !lies_flat {
            support.face = support.attachment.frame.conjugate() * face;
            return;
        }
        let angle = libm::acos(face.dot(touch.contact.normal).clamp(-1.0, 1.0));
        if angle > CORNER {
            self.event(ClimberEvent::TurnedCorner { angle });
        }
    }
}

/// Where the input wants to go along a hold; its length is the share of full speed.
fn climb_direction(config: &ClimberConfig, input: &ClimberInput, normal: DVec3) -> DVec3 {
    let up = config.up();
    let (wanted, share) = if input.climb == DVec3::ZERO {
        let level = input.walk - up * input.walk.dot(up);
        (turn_to(up, normal) * level, level.length().min(1.0))
    } else {
        (input.climb, input.climb.length().min(1.0))
    };
    let along = wanted - normal * wanted.dot(normal);
    // Pushed straight into the hold it goes nowhere: rounding must not decide where.
    let fade = (along.length() / (FULL * wanted.length())).min(1.0);
    along.normalize_or_zero() * if fade.is_finite() { share * fade } else { 0.0 }
}

/// How much more than a little it pushes against one face while it holds another, if the other does not push it
/// back.
fn leads_on(config: &ClimberConfig, input: &ClimberInput, held: DVec3, face: DVec3) -> f64 {
    let wish = climb_direction(config, input, held);
    let beyond = climb_direction(config, input, face);
    let leads_back = beyond.dot(held) < -AHEAD;
    if leads_back {
        0.0
    } else {
        (-face.dot(wish) - AHEAD).max(0.0)
    }
}

/// The shortest rotation from one unit vector to another; about some level axis where they are opposite.
fn turn_to(from: DVec3, to: DVec3) -> DQuat {
    let axis = from.cross(to);
    let real = 1.0 + from.dot(to);
    if real < 1e-9 {
        let axis = from.any_orthonormal_vector();
        return DQuat::from_xyzw(axis.x, axis.y, axis.z, 0.0);
    }
    DQuat::from_xyzw(axis.x, axis.y, axis.z, real).normalize()
}
