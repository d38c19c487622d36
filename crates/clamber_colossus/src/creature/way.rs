//! Ways of a creature: the goals of its walks and turns.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::Creature;
use super::state::is_far;
use super::walked::Walked;
use crate::brain::{Place, StateAction, StateId, Walk};
use crate::feet::Carried;

/// The places that a creature comes back to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Territory {
    /// Middle of the arena.
    home: DVec3,
    /// Place to which the creature walks on patrol.
    patrol: DVec3,
}

impl Territory {
    /// The territory of a creature that has its home at a place.
    pub(super) fn around(home: DVec3) -> Self {
        Self { home, patrol: home }
    }

    pub(super) fn home(&self) -> DVec3 {
        self.home
    }

    /// Moves the places with the ground that carries the creature. They may be far away: the ground's yaw turns them,
    /// but not its pitch and roll.
    pub(super) fn be_carried(&mut self, carried: &Carried) {
        self.home = carried.level_place(self.home);
        self.patrol = carried.level_place(self.patrol);
    }

    /// True if both places are numbers that a creature reaches.
    pub(super) fn is_within_range(&self) -> bool {
        !is_far(self.home) && !is_far(self.patrol)
    }
}

/// A goal, and when the creature has arrived there.
pub(super) struct Way {
    pub(super) goal: DVec3,
    /// Bearing of the goal on arrival, radians; `None` if any bearing will do.
    pub(super) bearing: Option<f64>,
    /// Horizontal distance within which the creature has arrived, metres.
    pub(super) within: f64,
    /// Angle to that bearing within which the turn is done, radians.
    pub(super) within_angle: f64,
    /// True if the creature walks to the goal; false if it only turns towards it.
    pub(super) walks: bool,
}

/// Shortest distance within which a walk arrives, in heights. With less, the creature would walk to and fro over the
/// place.
const LEAST_ARRIVAL_DISTANCE: f64 = 0.015;

impl Creature {
    /// Begins a walk or a turn, and draws a new place for patrols.
    pub(super) fn begin_way(&mut self) {
        let reach = self.config.arena.min(4.0 * self.size.height);
        let mut lot = || (self.state.brain.draw() >> 11) as f64 / (1u64 << 53) as f64;
        let (angle, share) = (core::f64::consts::TAU * lot(), lot().sqrt());
        let aside = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle));
        self.state.walked = Walked::default();
        self.state.territory.patrol = self.state.territory.home + aside * (0.9 * reach * share);
    }

    pub(super) fn way(&self, state: StateId) -> Option<Way> {
        match self.kind.brain().act(state)? {
            StateAction::Walk(Walk { to, within, .. }) => {
                let goal = self.within_arena(self.place_of(*to));
                let Some(strike) = &self.kind.act(state).strike else {
                    return Some(Way {
                        goal,
                        bearing: None,
                        within: within.max(LEAST_ARRIVAL_DISTANCE * self.size.height),
                        within_angle: 0.0,
                        walks: true,
                    });
                };
                let spot = strike.spot * self.size.scale;
                let reach = DVec3::new(spot.x, 0.0, spot.z).length();
                Some(Way {
                    goal,
                    bearing: Some(libm::atan2(spot.x, spot.z)),
                    within: reach + within,
                    within_angle: (within / reach.max(1e-3)).min(0.5),
                    walks: true,
                })
            }
            StateAction::Turn(turn) => Some(Way {
                goal: self.place_of(turn.to),
                bearing: Some(0.0),
                within: f64::INFINITY,
                within_angle: turn.within_deg.to_radians(),
                walks: false,
            }),
            _ => None,
        }
    }

    fn place_of(&self, place: Place) -> DVec3 {
        let territory = &self.state.territory;
        match place {
            Place::Prey => self.state.perceived.prey().unwrap_or(territory.home),
            Place::Home => territory.home,
            Place::Patrol => territory.patrol,
            Place::Noise => self.state.perceived.noise(),
            Place::Wall => self.wall(),
        }
    }

    /// A place beside the nearest wall; the creature's own place if no wall is in reach.
    fn wall(&self) -> DVec3 {
        let nearest = self.state.perceived.nearest_wall(self.state.yaw());
        let Some((angle, distance)) = nearest else {
            return self.state.position();
        };
        let direction = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle));
        let room = self.size.girth;
        self.state.position() + direction * (distance - room).max(0.0)
    }

    fn within_arena(&self, place: DVec3) -> DVec3 {
        let home = self.state.territory.home;
        let way = place - home;
        let level = DVec3::new(way.x, 0.0, way.z).length();
        if level <= self.config.arena {
            return place;
        }
        home + way * (self.config.arena / level)
    }
}
