//! What a creature does where it does not get on: it looks for a wider way, and where it can neither turn nor go on, as in
//! a blind alley, it goes back until it can turn.

use core::f64::consts::{PI, TAU};

use super::legs::at_once;
use super::state::Wide;
use super::{Creature, Surroundings};
use crate::feet::{GRAVITY, STEP_TIME};
use crate::kind::{Extent, Gait};

/// It goes back this far at most, in heights, and not where there is less room than the second. The third is enough if it
/// can turn then; it goes the fourth further, since a turn that is just free is not free in all of its steps. It sees as
/// far back as the last.
const MOST: f64 = 6.0;
const LEAST: f64 = 0.02;
const ENOUGH: f64 = 0.2;
const MORE: f64 = 0.1;
const SEES: f64 = 1.0;

/// What may be left of a turn, radians.
const LEFT: f64 = 0.01;

/// Within this of where it did not get on, in heights, it stands before something so many times before it gives up, and
/// goes back so many times.
const HERE: f64 = 1.0;
const MOST_STOPS: u8 = 6;
const MOST_RETREATS: u8 = 2;

/// How far the body goes from a foot before that steps, as a share of the leg's length; and how fast it goes back at most,
/// as a share of its walk.
const BY_STEP: f64 = 0.3;
const SLOW: f64 = 0.35;

impl Creature {
    /// How fast it goes back, metres a second: as fast as its feet can follow by steps of their own.
    pub(super) fn backs(&self, gait: &Gait) -> f64 {
        let legs = self.kind.legs();
        let rounds = legs.len().div_ceil(at_once(legs.len())) as f64;
        let by_steps = legs.iter().map(|leg| {
            let length = leg.length * self.size.scale;
            BY_STEP * length / (rounds * STEP_TIME * (length / GRAVITY).sqrt())
        });
        by_steps.fold(SLOW * self.full_speed(gait), f64::min)
    }

    /// It stands before something on its way, as near to its next corner as it gets: perhaps it comes round it from here,
    /// or by a wider way, or from further back.
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

    /// Counts anew how often it did not get on, unless that was about here.
    fn get_stuck(&mut self) {
        let (place, here) = (self.state.position, HERE * self.size.height);
        let walked = &mut self.state.walked;
        let is_first = walked.stops == 0 && walked.retreats == 0;
        if is_first || walked.stuck_at.distance(place) > here {
            (walked.stuck_at, walked.stops, walked.retreats) = (place, 0, 0);
        }
    }

    /// Looks whether it can turn to what is so far aside, radians: the short way, or else the long way round.
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

    /// Begins to go back, if there is room behind it and it has not done so too often. Returns true if it does.
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
        // From there may be another way.
        (walked.wide, walked.ticks_left) = (Wide::Looks, 0);
        true
    }

    /// Looks whether it still has room behind it, and whether it has to go back any further.
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

    /// How far it may go back, metres: as far as its way is free, but not out of its arena unless it was sent.
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
