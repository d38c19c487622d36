//! Hanging from a ledge, climbing along it and over it. Ledges are found by queries, on terrain and on skin alike.

use clamber_mover::{Ledge, LedgeProbe, Moved};
use glam::DVec3;

use super::carrying::Carried;
use super::holding::OPEN_HANDED;
use super::moving::Intent;
use super::{NextMode, Tick};
use crate::config::LedgeConfig;
use crate::{ClimberEvent, ClimberMode};

/// Speed at which arms draw the body into place below the ledge, as a share of the speed along it.
const DRAW: f64 = 3.0;

/// Share of the pull-up in which it goes up. In the rest it goes in over the ledge.
const OVER: f64 = 0.6;

/// How far it may lag behind a pull-up's path before it counts as blocked, as a share of its radius. It lags below an
/// overhang, where it goes outwards as it goes up.
const KEPT: f64 = 0.5;

/// A climber that makes less than this share of a tick's draw into place is as near to its place as it can get.
const DRAWN: f64 = 0.5;

/// A climber farther from its place than this share of its radius is drawn there before it pulls itself up.
const OUT_OF_PLACE: f64 = 0.1;

/// Memory of a climber that hangs from a ledge.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct LedgeHangingMemory {
    /// Progress of a pull-up, 0 (hangs) to 1 (stands on top).
    pub pull_up: f64,
}

impl Tick<'_> {
    /// Catches the ledge in front of a position, if there is one.
    pub(super) fn catch_ledge(&mut self, place: DVec3) -> Option<NextMode> {
        let config = self.config.ledge?;
        let Ledge { touch, facing, .. } = self.find_ledge(place, self.facing(), &config)?;
        let lift = (touch.contact.point - place).dot(self.config.up()) - config.drop;
        if self.state.mode == ClimberMode::Standing && lift <= 0.0 {
            // It would hang no higher than it stands.
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

    /// Direction in which it looks for a ledge: that of `walk`, or the heading without input.
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
        self.carries(&ledge.touch).then_some(ledge)
    }

    pub(super) fn hang_from_ledge(&mut self) -> NextMode {
        let (Some(config), Some(carried)) = (self.config.ledge, self.carried) else {
            return self.leave(ClimberMode::Falling);
        };
        if self.config.slope(carried.normal()) > self.standing_slope() {
            self.event(ClimberEvent::Slipped);
            return self.leave(ClimberMode::Falling);
        }
        if !self.input.grip {
            self.event(ClimberEvent::Released);
            self.state.open_handed = OPEN_HANDED;
            return self.leave(ClimberMode::Falling);
        }
        if self.state.jump_buffer > 0.0 {
            let grip = self.config.grip;
            let speed = grip.map_or(self.config.ground.jump_speed, |grip| grip.jump_speed);
            return self.jump_off(-self.state.heading, speed);
        }
        let wish = self.ledge_wish();
        if wish.up < -0.5
            && self.state.ledge_hanging.pull_up == 0.0
            && let Some(next) = self.grip_at(carried.position)
        {
            return next;
        }
        if self.state.ledge_hanging.pull_up > 0.0 || wish.up > 0.5 {
            self.pull_up(&carried, &config)
        } else {
            self.shimmy(&carried, &config, wish.aside)
        }
    }

    /// Grips at a position, if there is a grip, such as the wall below its ledge.
    fn grip_at(&mut self, place: DVec3) -> Option<NextMode> {
        let grip = self.config.grip?;
        let touch = self.find_grip(place, &grip, None)?;
        Some(self.take_hold(&touch, place))
    }

    fn ledge_wish(&self) -> LedgeWish {
        let up = self.config.up();
        let facing = self.state.heading;
        let side = facing.cross(up);
        let (walk, climb) = (self.input.walk, self.input.climb);
        let (over, along) = if climb == DVec3::ZERO {
            (walk.dot(facing), walk.dot(side))
        } else {
            (climb.dot(up) + climb.dot(facing), climb.dot(side))
        };
        LedgeWish {
            up: over,
            aside: side * along.clamp(-1.0, 1.0),
        }
    }

    /// Its position while it hangs: the ball at the wall, below the edge.
    fn hanging_place(&self, carried: &Carried, config: &LedgeConfig) -> DVec3 {
        let out = self.ledge_probe(self.state.heading, config).hands_ahead();
        carried.motion.position - self.state.heading * out - self.config.up() * config.drop
    }

    /// The part of a displacement that arms make in a tick.
    fn drawn(&self, way: DVec3, config: &LedgeConfig) -> DVec3 {
        way.clamp_length_max(DRAW * config.shimmy_speed * self.dt())
    }

    /// Hangs still, or moves along the ledge.
    fn shimmy(&mut self, carried: &Carried, config: &LedgeConfig, aside: DVec3) -> NextMode {
        let place = self.hanging_place(carried, config);
        let drawn = self.drawn(place - carried.position, config);
        let velocity = aside * config.shimmy_speed;
        let step = velocity * self.dt();
        let intent = if step == DVec3::ZERO {
            Intent::Stay
        } else {
            Intent::Go
        };
        let moved = self.slide(&self.path(carried.position + drawn + step), intent);
        self.settle(carried, moved.position, carried.velocity() + velocity);
        if self.is_pressed_off(place, &moved, config) {
            return self.be_torn_off(carried);
        }
        if let Some(next) = self.stand_where_it_hangs() {
            return next;
        }
        if step == DVec3::ZERO {
            return NextMode::Stay;
        }
        let facing = self.state.heading;
        if let Some(ledge) = self.find_ledge(moved.position, facing, config) {
            let velocity = self.state.velocity;
            self.attach(&ledge.touch, moved.position);
            self.face(ledge.facing);
            self.state.velocity = velocity;
        } else {
            let moved = self.slide(&self.path(carried.position + drawn), Intent::Stay);
            self.settle(carried, moved.position, carried.velocity());
        }
        NextMode::Stay
    }

    /// True if its ledge leaves it no room, or an obstacle holds it out of reach. If it held on, it would be dragged
    /// through that obstacle.
    fn is_pressed_off(&self, place: DVec3, moved: &Moved, config: &LedgeConfig) -> bool {
        let is_crushed = moved.missing_room > self.config.body.margin;
        let reach = self.config.body.radius + config.reach + config.reach_up;
        is_crushed || moved.position.distance(place) > reach
    }

    /// Pulls itself up, and in over the ledge.
    fn pull_up(&mut self, carried: &Carried, config: &LedgeConfig) -> NextMode {
        let before = self.state.ledge_hanging.pull_up;
        let place = self.hanging_place(carried, config);
        let up = self.config.up();
        let body = self.body();
        let over = carried.motion.position + up * (body.radius + body.margin);
        let level = place + up * (over - place).dot(up);
        let at = |share: f64| {
            if share < OVER {
                place.lerp(level, share / OVER)
            } else {
                level.lerp(over, (share - OVER) / (1.0 - OVER))
            }
        };
        // It caught the ledge from farther away: first draw it to where the pull-up begins.
        let is_out_of_place =
            before == 0.0 && place.distance(carried.position) > OUT_OF_PLACE * body.radius;
        let share = self.dt() / config.pull_up_time;
        let after = if is_out_of_place {
            0.0
        } else {
            (before + share).min(1.0)
        };
        let way = at(after) - carried.position;
        let speed = (at(after) - at(before)).length() / self.dt();
        let fastest = speed.max(DRAW * config.shimmy_speed) * self.dt();
        let target = carried.position + way.clamp_length_max(fastest);
        let moved = self.slide(&self.path(target), Intent::Go);
        let velocity = (at(after) - at(before)) / self.dt();
        self.settle(carried, moved.position, carried.velocity() + velocity);
        if self.is_pressed_off(place, &moved, config) {
            return self.be_torn_off(carried);
        }
        if is_out_of_place {
            let made = (moved.position - carried.position).dot(way.normalize_or_zero());
            if made < DRAWN * (target - carried.position).length() {
                // An obstacle bulges into its place: pull up from where it is.
                self.state.ledge_hanging.pull_up = share;
            }
            return NextMode::Stay;
        }
        // Bulging walls and ground push it ahead or aside. Only obstacles that keep it back are in its way.
        let onwards = (at(after) - at(before)).normalize_or_zero();
        if (at(after) - moved.position).dot(onwards) > KEPT * body.radius {
            // No room: go back down, unless there is room in the next tick.
            self.state.ledge_hanging.pull_up = (before - share).max(0.0);
            return NextMode::Stay;
        }
        self.state.ledge_hanging.pull_up = after;
        if after < 1.0 {
            return NextMode::Stay;
        }
        let Some(ground) = self.ground_below(moved.position, self.config.ground.snap_distance)
        else {
            // If the top is too steep to stand on, grip it, or lose the ledge.
            let gripped = self.grip_at(moved.position);
            return gripped.unwrap_or_else(|| self.lose_footing());
        };
        if !self.is_corrected_clear(carried, ground.position) {
            self.state.ledge_hanging.pull_up = before;
            return NextMode::Stay;
        }
        self.state.position = ground.position;
        self.attach(&ground.touch, ground.position);
        self.state.velocity = self.state.base_velocity;
        self.event(ClimberEvent::Mantled);
        NextMode::Change(ClimberMode::Standing)
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
