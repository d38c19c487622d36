//! Gripping a hold and climbing on it.

use clamber_mover::MoverContact;
use glam::{DQuat, DVec3};

use super::carrying::Carried;
use super::moving::Intent;
use super::{NextMode, Tick};
use crate::config::GripConfig;
use crate::{ClimberEvent, ClimberInput, ClimberMode};

/// Speed at which arms draw the body to its hold, as a multiple of the climbing speed.
const DRAW_SPEED_FACTOR: f64 = 8.0 / 3.0;

/// Longest time in which arms draw the body over the length of its radius, seconds: at least 1 m/s for a radius of 0.4
/// m. It counts for a climber that climbs slowly or not at all.
const DRAW_TIME: f64 = 0.4;

/// Time for which the climber grips nothing after it jumped off a hold, let go or was torn off, seconds.
pub(super) const GRIP_COOLDOWN: f64 = 0.3;

/// Angle between the normals of two faces, above which they meet in a corner, radians: 40 degrees.
const CORNER_ANGLE: f64 = 0.7;

/// Cosine of the largest angle between a face's normal and the separation normal at which the climber lies flat on the
/// face: 10 degrees.
const FLAT_ON_FACE_COSINE: f64 = 0.985;

/// Share of an upward step below which a climber is at the top of its hold, and looks for a ledge.
const STUCK_STEP_SHARE: f64 = 0.25;

/// Share of the input along the hold above which the climber climbs at full speed. Below, it climbs more slowly.
const FULL_SPEED_INPUT: f64 = 0.1;

/// Cosine from up of a hold's normal, below which the hold is a ceiling: it leans over by more than 45 degrees.
const CEILING_COSINE: f64 = -0.707;

/// Length of the sum of a hold's normal and up, below which a jump goes straight away from the hold: off ceilings
/// within 6 degrees of level. There, rounding and bumps decide the direction of the sum.
const STRAIGHT_JUMP_LENGTH: f64 = 0.1;

/// Cosine of the angle by which a held stick may turn before its direction is taken anew: 20 degrees.
const HELD_STILL: f64 = 0.939_692_620_785_908_4;

/// Memory of a climber that climbs by [`ClimberInput::walk`]: the direction along its hold that the stick asks for.
///
/// The direction is found when the stick is pressed, or turned by more than 20 degrees. While the stick is held, the
/// direction follows the hold's normal, over bumps and round edges, by the shortest rotation (parallel transport). All
/// fields are zero without a held stick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct HoldingMemory {
    /// The stick's direction when `along` was found: a level unit vector in world space.
    pub stick: DVec3,
    /// Direction in which the climber climbs: a unit vector in world space, perpendicular to `normal`.
    pub along: DVec3,
    /// Normal of the hold in the last tick: a unit vector in world space.
    pub normal: DVec3,
}

/// Cosine by which a face has to oppose the input's direction for the climber to climb onto it, not along it.
const AHEAD_COSINE: f64 = 0.3;

impl Tick<'_> {
    /// Takes hold of the best grip in reach, or catches a ledge, if the input asks for it, stamina is left and the
    /// climber's hands are ready.
    pub(super) fn grip_or_catch(&mut self) -> Option<NextMode> {
        if !self.input.grip || self.state.stamina == 0.0 || self.state.grip_cooldown > 0.0 {
            return None;
        }
        let place = self.place();
        if let Some(grip) = self.config.grip
            && let Some(touch) = self.find_grip(place, &grip, None)
        {
            let catches = self.catches(&touch, grip.catch_speed);
            return catches.then(|| self.take_hold(&touch, place));
        }
        self.catch_ledge(place)
    }

    /// Grips a contact from a position.
    pub(super) fn take_hold(&mut self, touch: &MoverContact, place: DVec3) -> NextMode {
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
        if let Some(next) = self.be_refused_by_hold(self.on.grip) {
            return next;
        }
        if !self.input.grip {
            return self.let_go(&carried);
        }
        if self.state.jump_buffer > 0.0 && self.spend(|stamina| stamina.jump_cost) {
            return self.jump_off(normal, grip.jump_speed);
        }
        let leans_over = self.config.slope(normal) > grip.max_overhang;
        let shakes = self.state.shake.length() > grip.hang_acceleration;
        if leans_over || shakes || self.struck != DVec3::ZERO {
            self.state.hanging.arm = self.config.hang.arm_length;
            return NextMode::Change(ClimberMode::Hanging);
        }
        let wish = self.climb_wish(&carried);
        self.climb(&carried, &grip, wish)
    }

    /// The direction along the hold that the input asks for; its length is the share of full speed.
    fn climb_wish(&mut self, carried: &Carried) -> DVec3 {
        let normal = carried.normal();
        let (up, walk, climb) = (self.config.up(), self.input.walk, self.input.climb);
        let level = walk - up * walk.dot(up);
        let held = std::mem::take(&mut self.state.holding);
        if climb != DVec3::ZERO {
            return projected(climb, normal);
        }
        let Some(stick) = level.try_normalize() else {
            return DVec3::ZERO;
        };
        let turn = carried.motion.turn;
        let memory = if held.stick.dot(stick) > HELD_STILL {
            let along = turn_to(turn * held.normal, normal) * (turn * held.along);
            let along = along - normal * along.dot(normal);
            HoldingMemory {
                stick: held.stick,
                along: along.normalize_or(pressed(up, normal, stick)),
                normal,
            }
        } else {
            HoldingMemory {
                stick,
                along: pressed(up, normal, stick),
                normal,
            }
        };
        self.state.holding = memory;
        memory.along * level.length().min(1.0)
    }

    /// Lets go: stands on ground that is level enough, else falls.
    fn let_go(&mut self, carried: &Carried) -> NextMode {
        self.event(ClimberEvent::Released);
        if self.config.slope(carried.normal()) <= self.config.ground.max_slope {
            return NextMode::Change(ClimberMode::Standing);
        }
        self.state.grip_cooldown = GRIP_COOLDOWN;
        self.leave(ClimberMode::Falling)
    }

    /// Jumps off the hold, away from it and upwards; off a level ceiling, straight down.
    pub(super) fn jump_off(&mut self, normal: DVec3, speed: f64) -> NextMode {
        let up = self.config.up();
        let between = normal + up;
        let direction = if between.length() < STRAIGHT_JUMP_LENGTH {
            normal
        } else {
            between.normalize_or(normal)
        };
        self.state.velocity += direction * speed;
        self.push_off();
        self.begin_jump();
        self.state.grip_cooldown = GRIP_COOLDOWN;
        self.leave(ClimberMode::Falling)
    }

    fn climb(&mut self, carried: &Carried, grip: &GripConfig, wish: DVec3) -> NextMode {
        let dt = self.dt();
        let normal = carried.normal();
        let offset = carried.position - carried.motion.position;
        let too_far = (offset.dot(normal) - self.config.body.radius).max(0.0);
        let drawn = normal * too_far.min(self.draw_speed() * dt);
        self.drawn_up -= drawn.dot(self.config.up()).min(0.0);
        let velocity = wish * (grip.climb_speed / self.slowness()) + self.slip(normal, grip);
        let step = velocity * dt;
        let target = carried.position + step - drawn;
        let intent = if velocity == DVec3::ZERO {
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
        if velocity == DVec3::ZERO && position.distance(target) <= self.config.body.margin {
            self.settle(carried, position, carried.velocity());
            return NextMode::Stay;
        }
        self.state.position = position;
        let wanted = carried.velocity() + velocity;
        let made = (position - carried.position).dot(wish.normalize_or_zero());
        let is_stuck = made < STUCK_STEP_SHARE * step.length();
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
        // There is no grip: the climber stays where it was.
        let moved = self.slide(&self.path(carried.position), Intent::Stay);
        self.settle(carried, moved.position, carried.velocity());
        NextMode::Stay
    }

    /// The velocity at which hands slip down a hold that is slippery, metres a second.
    fn slip(&self, normal: DVec3, grip: &GripConfig) -> DVec3 {
        let missing = 1.0 - self.on.usable_friction();
        let up = self.config.up();
        if missing <= 0.0 {
            return DVec3::ZERO;
        }
        (normal * normal.dot(up) - up) * (missing * grip.climb_speed)
    }

    /// Speed at which arms draw the body, metres a second.
    pub(super) fn draw_speed(&self) -> f64 {
        let climb_speed = self.config.grip.map_or(0.0, |grip| grip.climb_speed);
        (DRAW_SPEED_FACTOR * climb_speed).max(self.config.body.radius / DRAW_TIME)
    }

    /// Largest distance of the body's centre from its hold, metres: arms at full stretch, and some give.
    fn reach(&self, grip: &GripConfig) -> f64 {
        self.config.body.radius * 1.25 + grip.reach
    }

    /// Loses the hold, because an obstacle has pushed the climber farther away than its arms reach, or crushed it.
    pub(super) fn be_torn_off(&mut self, carried: &Carried) -> NextMode {
        self.state.grip_cooldown = GRIP_COOLDOWN;
        // The velocity excludes the push by the obstacle.
        self.state.velocity = carried.velocity();
        self.lose_footing()
    }

    /// Stands on ground among the contacts of the last movement, if one holds the climber up.
    pub(super) fn stand_where_it_hangs(&mut self) -> Option<NextMode> {
        let ground = self.held_up(self.state.position, self.config.ground.max_slope)?;
        self.state.position = ground.position;
        self.attach(&ground.touch, ground.position);
        self.state.velocity = self.state.base_velocity;
        Some(NextMode::Change(ClimberMode::Standing))
    }

    /// The grip at a position: the nearest contact that can be gripped and reached. Among contacts about equally near,
    /// the one that the input pushes against is taken, unless climbing on it leads back against the hold with the
    /// normal `holds`, as in a crease. `None` if there is no grip, or it cannot carry the climber.
    pub(super) fn find_grip(
        &mut self,
        position: DVec3,
        grip: &GripConfig,
        holds: Option<DVec3>,
    ) -> Option<MoverContact> {
        let input = self.input;
        let judge = self.judge;
        let body = self.body();
        let along = self.state.holding.along;
        let holds = holds.map(|held| {
            let wish = match input.climb {
                DVec3::ZERO => along,
                climb => projected(climb, held),
            };
            (held, wish)
        });
        if grip.reach == 0.0 {
            return None;
        }
        let touch = self.mover.find_grip(
            &body,
            position,
            grip.reach,
            |touch| judge.grips(touch),
            |touch| holds.map_or(0.0, |holds| leads_on(input, holds, touch.normal)),
        )?;
        self.carries(&touch).then_some(touch)
    }

    /// Attaches the climber to the contact that it climbs onto. It turns a corner when it lies flat on a face whose
    /// normal differs from the last face's.
    fn climb_on_to(&mut self, carried: &Carried, touch: &MoverContact, position: DVec3) {
        let face = carried.support.attachment.frame * carried.support.face;
        self.attach(touch, position);
        let lies_flat = touch.normal.dot(touch.contact.normal) > FLAT_ON_FACE_COSINE;
        let Some(support) = &mut self.state.support else {
            return;
        };
        if !lies_flat {
            support.face = support.attachment.frame.conjugate() * face;
            return;
        }
        let angle = libm::acos(face.dot(touch.contact.normal).clamp(-1.0, 1.0));
        if angle > CORNER_ANGLE {
            self.event(ClimberEvent::TurnedCorner { angle });
        }
    }
}

/// The direction of [`ClimberInput::climb`] along a hold; its length is the share of full speed.
fn projected(wanted: DVec3, normal: DVec3) -> DVec3 {
    let share = wanted.length().min(1.0);
    let along = wanted - normal * wanted.dot(normal);
    // Input straight into the hold does not move the climber: rounding would decide the direction.
    let fade = (along.length() / (FULL_SPEED_INPUT * wanted.length())).min(1.0);
    along.normalize_or_zero() * if fade.is_finite() { share * fade } else { 0.0 }
}

/// The direction along a hold in which a stick that has just been pressed climbs, a unit vector. `stick` is a level
/// unit vector.
///
/// On walls, the stick is turned with the hold from level ground, so that towards the wall is up. Under ceilings, the
/// axis of this turn changes from one bump to the next, so the stick's own direction is taken.
fn pressed(up: DVec3, normal: DVec3, stick: DVec3) -> DVec3 {
    if normal.dot(up) > CEILING_COSINE {
        turn_to(up, normal) * stick
    } else {
        (stick - normal * stick.dot(normal)).normalize_or_zero()
    }
}

/// Measures how much the input pushes against `face`, beyond a threshold, while the climber climbs in the direction
/// `wish` along a face with the normal `held`. Zero if climbing on `face` would lead back against the held face.
fn leads_on(input: &ClimberInput, (held, wish): (DVec3, DVec3), face: DVec3) -> f64 {
    let beyond = match input.climb {
        DVec3::ZERO => turn_to(held, face) * wish,
        climb => projected(climb, face),
    };
    let leads_back = beyond.dot(held) < -AHEAD_COSINE;
    if leads_back {
        0.0
    } else {
        (-face.dot(wish) - AHEAD_COSINE).max(0.0)
    }
}

/// The shortest rotation from one unit vector to another. If they are opposite, its axis is any perpendicular vector.
fn turn_to(from: DVec3, to: DVec3) -> DQuat {
    let axis = from.cross(to);
    let real = 1.0 + from.dot(to);
    if real < 1e-9 {
        let axis = from.any_orthonormal_vector();
        return DQuat::from_xyzw(axis.x, axis.y, axis.z, 0.0);
    }
    DQuat::from_xyzw(axis.x, axis.y, axis.z, real).normalize()
}
