use clamber_surface::geometry::WorldCapsule;
use clamber_surface::surface::TargetMotion;
use clamber_world::{MaterialPoint, Obstacle, ObstacleId};
use glam::DVec3;

use crate::arena::{CreatureId, Skins};

/// What may come between a fighter and where its weapons go: they begin at the body, and go through nothing.
#[derive(Clone, Copy)]
pub(crate) struct Around<'a> {
    pub(crate) skins: Skins<'a>,
    pub(crate) terrain: &'a [(ObstacleId, &'a dyn Obstacle)],
}

/// What touches a place within this distance is not before it, metres.
const SLACK: f64 = 0.01;

/// A shot that meets something before it has left the hand begins this share of the way before that.
const SHORT: f64 = 0.99;

impl Around<'_> {
    /// Where a point of a creature's skin, which was somewhere within the tick, is at its end.
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

    /// True if terrain, or the skin of another creature than that one, is on one of the straight lines from each of these
    /// places to the next, all at the end of the tick.
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

    /// Where a ball gets that goes straight from a place to another one, as far as nothing is in its way.
    pub(crate) fn reached(&self, from: DVec3, to: DVec3, radius: f64) -> DVec3 {
        let ball = WorldCapsule::ball(from, radius);
        let way = to - from;
        let time = |obstacle: &dyn Obstacle| {
            let hit = obstacle.cast_capsule(&ball, [way; 2], TargetMotion::Still)?;
            Some(hit.time)
        };
        let terrain = self.terrain.iter().filter_map(|(_, one)| time(*one));
        let times = terrain.chain(self.skins.iter().filter_map(|(_, skin)| time(skin)));
        let first = times.min_by(f64::total_cmp);
        first.map_or(to, |time| from + way * (SHORT * time))
    }
}
