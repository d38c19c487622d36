use clamber_surface::geometry::WorldCapsule;
use clamber_surface::surface::TargetMotion;
use clamber_world::{MaterialPoint, Obstacle, ObstacleId};
use glam::DVec3;

use crate::arena::{CreatureId, Skins};

/// Obstacles that can stop a fighter's weapons. Weapons act from the body, and do not pass through obstacles.
#[derive(Clone, Copy)]
pub(crate) struct Around<'a> {
    pub(crate) skins: Skins<'a>,
    pub(crate) terrain: &'a [(ObstacleId, &'a dyn Obstacle)],
}

/// Length by which a line of sight stops short of its end, metres, so that an obstacle that only touches the end does
/// not hide it.
const SLACK: f64 = 0.01;

/// Share of the distance to an obstacle between body and hand at which a shot begins. Below 1, so that the shot does
/// not begin inside the obstacle.
const SHORT: f64 = 0.99;

impl Around<'_> {
    /// Where a point of a creature's skin is at the end of the tick. `place`, which is returned if the point has no
    /// motion, is its position at the hit.
    pub(crate) fn now(
        &self,
        creature: CreatureId,
        at: &MaterialPoint,
        place: DVec3,
        dt: f64,
    ) -> DVec3 {
        let skin = self.skins.get(creature);
        let motion = skin.and_then(|skin| Obstacle::motion(skin, at, dt));
        motion.map_or(place, |motion| motion.position)
    }

    /// True if an obstacle crosses one of the straight lines from each place to the next, at the end of the tick.
    /// Obstacles are the terrain, and the skins of all creatures but `creature`.
    pub(crate) fn hides(&self, places: &[DVec3], creature: Option<CreatureId>) -> bool {
        let mut lines = places.windows(2).map(|pair| {
            let way = pair[1] - pair[0];
            (pair[0], way, way.length() - SLACK)
        });
        lines.any(|(from, way, length)| {
            let meets = |obstacle: &dyn Obstacle| {
                length > 0.0 && obstacle.cast_ray(from, way, length).is_some()
            };
            let mut others = self.skins.iter().filter(|(id, _)| Some(*id) != creature);
            self.terrain.iter().any(|(_, obstacle)| meets(*obstacle))
                || others.any(|(_, skin)| meets(skin))
        })
    }

    /// Where a ball gets on a straight way from one place to another: to its end, or to a point just before the first
    /// obstacle in the way.
    pub(crate) fn reached(&self, from: DVec3, to: DVec3, radius: f64) -> DVec3 {
        let ball = WorldCapsule::ball(from, radius);
        let way = to - from;
        let time = |obstacle: &dyn Obstacle| {
            let hit = obstacle.cast_capsule(&ball, [way; 2], TargetMotion::Still)?;
            Some(hit.fraction)
        };
        let terrain = self.terrain.iter().filter_map(|(_, one)| time(*one));
        let times = terrain.chain(self.skins.iter().filter_map(|(_, skin)| time(skin)));
        let first = times.min_by(f64::total_cmp);
        first.map_or(to, |time| from + way * (SHORT * time))
    }
}
