//! Hanging from a ledge, climbing along it and over it. Ledges are found by queries, on terrain and on skin alike.

mod drop;
mod pull_up;
mod shimmy;

use clamber_mover::{Ledge, LedgeProbe, Moved};
use glam::DVec3;

use super::carrying::Carried;
use super::holding::GRIP_COOLDOWN;
use super::{NextMode, Tick};
use crate::config::LedgeConfig;
use crate::{ClimberEvent, ClimberMode};

/// Speed at which arms draw the body into place below the ledge, radii a second: 3 m/s for a radius of 0.4 m.
const DRAW_SPEED: f64 = 7.5;

/// Distance from its place, as a fraction of the radius, above which a climber is drawn there before it pulls itself
/// up.
const OUT_OF_PLACE: f64 = 0.1;

/// Largest distance of the hands to the side of where the body hangs, as a fraction of the radius. At a sharp corner,
/// hands hold the edge up to 0.45 aside, plus the distance that a hand leans over an edge.
const MAX_HANDS_ASIDE: f64 = 0.6;

/// Share of the input towards the wall above which the climber pulls itself up. With as much input away from the wall,
/// it climbs down.
const PULL_UP_INPUT: f64 = 0.5;

/// Smallest share of the input along the ledge that moves the climber. Less is the rounding of a wall's normal.
const LEAST_SHIMMY_INPUT: f64 = 1e-3;

/// Cosine of the largest angle by which a stick that has led the climber around a corner may turn and still lead on: 20
/// degrees. It is more than a thumb wavers, and less than a player turns the stick to change the direction.
const HELD_STICK_COSINE: f64 = 0.94;

/// Memory of a climber that hangs from a ledge.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct LedgeHangingMemory {
    /// Progress of a pull-up, 0 (hangs) to 1 (stands on top).
    pub pull_up: f64,
    /// Time for which an obstacle has kept the climber from pulling itself up farther, seconds.
    pub blocked: f64,
    /// True after a pull-up was given up for lack of room, until the input no longer asks for one.
    pub gave_up: bool,
    /// True while the climber goes back to its place below the edge, from a pull-up that was given up or from the top.
    pub returns: bool,
    /// Direction of the input that leads to the climber's right, a level unit vector in world space. Set while the
    /// input has led the climber around a corner, so that the same input leads on; otherwise zero.
    pub right: DVec3,
}

impl Tick<'_> {
    /// Catches the ledge in front of a position, if there is one.
    pub(super) fn catch_ledge(&mut self, place: DVec3) -> Option<NextMode> {
        let config = self.config.ledge?;
        let Ledge { touch, facing, .. } = self.find_ledge(place, self.facing(), &config)?;
        let lift = (touch.contact.point - place).dot(self.config.up()) - config.drop;
        if self.state.mode == ClimberMode::Standing && lift <= 0.0 {
            // The climber would hang no higher than it stands.
            return None;
        }
        if !self.catches(&touch, config.catch_speed) {
            return None;
        }
        self.attach(&touch, place);
        self.face(facing);
        self.state.velocity = self.state.base_velocity;
        self.state.ledge_hanging.pull_up = 0.0;
        self.event(ClimberEvent::LedgeCaught {
            obstacle: touch.obstacle,
            point: touch.contact.point,
        });
        Some(NextMode::Change(ClimberMode::LedgeHanging))
    }

    /// Direction in which the climber looks for a ledge: the direction of `walk`, or the heading without input.
    fn facing(&self) -> DVec3 {
        let up = self.config.up();
        let walk = self.input.walk;
        let level = walk - up * walk.dot(up);
        level.normalize_or(self.state.heading)
    }

    fn ledge_probe(&self, facing: DVec3, config: &LedgeConfig) -> LedgeProbe {
        LedgeProbe {
            body: self.body(),
            up: self.config.up(),
            facing,
            reach_up: config.reach_up,
            reach: config.reach,
            max_slope: self.config.ground.max_slope,
        }
    }

    fn find_ledge(&mut self, from: DVec3, facing: DVec3, config: &LedgeConfig) -> Option<Ledge> {
        let probe = self.ledge_probe(facing, config);
        let ledge = self.mover.find_ledge(&probe, from)?;
        self.can_hang_from(&ledge.touch).then_some(ledge)
    }

    pub(super) fn hang_from_ledge(&mut self) -> NextMode {
        let (Some(config), Some(carried)) = (self.config.ledge, self.carried) else {
            return self.leave(ClimberMode::Falling);
        };
        if let Some(next) = self.be_refused_by_hold(self.on.hang) {
            return next;
        }
        if self.config.slope(carried.normal()) > self.standing_slope() {
            self.event(ClimberEvent::Slipped);
            return self.leave(ClimberMode::Falling);
        }
        if !self.input.grip {
            self.event(ClimberEvent::Released);
            self.state.grip_cooldown = GRIP_COOLDOWN;
            return self.leave(ClimberMode::Falling);
        }
        if self.state.jump_buffer > 0.0 && self.spend(|stamina| stamina.jump_cost) {
            let grip = self.config.grip;
            let speed = grip.map_or(self.config.ground.jump_speed, |grip| grip.jump_speed);
            return self.jump_off(-self.state.heading, speed);
        }
        let mut wish = self.ledge_wish();
        if !self.on.stand {
            // There is no ground to pull itself up onto.
            wish.up = wish.up.min(0.0);
        }
        let pulls_up = self.is_pulling_up(wish.up);
        if wish.up < -PULL_UP_INPUT
            && !pulls_up
            && let Some(next) = self.grip_at(carried.position)
        {
            return next;
        }
        if pulls_up {
            self.pull_up(&carried, &config)
        } else {
            self.shimmy(&carried, &config, wish.aside)
        }
    }

    /// Grips at a position, if there is a grip, for example on the wall below the ledge.
    fn grip_at(&mut self, place: DVec3) -> Option<NextMode> {
        let grip = self.config.grip?;
        let touch = self.find_grip(place, &grip, None)?;
        Some(self.take_hold(&touch, place))
    }

    /// The level part of the input for ledges.
    fn stick(&self) -> DVec3 {
        let up = self.config.up();
        let input = if self.input.climb == DVec3::ZERO {
            self.input.walk
        } else {
            self.input.climb
        };
        input - up * input.dot(up)
    }

    /// The wish of the input, relative to the wall. After the ledge has turned a corner, the stick leads on along the
    /// ledge as it did before, as long as it is held there or straight back.
    fn ledge_wish(&mut self) -> LedgeWish {
        let up = self.config.up();
        let facing = self.state.heading;
        let side = facing.cross(up);
        let stick = self.stick();
        let rises = self.input.climb.dot(up);
        let right = &mut self.state.ledge_hanging.right;
        let is_kept = stick.dot(*right).abs() > HELD_STICK_COSINE * stick.length();
        if !is_kept || rises.abs() > PULL_UP_INPUT {
            *right = DVec3::ZERO;
        }
        let (over, along) = if *right == DVec3::ZERO {
            (rises + stick.dot(facing), stick.dot(side))
        } else {
            (rises, stick.dot(*right))
        };
        let is_aside = along.abs() > LEAST_SHIMMY_INPUT * stick.length();
        let along = if is_aside { along } else { 0.0 };
        LedgeWish {
            up: over,
            aside: side * along.clamp(-1.0, 1.0),
        }
    }

    /// The climber's position while it hangs: the ball at the wall, below the edge.
    fn hanging_place(&self, carried: &Carried, config: &LedgeConfig) -> DVec3 {
        let out = self.ledge_probe(self.state.heading, config).hands_ahead();
        carried.motion.position - self.state.heading * out - self.config.up() * config.drop
    }

    /// The way from a position to the place where the climber hangs. Hands may be a little to the side of the body, as
    /// at a ledge's end, or where the top slopes.
    fn way_to(&self, place: DVec3, position: DVec3) -> DVec3 {
        let side = self.state.heading.cross(self.config.up());
        let way = place - position;
        let beside = MAX_HANDS_ASIDE * self.config.body.radius;
        way - side * way.dot(side).clamp(-beside, beside)
    }

    /// The part of a displacement that the arms make in a tick.
    fn drawn(&self, way: DVec3) -> DVec3 {
        way.clamp_length_max(DRAW_SPEED * self.config.body.radius * self.dt())
    }

    fn is_out_of_place(&self, way: DVec3) -> bool {
        way.length() > OUT_OF_PLACE * self.config.body.radius
    }

    /// True if the ledge leaves the climber no room, or an obstacle holds it out of reach. If it held on, it would be
    /// dragged through that obstacle.
    fn is_pressed_off(&self, place: DVec3, moved: &Moved, config: &LedgeConfig) -> bool {
        let is_crushed = moved.missing_room > self.config.body.margin;
        // The climber may have caught the ledge from above its place as well as from below.
        let reach = self.config.body.radius + config.reach + config.reach_up.max(config.drop);
        let is_far = moved.position.distance(place) > reach && !self.state.ledge_hanging.returns;
        is_crushed || is_far
    }
}

/// The input, relative to a ledge.
#[derive(Clone, Copy, Debug)]
struct LedgeWish {
    /// Up and over the ledge; negative: down the wall.
    up: f64,
    /// Along the ledge, in world space.
    aside: DVec3,
}
