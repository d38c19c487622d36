//! Knowledge of a creature about its current way.

use serde::{Deserialize, Serialize};

use super::back::Retreats;
use super::check_way::FreeWay;
use super::corners::Corners;
use super::move_on::Progress;
use crate::feet::Carried;

/// Knowledge of a creature about its current way.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Walked {
    pub(super) corners: Corners,
    pub(super) free: FreeWay,
    pub(super) retreats: Retreats,
    pub(super) progress: Progress,
}

impl Walked {
    /// The knowledge that stays when the goal moves: the time until the next search, the free way, and the time for
    /// which the creature has tried.
    pub(super) fn to_another_goal(&self) -> Self {
        Self {
            corners: self.corners.forgotten(),
            free: self.free,
            retreats: Retreats::default(),
            progress: self.progress.unblocked(),
        }
    }

    /// Moves the known places with the ground that carries the creature.
    pub(super) fn be_carried(&mut self, carried: &Carried) {
        self.corners.be_carried(carried);
        self.retreats.be_carried(carried);
    }

    /// True if all numbers are within the range that a creature reaches.
    pub(super) fn is_within(&self, most: f64) -> bool {
        self.corners.is_within(most) && self.free.is_within(most) && self.retreats.is_within(most)
    }
}
