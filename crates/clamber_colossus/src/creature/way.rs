//! Ways of a creature: the goals of its walks and turns.

use glam::DVec3;

use super::Creature;
use super::state::{NO_WALL, WALLS, Walked};
use crate::brain::{Act, Place, StateId, Walk};

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
const NEAREST: f64 = 0.015;

impl Creature {
    /// Begins a walk or a turn, and draws a new place for patrols.
    pub(super) fn begin_way(&mut self) {
        let reach = self.config.arena.min(4.0 * self.size.height);
        let mut lot = || (self.state.brain.draw() >> 11) as f64 / (1u64 << 53) as f64;
        let (angle, share) = (core::f64::consts::TAU * lot(), lot().sqrt());
        let aside = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle));
        self.state.walked = Walked::default();
        self.state.patrol = self.state.home + aside * (0.9 * reach * share);
    }

    pub(super) fn way(&self, state: StateId) -> Option<Way> {
        match self.kind.brain().act(state)? {
            Act::Walk(Walk { to, within, .. }) => {
                let goal = self.within_arena(self.place_of(*to));
                let Some(strike) = &self.kind.act(state).strike else {
                    return Some(Way {
                        goal,
                        bearing: None,
                        within: within.max(NEAREST * self.size.height),
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
            Act::Turn(turn) => Some(Way {
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
        match place {
            Place::Prey => self.state.prey.map_or(self.state.home, |(_, place)| place),
            Place::Home => self.state.home,
            Place::Patrol => self.state.patrol,
            Place::Noise => self.state.noise,
            Place::Wall => self.wall(),
        }
    }

    /// A place beside the nearest wall; the creature's own place if no wall is in reach.
    fn wall(&self) -> DVec3 {
        let walls = self.state.walls.iter().enumerate();
        let Some((index, distance)) = walls.min_by(|a, b| a.1.total_cmp(b.1)) else {
            return self.state.position;
        };
        if *distance >= NO_WALL {
            return self.state.position;
        }
        let angle = self.state.yaw + index as f64 * core::f64::consts::TAU / WALLS as f64;
        let direction = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle));
        let room = self.size.girth;
        self.state.position + direction * (f64::from(*distance) - room).max(0.0)
    }

    fn within_arena(&self, place: DVec3) -> DVec3 {
        let way = place - self.state.home;
        let level = DVec3::new(way.x, 0.0, way.z).length();
        if level <= self.config.arena {
            return place;
        }
        self.state.home + way * (self.config.arena / level)
    }
}
