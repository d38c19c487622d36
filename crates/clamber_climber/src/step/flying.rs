//! Falling, sliding and tumbling: motion under gravity, with contacts.

use clamber_mover::{Ground, MoverContact};
use glam::DVec3;

use super::ground::GRAZING_COSINE;
use super::moving::{Intent, towards};
use super::{LEAST_LEVEL_PART, NextMode, Tick};
use crate::{ClimberConfig, ClimberEvent, ClimberMode};

/// Multiple of the speed that gravity adds in a tick, up to which a contact is no impact.
const REST_SPEED_FACTOR: f64 = 1.5;

/// Time for which a tumbling body that does not come to rest stays down after it first touched ground, in addition to
/// the recovery time, seconds. Otherwise a body without friction would slide on endlessly.
const STAYS_DOWN: f64 = 6.0;

/// Largest share of gravity along a steep slope that friction takes away.
const MAX_SLOPE_BRAKE: f64 = 0.9;

/// Cosine from up of the normal of refused ground, above which the ground is too level for steering to keep off it: 4
/// degrees.
const LEVEL_NORMAL_COSINE: f64 = 0.9975;

/// Factor of [`slow_speed`] on the square root of gravity times radius: slower contacts do not bounce.
const SLOW_SPEED_FACTOR: f64 = 0.25;

/// Memory of a climber that is in the air or slides: whether it rises from a jump. The climber's step sets this memory;
/// a game only stores it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct FlyingMemory {
    /// True while the climber rises from a jump.
    pub jumping: bool,
}

/// Memory of a climber that tumbles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct TumblingMemory {
    /// Time for which the climber has lain still, seconds.
    pub still: f64,
    /// Time since the climber first touched ground that can be stood on, seconds.
    pub down: f64,
}

/// A speed that is slow for a body of this size under this gravity, metres a second: 0.5 for a radius of 0.4 m.
pub(crate) fn slow_speed(config: &ClimberConfig) -> f64 {
    SLOW_SPEED_FACTOR * libm::sqrt(config.gravity.length() * config.body.radius)
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
        // Grips after the movement, when the climber's position and the obstacles' positions are of the same time.
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
        let steered = towards(along, wanted, ground.air_acceleration * self.dt());
        let change = self.off_steep_slopes(steered - along);
        self.state.velocity += change;
    }

    /// A level change of velocity without the component into slopes that are too steep to stand on: the slopes would
    /// deflect it upwards, and the climber would climb them. (Unreal's `LimitAirControl` and Jolt's sample do the
    /// same.)
    fn off_steep_slopes(&mut self, change: DVec3) -> DVec3 {
        let (up, body) = (self.config.up(), self.body());
        let limit = self.standing_slope();
        let here = self.state.position + self.state.base_velocity * self.dt();
        self.mover.overlap(&body, here, body.margin);
        let is_steep =
            |normal: DVec3| self.config.slope(normal) > limit && normal.dot(up) > GRAZING_COSINE;
        // Ground that the rule refuses counts as a slope as well, where it is not level.
        let leans = |normal: DVec3| (GRAZING_COSINE..LEVEL_NORMAL_COSINE).contains(&normal.dot(up));
        let slopes = || {
            // A slope needs two steep normals: the edge of a step is no slope.
            let touches = self.mover.overlaps().iter();
            touches
                .filter(|touch| {
                    let is_slope = is_steep(touch.normal) && is_steep(touch.contact.normal);
                    is_slope || leans(touch.normal) && self.is_refused(touch)
                })
                .map(|touch| (touch.normal - up * touch.normal.dot(up)).normalize_or_zero())
        };
        let kept = slopes().fold(change, |kept, level| {
            kept - level * kept.dot(level).min(0.0)
        });
        // Between two slopes, a change along one leads into the other.
        let leads_into = |level: DVec3| kept.dot(level) < -LEAST_LEVEL_PART * change.length();
        if slopes().any(leads_into) {
            DVec3::ZERO
        } else {
            kept
        }
    }

    /// Moves the body through one tick of free fall. Returns the velocity that the body would have had without
    /// contacts.
    ///
    /// Positions are exactly on the parabola at each tick's end: the acceleration is constant over the tick.
    fn fall(&mut self) -> DVec3 {
        self.motion.has_flown = true;
        let (up, dt) = (self.config.up(), self.dt());
        let rising = (self.state.velocity - self.state.base_velocity).dot(up) > 0.0;
        self.state.flying.jumping &= rising;
        let weight = if self.state.flying.jumping && !self.input.jump_held {
            self.config.ground.jump_release_gravity
        } else {
            1.0
        };
        let change = self.limited_by_air(self.config.gravity * (weight * dt));
        let target = self.state.position + (self.state.velocity + change * 0.5) * dt;
        let falling = self.state.velocity + change;
        self.motion.flew_at = Some(falling);
        let moved = self.slide_at(&self.path(target), Intent::Go, falling);
        self.state.position = moved.position;
        self.state.velocity = self.clipped_after_hits(falling);
        if self.state.mode == ClimberMode::Sliding {
            self.be_braked_by_slope(falling);
        }
        // Gravity has no reaction on a support, and the obstacles that were hit have already got their impulses.
        self.rides = self.state.velocity;
        self.be_hurt_by_impact(falling);
        falling
    }

    /// The change of velocity by gravity in a tick, less the part that the air takes from a fall at the terminal speed.
    fn limited_by_air(&self, change: DVec3) -> DVec3 {
        let down = change.normalize_or_zero();
        let most = self.config.ground.terminal_speed;
        let speed = (self.state.velocity - self.judge.rules.air_velocity).dot(down);
        let gained = change.length();
        let after = if speed > most {
            (speed - gained).max(most)
        } else {
            (speed + gained).min(most)
        };
        if after == speed + gained {
            change
        } else {
            down * (after - speed)
        }
    }

    /// Brakes a body on slopes that are too steep to stand on. Friction takes the speed that the contact takes from the
    /// fall, times the coefficient of friction. Down the slope it takes less than gravity adds, so that the body never
    /// comes to rest where it cannot stand.
    fn be_braked_by_slope(&mut self, falling: DVec3) {
        let usual = self.config.ground.slide_friction;
        if usual == 0.0 {
            return;
        }
        let (up, dt) = (self.config.up(), self.dt());
        let slopes = self.mover.touched().iter();
        let slope = slopes.copied().reduce(|best, touch| {
            if touch.normal.dot(up) > best.normal.dot(up) {
                touch
            } else {
                best
            }
        });
        let Some(touch) = slope.filter(|touch| touch.normal.dot(up) > GRAZING_COSINE) else {
            return;
        };
        let friction = usual * self.friction_of(&touch);
        let own = self.state.velocity - self.mover.velocity_of(&touch);
        let along = own - touch.normal * own.dot(touch.normal);
        let pressed = (self.state.velocity - falling).dot(touch.normal).max(0.0);
        let gravity = self.config.gravity * dt;
        let pull = gravity - touch.normal * gravity.dot(touch.normal);
        let leads_down = along.dot(pull) > 0.0;
        let braked = if leads_down {
            (friction * pressed).min(MAX_SLOPE_BRAKE * pull.length())
        } else {
            friction * pressed
        };
        self.rub(&touch, along, braked);
    }

    /// Costs hit points for the hardest impact of the last movement, by its speed along the contact's normal: on
    /// ground, slopes, walls and ceilings alike.
    fn be_hurt_by_impact(&mut self, falling: DVec3) {
        if self.config.health.is_none() {
            return;
        }
        let touched = self.mover.touched().iter();
        let speeds = touched
            .filter(|touch| !self.hit_before(touch))
            .map(|touch| {
                let own = falling - self.mover.velocity_of(touch);
                -own.dot(touch.normal)
            });
        let speed = speeds.fold(0.0, f64::max);
        // A body that rests or slides meets its ground at the speed that gravity adds in a tick.
        if speed > REST_SPEED_FACTOR * self.config.gravity.length() * self.dt() {
            self.hurt_by_fall(speed);
        }
    }

    pub(super) fn friction_of(&self, touch: &MoverContact) -> f64 {
        if self.judge.rules.contact.is_none() {
            return 1.0;
        }
        self.judge.rule_of(touch).usable_friction()
    }

    /// [`slow_speed`] of the climber.
    pub(super) fn slow(&self) -> f64 {
        slow_speed(self.config)
    }

    /// Stands on the ground that the climber came down on, or slides down it. A crushed climber does neither.
    fn land(&mut self, falling: DVec3) -> NextMode {
        if self.state.crushed {
            return NextMode::Stay;
        }
        if let Some(ground) = self.ground_met(falling) {
            return self.land_on(&ground, falling);
        }
        let up = self.config.up();
        let mut touched = self.mover.touched().iter();
        let is_steep = touched
            .any(|touch| touch.normal.dot(up) > GRAZING_COSINE && !self.leaves(touch, falling));
        let was_sliding = self.state.mode == ClimberMode::Sliding;
        let is_sliding = is_steep || was_sliding && self.is_beside_slope(self.state.position);
        match (is_sliding, was_sliding) {
            (true, false) => NextMode::Change(ClimberMode::Sliding),
            (false, true) => NextMode::Change(ClimberMode::Falling),
            _ => NextMode::Stay,
        }
    }

    /// The ground that the climber came down on. Ground that it leaves does not count: a climber that jumps may still
    /// touch another one that is pressed into it from below.
    fn ground_met(&mut self, falling: DVec3) -> Option<Ground> {
        let slope = self.config.ground.max_slope;
        let ground = self.held_up(self.state.position, slope)?;
        (!self.leaves(&ground.touch, falling)).then_some(ground)
    }

    /// True if the climber moves away from a contact, both at the velocity `falling`, which contacts have not clipped,
    /// and at its velocity now.
    fn leaves(&self, touch: &MoverContact, falling: DVec3) -> bool {
        let up = self.config.up();
        let obstacle = self.mover.obstacle(touch.obstacle);
        let other = obstacle.and_then(|obstacle| obstacle.character());
        // The velocity of another climber's material does not include the other's own rise.
        let (rises, least) = other.map_or((0.0, self.slow()), |other| {
            (other.own_velocity.dot(up).max(0.0), 0.0)
        });
        let of_material = self.mover.velocity_of(touch) + up * rises;
        let away = |own: DVec3| (own - of_material).dot(touch.normal) > least;
        away(falling) && away(self.state.velocity)
    }

    /// Lands on ground, and keeps the speed along the ground.
    fn land_on(&mut self, ground: &Ground, falling: DVec3) -> NextMode {
        let touch = &ground.touch;
        let ground_velocity = self.mover.velocity_of(touch);
        let own = falling - ground_velocity;
        let speed = (-own.dot(touch.normal)).max(0.0);
        let along = own - touch.normal * own.dot(touch.normal);
        self.state.position = ground.position;
        self.attach(touch, ground.position);
        // An obstacle that gives way and the climber go on at one speed.
        self.state.base_velocity +=
            self.velocity_after_hit(touch, ground_velocity) - ground_velocity;
        self.state.velocity = self.clipped(self.state.base_velocity + along);
        self.event(ClimberEvent::Landed {
            obstacle: touch.obstacle,
            speed,
        });
        self.change_to(ClimberMode::Standing);
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
        if self.state.tumbling.down > 0.0 {
            self.state.tumbling.down += self.dt();
        }
        let held_up = self.ground_met(falling);
        // A crushed climber does not get up.
        let Some(ground) = held_up.filter(|_| !self.state.crushed) else {
            self.state.tumbling.still = 0.0;
            return NextMode::Stay;
        };
        let touch = &ground.touch;
        if self.state.tumbling.down == 0.0 {
            self.state.tumbling.down = self.dt();
        }
        self.state.position = ground.position;
        let base = self.mover.velocity_of(touch);
        let speed = -(falling - base).dot(touch.normal);
        let slow = self
            .slow()
            .max(REST_SPEED_FACTOR * self.config.gravity.length() * self.dt());
        if speed > slow {
            self.bounce(touch, speed * tumble.restitution);
        }
        let along = self.state.velocity - base;
        let sliding = along - touch.normal * along.dot(touch.normal);
        let friction = tumble.friction * self.friction_of(touch);
        let braked = friction * self.config.gravity.length() * self.dt();
        let left = self.rub(touch, sliding, braked);
        let rest = (self.state.velocity - base).length();
        self.state.tumbling.still = if rest < slow {
            self.state.tumbling.still + self.dt()
        } else {
            0.0
        };
        self.state.base_velocity = base;
        let stays_down = self.state.tumbling.down < tumble.recover_time + STAYS_DOWN;
        if self.state.tumbling.still < tumble.recover_time && stays_down {
            return NextMode::Stay;
        }
        self.attach(touch, ground.position);
        // The feet brake the rest of the slide.
        self.state.velocity = self.state.base_velocity + sliding.clamp_length_max(left);
        NextMode::Change(ClimberMode::Standing)
    }
}
