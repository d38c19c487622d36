//! Which obstacles of a tick are near: of a hundred creatures, a climber asks the one or two that it can touch.

use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;

/// How much farther than a query reaches one looks around, metres and as a factor: later queries of the step are near
/// the first.
const AHEAD: f64 = 1.0;
const FARTHER: f64 = 2.0;

/// How much more than the sum of both radii apart counts as near, as a share: what comparing in f64 may be off.
const SLACK: f64 = 1e-12;

/// Obstacles that may have something within a ball.
#[derive(Clone, Debug, Default)]
pub(crate) struct Surroundings {
    center: DVec3,
    /// `None` before one has looked.
    radius: Option<f64>,
    /// By ascending id; where in the caller's list.
    near: Vec<(ObstacleId, u32)>,
}

impl Surroundings {
    /// For a new tick.
    pub(crate) fn forget(&mut self) {
        self.radius = None;
    }

    /// All obstacles that may have something within a ball, and perhaps others, by ascending id. Of two with one id the
    /// first counts.
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
