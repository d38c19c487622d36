//! How a creature gets out of a dead end: it looks for a wider way, and if it can neither turn nor go on, as in a blind
//! alley, it walks backwards until it can turn.

use core::f64::consts::{PI, TAU};

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::legs::at_once;
use super::{Creature, Surroundings};
use crate::feet::{Carried, GRAVITY, STEP_TIME};
use crate::kind::{Extent, Gait};

/// Longest retreat, in heights of the creature.
const LONGEST_RETREAT: f64 = 6.0;

/// Free room behind the creature below which it does not begin to retreat, in heights.
const LEAST_ROOM_BEHIND: f64 = 0.02;

/// Length of a retreat, in heights, from which on it ends if the creature can turn. An obstacle behind the creature
/// ends it sooner.
const ENOUGH_RETREAT: f64 = 0.2;

/// Length that is added to a retreat once a turn is free, in heights. A turn that is only just free may still be
/// blocked in one of its steps.
const EXTRA_RETREAT: f64 = 0.1;

/// Distance behind the creature that is checked for obstacles during a retreat, in heights.
const SIGHT_BEHIND: f64 = 1.0;

/// Angle that may be missing from a free turn, radians.
const TURN_TOLERANCE: f64 = 0.01;

/// Distance from the place where the creature got stuck, in heights. Stops and retreats within it count as stops and
/// retreats at the same place.
const SAME_PLACE_DISTANCE: f64 = 1.0;

/// Stops at one place after which the next one blocks the creature.
const MOST_STOPS: u8 = 6;

/// Most retreats from one place.
const MOST_RETREATS: u8 = 2;

/// How far the body moves away from a standing foot in a retreat before that foot steps, as a share of the leg's
/// length.
const RETREAT_BY_STEP: f64 = 0.3;

/// Highest speed of a retreat, as a share of the walking speed.
const RETREAT_SPEED_SHARE: f64 = 0.35;

/// How a creature has tried to get out of dead ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Retreats {
    /// Side to which the creature turns the long way round because the short way is blocked: -1 right, 1 left, 0
    /// neither.
    round: i8,
    /// True if the creature has chosen the long way round since it began to turn.
    has_gone_round: bool,
    /// True if the creature has checked the room for the whole turn since it began to turn.
    has_looked_round: bool,
    /// True if the creature has begun a retreat since it began to turn.
    has_gone_back: bool,
    /// How far the creature still walks backwards, metres.
    left: f64,
    /// Length of the retreat so far, metres.
    gone: f64,
    /// Whether the creature looks for ways on which it can turn everywhere.
    wide: WideWay,
    /// Place where the creature got stuck.
    stuck_at: DVec3,
    /// Number of stops before an obstacle near that place.
    stops: u8,
    /// Number of retreats from near that place.
    count: u8,
}

/// Whether a creature looks for ways on which it can turn everywhere. It does so once it got stuck on a way that is
/// only wide enough to walk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
enum WideWay {
    #[default]
    No,
    Looks,
    /// No such way was found.
    Failed,
}

impl Retreats {
    /// Side to which the creature turns the long way round: -1 right, 1 left, 0 if it turns the short way.
    pub(super) fn round(&self) -> i8 {
        self.round
    }

    /// How far the creature still walks backwards, metres.
    pub(super) fn left(&self) -> f64 {
        self.left
    }

    /// True if the creature looks for a way on which it can turn everywhere.
    pub(super) fn looks_for_wide_way(&self) -> bool {
        self.wide == WideWay::Looks
    }

    /// Records that there is no way on which the creature can turn everywhere.
    pub(super) fn fail_wide_way(&mut self) {
        self.wide = WideWay::Failed;
    }

    /// Turns the short way again.
    pub(super) fn turn_short(&mut self) {
        self.round = 0;
    }

    /// Clears the record of the last turn, once the creature no longer turns on the spot.
    pub(super) fn end_turn(&mut self) {
        (self.has_gone_round, self.has_gone_back) = (false, false);
        self.has_looked_round = false;
    }

    /// True at the first call since the creature began to turn.
    pub(super) fn looks_round_first(&mut self) -> bool {
        !std::mem::replace(&mut self.has_looked_round, true)
    }

    /// Counts a way walked backwards, metres.
    pub(super) fn walk(&mut self, back: f64) {
        self.left = (self.left - back).max(0.0);
        self.gone += back;
    }

    /// Moves the known place with the ground that carries the creature.
    pub(super) fn be_carried(&mut self, carried: &Carried) {
        self.stuck_at = carried.level_place(self.stuck_at);
    }

    /// True if all numbers are within the range that a creature reaches.
    pub(super) fn is_within(&self, most: f64) -> bool {
        let numbers = [self.left, self.gone];
        let mut numbers = numbers.into_iter().chain(self.stuck_at.to_array());
        (-1..=1).contains(&self.round) && numbers.all(|number| number.abs() <= most)
    }
}

impl Creature {
    /// Speed of a retreat, metres a second: no faster than the feet can follow by steps of their own, which are not in
    /// a clip.
    pub(super) fn backs(&self, gait: &Gait) -> f64 {
        let legs = self.kind.legs();
        let rounds = legs.len().div_ceil(at_once(legs.len())) as f64;
        let by_steps = legs.iter().map(|leg| {
            let length = leg.length * self.size.scale;
            RETREAT_BY_STEP * length / (rounds * STEP_TIME * (length / GRAVITY).sqrt())
        });
        by_steps.fold(RETREAT_SPEED_SHARE * self.full_speed(gait), f64::min)
    }

    /// Reacts to an obstacle on the way at which the creature has stopped.
    ///
    /// At the first stop, the creature skips the next corner of its way, since it may get past the obstacle from here.
    /// Later it looks for a wider way or begins a retreat. It is blocked if neither is possible, if it has no corners
    /// left to go round, or after too many stops at this place.
    pub(super) fn stop(&mut self, around: &Surroundings<'_>, on_spot: &Extent) {
        self.get_stuck();
        let walked = &mut self.state.walked;
        let retreats = &mut walked.retreats;
        retreats.stops = retreats.stops.saturating_add(1);
        let has_corners = walked.corners.next().is_some();
        if retreats.stops > MOST_STOPS {
            walked.progress.set_blocked(true);
        } else if has_corners && retreats.stops == 1 {
            walked.corners.skip();
        } else if retreats.wide == WideWay::No && !walked.corners.has_failed() {
            retreats.wide = WideWay::Looks;
            walked.corners.search_now();
        } else {
            let is_blocked = !has_corners || !self.begin_back(around, on_spot);
            self.state.walked.progress.set_blocked(is_blocked);
        }
    }

    /// Takes this place as the one where the creature got stuck, and resets the counts of stops and retreats, unless
    /// they already count for a place near here.
    fn get_stuck(&mut self) {
        let (place, here) = (
            self.state.position(),
            SAME_PLACE_DISTANCE * self.size.height,
        );
        let retreats = &mut self.state.walked.retreats;
        let is_first = retreats.stops == 0 && retreats.count == 0;
        if is_first || retreats.stuck_at.distance(place) > here {
            (retreats.stuck_at, retreats.stops, retreats.count) = (place, 0, 0);
        }
    }

    /// True if the creature can turn by `aside` radians, or else the long way round to the same direction. The long way
    /// is stored in the state, at most once per turn.
    pub(super) fn finds_turn(
        &mut self,
        around: &Surroundings<'_>,
        on_spot: &Extent,
        aside: f64,
    ) -> bool {
        let (room, slope) = (self.room(around, on_spot), self.slope());
        let is_free = |far: f64| room.turn(far, slope).abs() >= far.abs() - TURN_TOLERANCE;
        if is_free(aside) {
            return true;
        }
        let is_short = aside.abs() < PI;
        let has_gone_round = self.state.walked.retreats.has_gone_round;
        if !is_short || has_gone_round || !is_free(aside - TAU.copysign(aside)) {
            return false;
        }
        let retreats = &mut self.state.walked.retreats;
        retreats.round = if aside > 0.0 { -1 } else { 1 };
        retreats.has_gone_round = true;
        true
    }

    /// Begins a retreat, if there is room behind the creature and it has not retreated too often from here. Returns
    /// true if it does.
    pub(super) fn begin_back(&mut self, around: &Surroundings<'_>, on_spot: &Extent) -> bool {
        let least = LEAST_ROOM_BEHIND * self.size.height;
        self.get_stuck();
        let retreats = &self.state.walked.retreats;
        if retreats.has_gone_back
            || retreats.count >= MOST_RETREATS
            || self.room_behind(around, on_spot, least) < least
        {
            return false;
        }
        let most = LONGEST_RETREAT * self.size.height;
        let walked = &mut self.state.walked;
        let retreats = &mut walked.retreats;
        retreats.count += 1;
        (retreats.left, retreats.gone, retreats.has_gone_back) = (most, 0.0, true);
        (retreats.round, retreats.has_gone_round) = (0, false);
        walked.free.close();
        // Another way may begin there, so look for one once the retreat is over.
        retreats.wide = WideWay::Looks;
        walked.corners.search_now();
        true
    }

    /// Updates how far the retreat still goes: it ends at an obstacle, or soon after the creature can turn.
    pub(super) fn look_back(&mut self, around: &Surroundings<'_>, on_spot: &Extent, aside: f64) {
        let height = self.size.height;
        let left = self
            .state
            .walked
            .retreats
            .left
            .min(LONGEST_RETREAT * height);
        let sees = left.min(SIGHT_BEHIND * height);
        let back = self.room_behind(around, on_spot, sees).max(0.0);
        let is_enough = self.state.walked.retreats.gone >= ENOUGH_RETREAT * height;
        let turns = is_enough && self.finds_turn(around, on_spot, aside);
        self.state.walked.retreats.left = if turns {
            back.min(EXTRA_RETREAT * height)
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
            let place = self.state.position() + back * by - self.state.territory.home();
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
