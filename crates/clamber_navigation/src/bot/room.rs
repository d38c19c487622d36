//! Tells whether a patch has room for the climber in the creature's present pose.

use std::cell::RefCell;
use std::collections::BTreeMap;

use super::View;
use crate::graph::Patch;

/// Only patches within this many radii of the climber are tested: the creature moves on before the bot comes to others.
const TESTED_RADIUS: f64 = 12.5;

/// A ball that is deeper in skin than this share of its radius has no room.
const MOST_DEPTH_IN_SKIN: f64 = 0.6;

/// The patches near the climber that were tested so far, and whether they have room.
pub(super) struct Room<'a> {
    view: &'a View<'a>,
    known: RefCell<BTreeMap<usize, bool>>,
}

impl<'a> Room<'a> {
    pub(super) fn new(view: &'a View<'a>) -> Self {
        Self {
            view,
            known: RefCell::default(),
        }
    }

    pub(super) fn is_there(&self, patch: &Patch, index: usize) -> bool {
        if let Some(known) = self.known.borrow().get(&index) {
            return *known;
        }
        let seat = self.view.spot(patch).seat;
        let climber = self.view.climber;
        let looks = TESTED_RADIUS * climber.config().body.radius;
        let is_far = seat.distance(climber.state().position) > looks;
        let is_there = is_far || self.view.has_room(seat, MOST_DEPTH_IN_SKIN);
        self.known.borrow_mut().insert(index, is_there);
        is_there
    }
}
