//! By its hands from a ledge: found by queries, on terrain and on skin alike.

use clamber_world::WorldCapsule;
use glam::DVec3;

use super::holding::OPEN_HANDED;
use super::{Carried, Step};
use crate::config::LedgeConfig;
use crate::mover::{Moved, Touch};
use crate::{ClimberEvent, ClimberMode};

/// Radius of a hand, metres: what is narrower is no ledge.
const HAND: f64 = 0.06;

/// How fast arms draw the body under the ledge, metres a second.
const DRAW_SPEED: f64 = 3.0;

/// How far beyond the edge hands and feet are put, metres.
const BEYOND: f64 = 0.1;

/// Share of the pull-up after which it goes in over the ledge; before it goes up.
const OVER: f64 = 0.6;

/// How far it may be kept back on the way that pulling up leads before it counts as blocked, as a share of its radius:
/// under an overhang it goes out as it goes up, and lags.
const KEPT: f64 = 0.5;

impl Step<'_> {
    /// Hangs from a ledge in front of it, if there is one.
    pub(super) fn catch_ledge(&mut self) -> bool {
        let Some(config) = self.config.ledge else {
            return false;
        };
        let facing = self.facing();
        let Some(top) = self.find_ledge(self.state.position, facing, &config) else {
            return false;
        };
        let lift = (top.contact.point - self.state.position).dot(self.config.up()) - config.drop;
        if self.state.mode == ClimberMode::Standing && lift <= 0.0 {
            // It would hang with its feet on the ground.
            return false;
        }
        self.face(facing);
        self.attach(&top);
        self.state.pull_up = 0.0;
        self.state.arm = 0.0;
        self.event(ClimberEvent::LedgeCaught {
            obstacle: top.obstacle,
            point: top.contact.point,
        });
        self.change_to(ClimberMode::LedgeHanging);
        self.hang_from_ledge();
        true
    }

    /// Where it looks for a ledge: where it wants to go, else where it faces.
    fn facing(&self) -> DVec3 {
        let up = self.config.up();
        let walk = self.input.walk;
        let level = walk - up * walk.dot(up);
        level.normalize_or(self.state.heading)
    }

    /// The top of a ledge that can be hung from, a hand beyond its edge.
    fn find_ledge(&mut self, from: DVec3, facing: DVec3, config: &LedgeConfig) -> Option<Touch> {
        let up = self.config.up();
        let radius = self.config.body.radius;
        let reach = radius + config.reach;
        let height = up * config.reach_up;
        // The wall, wherever it is highest up front.
        let hand = WorldCapsule {
            ends: [from, from + height],
            radius: HAND,
        };
        let (_, wall) = self.world.cast(&hand, facing * reach)?;
        if wall.started_inside {
            return None;
        }
        let to_wall = reach * wall.time + HAND;
        // Its top, a hand beyond its edge, with room on the way there.
        let above = WorldCapsule::ball(from + height + up * HAND, HAND);
        let inward = facing * (to_wall + HAND + BEYOND);
        if self.world.cast(&above, inward).is_some() {
            return None;
        }
        let (top, hit) = self.world.cast(&above.moved(inward), -height)?;
        let limit = self.config.ground.max_slope;
        let is_top = !hit.started_inside && self.config.slope(top.away) <= limit;
        is_top.then_some(top)
    }

    pub(super) fn hang_from_ledge(&mut self) {
        let Some(config) = self.config.ledge else {
            self.leave(ClimberMode::Falling);
            return self.fly();
        };
        let Some(carried) = self.carry() else {
            self.event(ClimberEvent::LostFooting);
            self.leave(ClimberMode::Falling);
            return self.fly();
        };
        let top = carried.support.normal_in_world();
        if self.config.slope(top) > self.stood_on() {
            self.event(ClimberEvent::Slipped);
            self.leave(ClimberMode::Falling);
            return self.fly();
        }
        if !self.input.grip {
            self.event(ClimberEvent::Released);
            self.state.open_handed = OPEN_HANDED;
            self.leave(ClimberMode::Falling);
            return self.fly();
        }
        if self.state.jump_buffer > 0.0 {
            let speed = self
                .config
                .grip
                .map_or(self.config.ground.jump_speed, |grip| grip.jump_speed);
            return self.jump_off(-self.state.heading, speed);
        }
        let wish = self.ledge_wish();
        if self.state.pull_up > 0.0 || wish.up > 0.5 {
            self.pull_up(&carried, &config);
        } else if wish.up < -0.5 && self.grip_below(&carried) {
            self.hold();
        } else {
            self.shimmy(&carried, &config, wish.aside);
        }
    }

    /// Grips the wall that it hangs before, if it can, from where it has been carried.
    fn grip_below(&mut self, carried: &Carried) -> bool {
        let Some(grip) = self.config.grip else {
            return false;
        };
        let Some(touch) = self.grip_near(carried.position, &grip, None) else {
            return false;
        };
        self.state.position = carried.position;
        self.take_hold(&touch);
        true
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

    /// Where it hangs: its ball at the wall, below the edge.
    fn hanging_place(&self, carried: &Carried, config: &LedgeConfig) -> DVec3 {
        let body = &self.config.body;
        let out = body.radius + HAND + BEYOND;
        carried.support.contact - self.state.heading * out - self.config.up() * config.drop
    }

    /// Hangs still, or goes along the ledge.
    fn shimmy(&mut self, carried: &Carried, config: &LedgeConfig, aside: DVec3) {
        let dt = self.dt();
        let place = self.hanging_place(carried, config);
        let drawn = (place - carried.position).clamp_length_max(DRAW_SPEED * dt);
        let step = aside * (config.shimmy_speed * dt);
        let target = carried.position + drawn + step;
        let moved = self.slide(carried.start, target, carried.swept);
        self.settle(carried, moved.position);
        if self.is_pressed_off(carried, &moved) {
            return;
        }
        if let Some(touch) = self.held_up_by(self.config.ground.max_slope) {
            self.attach(&touch);
            self.change_to(ClimberMode::Standing);
            return;
        }
        if step == DVec3::ZERO {
            return;
        }
        let facing = self.state.heading;
        if let Some(top) = self.find_ledge(moved.position, facing, config) {
            let velocity = self.state.velocity;
            self.attach(&top);
            self.state.velocity = velocity;
        } else {
            let moved = self.slide(carried.start, carried.position + drawn, carried.swept);
            self.settle(carried, moved.position);
        }
    }

    /// Lets go where its ledge crushes it: it has no room there, and would be dragged on through what is.
    fn is_pressed_off(&mut self, carried: &Carried, moved: &Moved) -> bool {
        let is_crushed = moved.missed > self.config.body.skin_width;
        if is_crushed {
            self.event(ClimberEvent::LostFooting);
            self.state.open_handed = OPEN_HANDED;
            // Not with the speed of being pressed out.
            self.state.velocity = carried.motion.velocity;
            self.leave(ClimberMode::Falling);
        }
        is_crushed
    }

    /// Up, and in over the ledge.
    fn pull_up(&mut self, carried: &Carried, config: &LedgeConfig) {
        let before = self.state.pull_up;
        let after = (before + self.dt() / config.pull_up_time).min(1.0);
        let place = self.hanging_place(carried, config);
        let up = self.config.up();
        let radius = self.config.body.radius;
        let over = carried.support.contact + up * (radius + self.config.body.skin_width);
        let level = place + up * (over - place).dot(up);
        let at = |share: f64| {
            if share < OVER {
                place.lerp(level, share / OVER)
            } else {
                level.lerp(over, (share - OVER) / (1.0 - OVER))
            }
        };
        let moved = self.slide(carried.start, at(after), carried.swept);
        self.settle(carried, moved.position);
        if self.is_pressed_off(carried, &moved) {
            return;
        }
        // Walls and grounds that bulge push it ahead or aside; only what keeps it back is in its way.
        let onwards = (at(after) - at(before)).normalize_or_zero();
        if (at(after) - moved.position).dot(onwards) > KEPT * radius {
            // No room: back down, unless it is carried on in the next tick.
            self.state.pull_up = (before - self.dt() / config.pull_up_time).max(0.0);
            return;
        }
        self.state.pull_up = after;
        if after < 1.0 {
            return;
        }
        if let Some(ground) = self.ground_below(moved.position, self.config.ground.snap_distance) {
            self.state.position = ground.position;
            self.attach(&ground.touch);
            self.state.pull_up = 0.0;
            self.event(ClimberEvent::Mantled);
            self.change_to(ClimberMode::Standing);
        } else {
            self.event(ClimberEvent::LostFooting);
            self.leave(ClimberMode::Falling);
        }
    }
}

/// What the input asks for on a ledge.
#[derive(Clone, Copy, Debug)]
struct LedgeWish {
    /// Over it; negative down the wall.
    up: f64,
    /// Along it, in world space.
    aside: DVec3,
}
