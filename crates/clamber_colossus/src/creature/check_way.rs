//! Checks the way of a creature at intervals: how far it is free, and how far the creature may turn.

use serde::{Deserialize, Serialize};

use super::course::{Course, Wanted};
use super::way::Way;
use super::{Creature, Surroundings};
use crate::kind::{Extent, Extents, Gait};

/// Interval between checks of the way, in ticks.
pub(super) const CHECK_INTERVAL: u64 = 8;

/// Factor on the interval while there is no obstacle on the way.
pub(super) const FREE_WAY_FACTOR: u64 = 4;

/// A yaw rate that the angular acceleration produces within this time counts as walking straight on, seconds.
const STEADY_TURN_TIME: f64 = 0.1;

/// A free distance above this means that the way is free as far as the creature looks, metres.
const FREE_DISTANCE: f64 = 1e5;

/// A turn on the spot is blocked if its free angle is below this, radians, unless the goal is nearer.
const LEAST_TURN: f64 = 0.05;

/// A walking creature turns to a goal up to this angle without a check, radians.
const LEAST_STEER: f64 = 0.02;

/// How far the way of a creature is free, from the last check.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct FreeWay {
    /// True if the other fields were measured.
    is_known: bool,
    /// Free distance ahead, metres. If the way is free as far as the creature looks, it is a much larger number.
    ahead: f64,
    /// Free angle to turn, radians; its sign is the side, positive to the left.
    turn: f64,
    /// True if the goal was ahead at the last check.
    faces: bool,
}

impl FreeWay {
    /// True if the way was checked.
    pub(super) fn is_known(&self) -> bool {
        self.is_known
    }

    /// Free distance ahead, metres.
    pub(super) fn ahead(&self) -> f64 {
        self.ahead
    }

    /// Free angle to turn, radians; its sign is the side, positive to the left.
    pub(super) fn turn(&self) -> f64 {
        self.turn
    }

    /// True if the goal was ahead at the last check.
    pub(super) fn faces(&self) -> bool {
        self.faces
    }

    /// Subtracts the distance and the angle that the creature has moved by in a tick.
    pub(super) fn use_up(&mut self, ahead: f64, turn: f64) {
        self.ahead -= ahead;
        self.turn -= turn;
    }

    /// Leaves neither room ahead nor room to turn until the next check.
    pub(super) fn close(&mut self) {
        (self.ahead, self.turn) = (0.0, 0.0);
    }

    /// True if all numbers are within the range that a creature reaches.
    pub(super) fn is_within(&self, most: f64) -> bool {
        self.ahead.abs() <= most && self.turn.abs() <= most
    }
}

impl Creature {
    /// Checks the way: searches for its corners, and measures how far its next piece is free and how far the creature
    /// may turn.
    pub(super) fn look(&mut self, gait: &Gait, way: &Way, around: &Surroundings<'_>) {
        let kind = std::sync::Arc::clone(&self.kind);
        let Some(Extents { on_spot, walking }) = kind.extents() else {
            return;
        };
        self.state.walked.progress.set_blocked(false);
        let mut course = Course::of(&self.state);
        if self.state.walked.retreats.left() > 0.0 {
            let goes = self.wanted(gait, Some(way), &course);
            self.look_back(around, on_spot, goes.aside);
            return;
        }
        if way.walks && !self.wanted(gait, Some(way), &course).arrived {
            self.find_corners(around, way);
        }
        let goes = self.wanted(gait, Some(way), &course);
        let ahead = if goes.faces {
            let sight = self.sight(gait);
            let far = sight.min(goes.distance + sight / 2.0);
            let free = self.room(around, walking).ahead(far);
            if free >= far {
                2.0 * FREE_DISTANCE
            } else {
                self.doubt_corners();
                free
            }
        } else {
            0.0
        };
        let free = &mut self.state.walked.free;
        (free.ahead, free.is_known, free.faces) = (ahead, true, goes.faces);
        course.ahead = ahead;
        let goes = self.wanted(gait, Some(way), &course);
        let retreats = &mut self.state.walked.retreats;
        // With the goal less than a quarter turn away, the creature turns the short way again. The next turn may go the
        // long way round.
        if !goes.turns_on_spot || goes.aside.abs() < core::f64::consts::FRAC_PI_2 {
            retreats.turn_short();
        }
        if !goes.turns_on_spot {
            retreats.end_turn();
        }
        if goes.turns_on_spot {
            self.look_aside(gait, &goes, around, on_spot);
        } else if goes.walks && !goes.is_stopped {
            // Head and tail move sideways when the creature steers.
            let far = self.turning_room(gait, true).copysign(goes.aside);
            self.state.walked.free.turn = if goes.aside.abs() > LEAST_STEER {
                self.room(around, walking).turn(far, self.slope())
            } else {
                far
            };
        } else if goes.is_stopped && self.state.speed() == 0.0 {
            self.stop(around, on_spot);
        }
    }

    /// Measures how far the creature may turn on the spot. If neither turn to the goal is free, the creature begins a
    /// retreat if it can.
    fn look_aside(
        &mut self,
        gait: &Gait,
        goes: &Wanted,
        around: &Surroundings<'_>,
        on_spot: &Extent,
    ) {
        let most = (2.0 * self.turning_room(gait, false)).max(2.0 * LEAST_TURN);
        let most = most.min(goes.aside.abs() + LEAST_TURN);
        let room = self.room(around, on_spot);
        self.state.walked.free.turn = room.turn(most.copysign(goes.aside), self.slope());
        if self.state.speed() > 0.0 {
            // The creature still walks.
            return;
        }
        let is_first = self.state.walked.retreats.looks_round_first();
        let free = self.state.walked.free.turn.abs();
        let is_blocked = free < LEAST_TURN && free < goes.aside.abs();
        if !is_first && !is_blocked {
            return;
        }
        let gets_on = self.finds_turn(around, on_spot, goes.aside)
            || self.begin_back(around, on_spot)
            || !is_blocked;
        self.state.walked.progress.set_blocked(!gets_on);
    }

    /// True in ticks in which the creature checks its way: in one of every [`CHECK_INTERVAL`] ticks. It checks less
    /// often while it walks straight on along a free way, or while it turns on the spot with room to turn.
    pub(super) fn looks(&self, gait: &Gait, wanted: &Wanted) -> bool {
        let (state, free) = (&self.state, &self.state.walked.free);
        let is_new = !free.is_known || wanted.faces && !free.faces;
        if is_new
            || state
                .ticks()
                .is_multiple_of(FREE_WAY_FACTOR * CHECK_INTERVAL)
        {
            return true;
        }
        let walks_free = free.ahead > FREE_DISTANCE
            && state.motion.yaw_rate().abs() < STEADY_TURN_TIME * self.turns();
        let room = free.turn * wanted.aside.signum();
        let turns_free = wanted.turns_on_spot && room > self.turning_room(gait, false);
        state.ticks().is_multiple_of(CHECK_INTERVAL) && !walks_free && !turns_free
    }
}
