//! How a creature gets out of a dead end: it looks for a wider way, and if it can neither turn nor go on, as in a blind
//! alley, it walks backwards until it can turn.

use core::f64::consts::{PI, TAU};

use super::legs::at_once;
use super::state::Wide;
use super::{Creature, Surroundings};
use crate::feet::{GRAVITY, STEP_TIME};
use crate::kind::{Extent, Gait};

/// Longest retreat, in heights of the creature.
const MOST: f64 = 6.0;

/// Free room behind the creature below which it does not begin to retreat, in heights.
const LEAST: f64 = 0.02;

/// Length of a retreat, in heights, from which on it ends if the creature can turn. An obstacle behind the creature
/// ends it sooner.
const ENOUGH: f64 = 0.2;

/// Length that is added to a retreat once a turn is free, in heights. A turn that is only just free may still be
/// blocked in one of its steps.
const MORE: f64 = 0.1;

/// Distance behind the creature that is checked for obstacles during a retreat, in heights.
const SEES: f64 = 1.0;

/// Angle that may be missing from a free turn, radians.
const LEFT: f64 = 0.01;

/// Distance from the place where the creature got stuck, in heights. Stops and retreats within it count as stops and
/// retreats at the same place.
const HERE: f64 = 1.0;

/// Stops at one place after which the next one blocks the creature.
const MOST_STOPS: u8 = 6;

/// Most retreats from one place.
const MOST_RETREATS: u8 = 2;

/// How far the body moves away from a standing foot in a retreat before that foot steps, as a share of the leg's
/// length.
const BY_STEP: f64 = 0.3;

/// Highest speed of a retreat, as a share of the walking speed.
const SLOW: f64 = 0.35;

impl Creature {
    /// Speed of a retreat, metres a second: no faster than the feet can follow by steps of their own, which are not in
    /// a clip.
    pub(super) fn backs(&self, gait: &Gait) -> f64 {
        let legs = self.kind.legs();
        let rounds = legs.len().div_ceil(at_once(legs.len())) as f64;
        let by_steps = legs.iter().map(|leg| {
            let length = leg.length * self.size.scale;
            BY_STEP * length / (rounds * STEP_TIME * (length / GRAVITY).sqrt())
        });
        by_steps.fold(SLOW * self.full_speed(gait), f64::min)
    }

    /// Reacts to an obstacle on the way at which the creature has stopped.
    ///
    /// At the first stop, the creature skips the next corner of its way, since it may get past the obstacle from here.
    /// Later it looks for a wider way or begins a retreat. It is blocked if neither is possible, if it has no corners
    /// left to go round, or after too many stops at this place.
    pub(super) fn stop(&mut self, around: &Surroundings<'_>, on_spot: &Extent) {
        self.get_stuck();
        let walked = &mut self.state.walked;
        walked.stops = walked.stops.saturating_add(1);
        let has_corners = !walked.corners.is_empty();
        if walked.stops > MOST_STOPS {
            walked.is_blocked = true;
        } else if has_corners && walked.stops == 1 {
            walked.corners.remove(0);
        } else if walked.wide == Wide::No && walked.failed == 0 {
            (walked.wide, walked.ticks_left) = (Wide::Looks, 0);
        } else {
            self.state.walked.is_blocked = !has_corners || !self.begin_back(around, on_spot);
        }
    }

    /// Takes this place as the one where the creature got stuck, and resets the counts of stops and retreats, unless
    /// they already count for a place near here.
    fn get_stuck(&mut self) {
        let (place, here) = (self.state.position, HERE * self.size.height);
        let walked = &mut self.state.walked;
        let is_first = walked.stops == 0 && walked.retreats == 0;
        if is_first || walked.stuck_at.distance(place) > here {
            (walked.stuck_at, walked.stops, walked.retreats) = (place, 0, 0);
        }
    }

    /// True if the creature can turn by `aside` radians, or else the long way round to the same direction. The long way
    /// is stored in `walked.round`, at most once per turn.
    pub(super) fn finds_turn(
        &mut self,
        around: &Surroundings<'_>,
        on_spot: &Extent,
        aside: f64,
    ) -> bool {
        let (room, slope) = (self.room(around, on_spot), self.slope());
        let is_free = |far: f64| room.turn(far, slope).abs() >= far.abs() - LEFT;
        if is_free(aside) {
            return true;
        }
        let is_short = aside.abs() < PI;
        if !is_short || self.state.walked.has_gone_round || !is_free(aside - TAU.copysign(aside)) {
            return false;
        }
        self.state.walked.round = if aside > 0.0 { -1 } else { 1 };
        self.state.walked.has_gone_round = true;
        true
    }

    /// Begins a retreat, if there is room behind the creature and it has not retreated too often from here. Returns
    /// true if it does.
    pub(super) fn begin_back(&mut self, around: &Surroundings<'_>, on_spot: &Extent) -> bool {
        let least = LEAST * self.size.height;
        self.get_stuck();
        if self.state.walked.has_gone_back
            || self.state.walked.retreats >= MOST_RETREATS
            || self.room_behind(around, on_spot, least) < least
        {
            return false;
        }
        let most = MOST * self.size.height;
        let walked = &mut self.state.walked;
        walked.retreats += 1;
        (walked.back, walked.gone_back, walked.has_gone_back) = (most, 0.0, true);
        (walked.ahead, walked.turn) = (0.0, 0.0);
        (walked.round, walked.has_gone_round) = (0, false);
        // Another way may begin there, so look for one once the retreat is over.
        (walked.wide, walked.ticks_left) = (Wide::Looks, 0);
        true
    }

    /// Updates how far the retreat still goes: it ends at an obstacle, or soon after the creature can turn.
    pub(super) fn look_back(&mut self, around: &Surroundings<'_>, on_spot: &Extent, aside: f64) {
        let height = self.size.height;
        let left = self.state.walked.back.min(MOST * height);
        let sees = left.min(SEES * height);
        let back = self.room_behind(around, on_spot, sees).max(0.0);
        let is_enough = self.state.walked.gone_back >= ENOUGH * height;
        let turns = is_enough && self.finds_turn(around, on_spot, aside);
        self.state.walked.back = if turns {
            back.min(MORE * height)
        } else if back < sees {
            back
        } else {
            left
        };
    }

    /// Free distance behind the creature, metres, at most `most`. It ends at the border of the arena, unless the
    /// creature was sent.
    fn room_behind(&self, around: &Surroundings<'_>, on_spot: &Extent, most: f64) -> f64 {
        let behind = on_spot.behind();
        let back = -self.state.heading();
        let free = self.room_towards(around, &behind, back).ahead(most);
        let far = |by: f64| {
            let place = self.state.position + back * by - self.state.home;
            place.with_y(0.0).length()
        };
        let arena = self.config.arena.max(far(0.0));
        if self.sent_to().is_some() || far(free.max(0.0)) <= arena {
            free
        } else {
            free.min(arena - far(0.0))
        }
    }
}
