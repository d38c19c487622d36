//! Crouched on what it grips.

use clamber_world::WorldCapsule;
use glam::{DQuat, DVec3};

use super::{Carried, Step};
use crate::config::GripConfig;
use crate::mover::Touch;
use crate::{ClimberEvent, ClimberMode, Support};

/// How fast arms draw the body to what they grip, metres a second.
const DRAW_SPEED: f64 = 4.0;

/// After a jump off a hold, or after letting go, it grips nothing for so many seconds.
pub(super) const OPEN_HANDED: f64 = 0.3;

/// What is this much farther than the nearest, metres, is as near: of those it grips what it climbs towards.
const AS_NEAR: f64 = 0.02;

/// Faces that differ by more than this meet in a corner, radians: 40 degrees.
const CORNER: f64 = 0.7;

/// Cosine of the angle up to which it lies flat on a face: 10 degrees.
const FLAT: f64 = 0.985;

/// Who makes less than this share of a step upwards is as high as the hold goes, and looks for a ledge.
const STUCK: f64 = 0.25;

/// What opposes its way by more than this cosine is climbed onto rather than along.
const AHEAD: f64 = 0.3;

impl Step<'_> {
    /// Grips what is in reach, if it is asked to and has the strength: true if it does now.
    pub(super) fn grip_or_catch(&mut self) -> bool {
        if !self.input.grip || self.state.stamina == 0.0 || self.state.open_handed > 0.0 {
            return false;
        }
        if let Some(grip) = self.config.grip
            && let Some(touch) = self.grip_near(self.state.position, &grip, None)
        {
            self.take_hold(&touch);
            self.hold();
            return true;
        }
        self.catch_ledge()
    }

    /// Grips something.
    pub(super) fn take_hold(&mut self, touch: &Touch) {
        self.attach(touch);
        self.face(-touch.away);
        self.event(ClimberEvent::Grabbed {
            obstacle: touch.obstacle,
            point: touch.contact.point,
        });
        self.change_to(ClimberMode::Holding);
    }

    pub(super) fn hold(&mut self) {
        let Some(grip) = self.config.grip else {
            self.leave(ClimberMode::Falling);
            return self.fly();
        };
        let was = self.state.velocity;
        let Some(carried) = self.carry() else {
            self.event(ClimberEvent::LostFooting);
            self.leave(ClimberMode::Falling);
            return self.fly();
        };
        let normal = carried.support.normal_in_world();
        if !self.input.grip {
            return self.let_go(&carried, was);
        }
        if self.state.jump_buffer > 0.0 {
            return self.jump_off(normal, grip.jump_speed);
        }
        let leans_over = self.config.slope(normal) > grip.max_overhang;
        if leans_over || self.state.shake.length() > grip.hang_acceleration {
            self.change_to(ClimberMode::Hanging);
            self.state.calm = 0.0;
            return self.swing(&carried, carried.motion.velocity, DVec3::ZERO);
        }
        let wish = self.climb_direction(normal);
        self.climb(&carried, &grip, wish);
    }

    /// Opens its hands.
    fn let_go(&mut self, carried: &Carried, was: DVec3) {
        self.event(ClimberEvent::Released);
        let normal = carried.support.normal_in_world();
        if self.config.slope(normal) <= self.config.ground.max_slope {
            self.change_to(ClimberMode::Standing);
            self.stand_carried(carried, was);
        } else {
            self.state.open_handed = OPEN_HANDED;
            self.leave(ClimberMode::Falling);
            self.fly();
        }
    }

    /// Away from its hold, and up.
    pub(super) fn jump_off(&mut self, normal: DVec3, speed: f64) {
        let up = self.config.up();
        let direction = (normal + up).normalize_or(normal);
        self.state.velocity += direction * speed;
        self.event(ClimberEvent::Jumped);
        self.state.jump_buffer = 0.0;
        self.state.coyote = 0.0;
        self.state.open_handed = OPEN_HANDED;
        self.leave(ClimberMode::Falling);
        self.fly();
    }

    /// Where the input wants to go along a hold; its length is the share of full speed.
    pub(super) fn climb_direction(&self, normal: DVec3) -> DVec3 {
        let up = self.config.up();
        let input = self.input;
        let (wanted, share) = if input.climb == DVec3::ZERO {
            let level = input.walk - up * input.walk.dot(up);
            (turn_to(up, normal) * level, level.length().min(1.0))
        } else {
            (input.climb, input.climb.length().min(1.0))
        };
        let along = wanted - normal * wanted.dot(normal);
        along.normalize_or_zero() * share
    }

    fn climb(&mut self, carried: &Carried, grip: &GripConfig, wish: DVec3) {
        let dt = self.dt();
        let normal = carried.support.normal_in_world();
        let offset = carried.position - carried.support.contact;
        let too_far = (offset.dot(normal) - self.config.body.radius).max(0.0);
        let drawn = normal * too_far.min(DRAW_SPEED * dt);
        let target = carried.position + wish * (grip.climb_speed * dt) - drawn;
        let moved = self.slide(carried.start, target, carried.swept);
        if wish == DVec3::ZERO && moved.position.distance(target) <= self.config.body.skin_width {
            self.settle(carried, moved.position);
            return;
        }
        self.state.position = moved.position;
        let step = wish * (grip.climb_speed * dt);
        let made = (moved.position - carried.position).dot(wish.normalize_or_zero());
        let is_stuck = made < STUCK * step.length();
        if is_stuck && wish.dot(self.config.up()) > 0.0 && self.catch_ledge() {
            return;
        }
        if let Some(touch) = self.grip_near(moved.position, grip, Some(normal)) {
            self.climb_on_to(carried, &touch);
            self.state.velocity =
                carried.motion.velocity + (moved.position - carried.position) / dt;
            self.face(-touch.away);
            return;
        }
        if let Some(touch) = self.held_up_by(self.config.ground.max_slope) {
            self.attach(&touch);
            self.change_to(ClimberMode::Standing);
            return;
        }
        if self.catch_ledge() {
            return;
        }
        // Nothing to grip there: it stays.
        let moved = self.slide(carried.start, carried.position, carried.swept);
        self.settle(carried, moved.position);
    }

    /// Keeps what it holds, at a position.
    pub(super) fn settle(&mut self, carried: &Carried, position: DVec3) {
        let support = &carried.support;
        self.state.position = position;
        self.state.support = Some(Support {
            offset: support.frame.conjugate() * (position - support.contact),
            ..*support
        });
        self.state.velocity = carried.motion.velocity + (position - carried.position) / self.dt();
    }

    /// What it grips at a position: the nearest that can be gripped, and of those as near the one that it climbs onto:
    /// against which it pushes, and which does not lead it back against what it `holds` now, in a crease.
    pub(super) fn grip_near(
        &mut self,
        position: DVec3,
        grip: &GripConfig,
        holds: Option<DVec3>,
    ) -> Option<Touch> {
        let reach = self.config.body.radius + grip.reach;
        self.world.touching(&WorldCapsule::ball(position, reach));
        let mut nearest = f64::INFINITY;
        for index in 0..self.world.found().len() {
            let touch = self.world.found()[index];
            if touch.contact.distance < nearest && self.world.can_grip(&touch) {
                nearest = touch.contact.distance;
            }
        }
        let mut best: Option<(f64, Touch)> = None;
        for index in 0..self.world.found().len() {
            let touch = self.world.found()[index];
            if touch.contact.distance > nearest + AS_NEAR || !self.world.can_grip(&touch) {
                continue;
            }
            let ahead = holds.map_or(0.0, |normal| self.leads_on(normal, touch.away));
            let cost = touch.contact.distance - nearest - ahead * AS_NEAR * 2.0;
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, touch));
            }
        }
        best.map(|(_, touch)| touch)
    }

    /// How much more than a little it pushes against one face while it holds another, if the other does not push it
    /// back.
    fn leads_on(&self, held: DVec3, face: DVec3) -> f64 {
        let wish = self.climb_direction(held);
        let beyond = self.climb_direction(face);
        let leads_back = beyond.dot(held) < -AHEAD;
        if leads_back {
            0.0
        } else {
            (-face.dot(wish) - AHEAD).max(0.0)
        }
    }

    /// Attaches it to what it climbs on to. A corner is turned when it lies flat on a face that differs from the last.
    fn climb_on_to(&mut self, carried: &Carried, touch: &Touch) {
        let face = carried.support.frame * carried.support.face;
        self.attach(touch);
        let lies_flat = touch.away.dot(touch.contact.normal) > FLAT;
        let Some(support) = &mut self.state.support else {
            return;
        };
        if !lies_flat {
            support.face = support.frame.conjugate() * face;
            return;
        }
        let angle = libm::acos(face.dot(touch.contact.normal).clamp(-1.0, 1.0));
        if angle > CORNER {
            self.event(ClimberEvent::TurnedCorner { angle });
        }
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
