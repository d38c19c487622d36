//! The obstacles near a query, kept for later queries of the tick: among a hundred creatures, a climber queries only
//! the one or two that it can touch.

use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;

/// Metres added to the radius of a search, so that later queries of a tick, which are near the first, find their
/// obstacles without a new search.
const AHEAD: f64 = 1.0;

/// Factor from the radius of a query to the radius of a search, before [`AHEAD`] is added.
const FARTHER: f64 = 2.0;

/// Rounding error of a comparison of distances in f64, as a fraction of the distances.
const SLACK: f64 = 1e-12;

/// Obstacles whose bounds may meet a ball.
#[derive(Clone, Debug, Default)]
pub(crate) struct Surroundings {
    center: DVec3,
    /// `None` before the first search of a tick.
    radius: Option<f64>,
    /// By ascending id, with the index in the caller's list.
    near: Vec<(ObstacleId, u32)>,
}

impl Surroundings {
    /// Discards the found obstacles, for a new tick.
    pub(crate) fn forget(&mut self) {
        self.radius = None;
    }

    /// All obstacles whose bounds meet a ball, and possibly others, by ascending id. If two obstacles have the same id,
    /// the first in the list is used.
    pub(crate) fn near<'a>(
        &mut self,
        obstacles: &[(ObstacleId, &'a dyn Obstacle)],
        center: DVec3,
        radius: f64,
    ) -> impl Iterator<Item = (ObstacleId, &'a dyn Obstacle)> {
        let seen = self.radius.is_some_and(|seen| {
            let apart = center.distance(self.center);
            apart + radius + SLACK * (seen + center.length()) <= seen
        });
        if !seen {
            self.look(obstacles, center, radius * FARTHER + AHEAD);
        }
        let near = self.near.iter();
        near.map(|(id, index)| (*id, obstacles[*index as usize].1))
    }

    fn look(&mut self, obstacles: &[(ObstacleId, &dyn Obstacle)], center: DVec3, radius: f64) {
        (self.center, self.radius) = (center, Some(radius));
        self.near.clear();
        let all = obstacles.iter().enumerate();
        self.near
            .extend(all.map(|(index, (id, _))| (*id, index as u32)));
        self.near.sort_unstable();
        self.near.dedup_by_key(|(id, _)| *id);
        self.near.retain(|(_, index)| {
            let (_, obstacle) = obstacles[*index as usize];
            obstacle.bounds().is_none_or(|(middle, reach)| {
                let sum = reach + radius;
                middle.distance(center) <= sum + SLACK * (sum + middle.length())
            })
        });
    }
}
