//! Pulling up over a ledge, and going back where there is no room.

use glam::DVec3;

use super::super::carrying::Carried;
use super::super::moving::Intent;
use super::super::{NextMode, Tick};
use super::{DRAW_SPEED, PULL_UP_INPUT};
use crate::config::LedgeConfig;
use crate::{ClimberEvent, ClimberMode};

/// Share of the pull-up in which the climber goes up. In the rest it goes in over the ledge.
const UPWARD_SHARE: f64 = 0.6;

/// Share of the pull-up in a tick, above which the tick stops at the corner between up and in, and does not cut it.
const LONG_TICK_SHARE: f64 = 0.1;

/// Distance by which the climber may lag behind a pull-up's path before it counts as blocked, as a fraction of its
/// radius. It lags below an overhang, where it goes outwards as it goes up.
const MAX_LAG: f64 = 0.5;

/// Lag, as a fraction of its radius, below which a blocked climber counts as free again. It is less than [`MAX_LAG`]:
/// otherwise a climber that creeps along an obstacle would hardly ever give up.
const FREED_LAG: f64 = 0.25;

/// Time without progress after which a pull-up is given up, seconds: longer than a friend takes to step aside from the
/// edge, shorter than a player takes to call it stuck.
const GIVES_UP: f64 = 0.3;

/// Share of a tick's draw into place below which a climber is as near to its place as it can get.
const LEAST_DRAW_SHARE: f64 = 0.5;

/// Share of the planned velocity below which a velocity is rest and rounding.
const STILL_VELOCITY_SHARE: f64 = 1e-3;

/// Difference from the planned velocity, as a share of it, below which the planned velocity is used: more than
/// rounding, less than is visible.
const SAME_VELOCITY_SHARE: f64 = 0.05;

impl Tick<'_> {
    /// True if the climber pulls itself up in this tick. A pull-up that is blocked ends at once if the input no longer
    /// asks for it. A pull-up that was given up is not tried again until then.
    pub(super) fn is_pulling_up(&mut self, up: f64) -> bool {
        let asks = up > PULL_UP_INPUT;
        let memory = &mut self.state.ledge_hanging;
        memory.gave_up &= asks;
        if memory.blocked > 0.0 && !asks {
            self.go_back();
        }
        self.state.ledge_hanging.pull_up > 0.0 || asks && !self.state.ledge_hanging.gave_up
    }

    /// Ends a pull-up: the climber hangs again, and goes back to its place.
    fn go_back(&mut self) {
        let memory = &mut self.state.ledge_hanging;
        memory.pull_up = 0.0;
        memory.blocked = 0.0;
        memory.returns = true;
    }

    /// Holds the pull-up where it is, and gives up after a while.
    fn wait_for_room(&mut self) -> NextMode {
        self.state.ledge_hanging.blocked += self.dt();
        if self.state.ledge_hanging.blocked >= GIVES_UP {
            self.state.ledge_hanging.gave_up = true;
            self.go_back();
        }
        NextMode::Stay
    }

    /// Pulls the climber up, and in over the ledge.
    pub(super) fn pull_up(&mut self, carried: &Carried, config: &LedgeConfig) -> NextMode {
        let before = self.state.ledge_hanging.pull_up;
        let place = self.hanging_place(carried, config);
        let up = self.config.up();
        let body = self.body();
        let over = carried.motion.position + up * (body.radius + body.margin);
        let level = place + up * (over - place).dot(up);
        let at = |share: f64| {
            if share < UPWARD_SHARE {
                place.lerp(level, share / UPWARD_SHARE)
            } else {
                level.lerp(over, (share - UPWARD_SHARE) / (1.0 - UPWARD_SHARE))
            }
        };
        // The climber caught the ledge from farther away: arms first draw it to where the pull-up begins.
        let is_out_of_place =
            before == 0.0 && self.is_out_of_place(self.way_to(place, carried.position));
        self.state.ledge_hanging.returns &= is_out_of_place;
        if before == 0.0 && !is_out_of_place && !self.spend(|stamina| stamina.mantle_cost) {
            self.state.ledge_hanging.gave_up = true;
            return self.shimmy(carried, config, DVec3::ZERO);
        }
        let share = self.dt() / config.pull_up_time;
        let after = if is_out_of_place {
            0.0
        } else if before < UPWARD_SHARE && share > LONG_TICK_SHARE {
            // Up first: a longer step would cut the edge.
            (before + share).min(UPWARD_SHARE)
        } else {
            (before + share).min(1.0)
        };
        let way = at(after) - carried.position;
        let speed = (at(after) - at(before)).length() / self.dt();
        let fastest = speed.max(DRAW_SPEED * body.radius) * self.dt();
        let target = carried.position + way.clamp_length_max(fastest);
        let moved = self.slide(&self.path(target), Intent::Go);
        // The draw into place is no motion of the climber's own.
        let most = if is_out_of_place { 0.0 } else { fastest };
        let planned = (at(after) - at(before)) / self.dt();
        self.settle_by_arms(carried, moved.position, most, planned);
        if self.is_pressed_off(at(after), &moved, config) {
            return self.be_torn_off(carried);
        }
        if is_out_of_place {
            self.drawn_up += (moved.position - carried.position).dot(up).max(0.0);
            let made = (moved.position - carried.position).dot(way.normalize_or_zero());
            if made < LEAST_DRAW_SHARE * (target - carried.position).length() {
                // An obstacle bulges into its place: pull up from where it is.
                self.state.ledge_hanging.pull_up = share.min(1.0);
            }
            return NextMode::Stay;
        }
        // Bulging walls and ground push the climber ahead or aside. Only obstacles that keep it back are in its way.
        let onwards = (at(after) - at(before)).normalize_or_zero();
        let lag = (at(after) - moved.position).dot(onwards);
        if lag > MAX_LAG * body.radius {
            return self.wait_for_room();
        }
        if lag <= FREED_LAG * body.radius {
            self.state.ledge_hanging.blocked = 0.0;
        }
        self.state.ledge_hanging.pull_up = after;
        if after < 1.0 {
            return NextMode::Stay;
        }
        self.end_on_top(carried, moved.position, before)
    }

    /// Ends a pull-up on the top of the ledge: stands there, or grips it if it is too steep. `before` is the progress a
    /// tick ago, at which the climber waits if there is no room.
    fn end_on_top(&mut self, carried: &Carried, position: DVec3, before: f64) -> NextMode {
        // The climber ends a margin above the top.
        let reach = self
            .config
            .ground
            .snap_distance
            .max(2.0 * self.body().margin);
        let Some(ground) = self.ground_below(position, reach) else {
            // If the top is too steep to stand on, grip it, or lose the ledge.
            let gripped = self.grip_at(position);
            return gripped.unwrap_or_else(|| self.lose_footing());
        };
        if !self.is_corrected_clear(carried, ground.position) {
            self.state.ledge_hanging.pull_up = before;
            return self.wait_for_room();
        }
        self.state.position = ground.position;
        self.attach(&ground.touch, ground.position);
        self.state.velocity = self.state.base_velocity;
        self.event(ClimberEvent::Mantled);
        NextMode::Change(ClimberMode::Standing)
    }

    /// Keeps the ledge, with the position to which the arms moved the climber, by at most `most` metres. The climber's
    /// velocity relative to the ledge is the one that it moved at. If that is about `planned`, it is `planned`, which
    /// has no rounding.
    pub(super) fn settle_by_arms(
        &mut self,
        carried: &Carried,
        position: DVec3,
        most: f64,
        planned: DVec3,
    ) {
        self.keep_support(carried, position);
        let made = (position - carried.position).clamp_length_max(most) / self.dt();
        let is_as_planned = made.distance(planned) <= SAME_VELOCITY_SHARE * planned.length();
        let is_still = made.length() <= STILL_VELOCITY_SHARE * planned.length();
        let own = if self.state.crushed || is_still {
            DVec3::ZERO
        } else if is_as_planned {
            planned
        } else {
            made
        };
        self.state.velocity = carried.velocity() + own;
    }
}
