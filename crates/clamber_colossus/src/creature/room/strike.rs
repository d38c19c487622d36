//! Whether an attack would go through rock.

use clamber_surface::geometry::WorldCapsule;
use clamber_world::SweepContact;
use glam::DVec3;

use super::{LEAST_GROUND_NORMAL, STEP_OVER_HEIGHT, first};
use crate::creature::{Creature, Surroundings};
use crate::kind::{Strike, Swept};

impl Creature {
    /// False if a part of the creature would go through rock or another creature in an attack. Obstacles low enough to
    /// step over do not count. Neither does ground: feet come down on it, and hands may strike it.
    pub(in crate::creature) fn may_strike(
        &self,
        strike: &Strike,
        around: &Surroundings<'_>,
    ) -> bool {
        let world = self.state.world_from_model(self.size.scale);
        let low = self.state.position().y + STEP_OVER_HEIGHT * self.size.height;
        for Swept { radius, aims, way } in &strike.swept {
            let count = way.len().max(2) as f64 - 1.0;
            let places = way.iter().enumerate().map(|(index, place)| {
                // A limb that aims goes gradually to its target.
                let share = if *aims { index as f64 / count } else { 0.0 };
                let place = world.transform_point(*place) + self.state.striking.aim() * share;
                place.with_y(place.y.max(low + radius * self.size.scale))
            });
            let places: Vec<DVec3> = places.collect();
            for pair in places.windows(2) {
                let ball = WorldCapsule::ball(pair[0], radius * self.size.scale);
                let way = pair[1] - pair[0];
                // An obstacle that the ball starts in, or moves away from, is not in its way.
                let mut is_rock = |hit: &SweepContact| {
                    let normal = hit.separation_normal;
                    !hit.started_inside && normal.y < LEAST_GROUND_NORMAL && normal.dot(way) < 0.0
                };
                for obstacles in [around.terrain, around.creatures] {
                    if first(obstacles, &ball, [way; 2], &mut is_rock).is_some() {
                        return false;
                    }
                }
            }
        }
        true
    }
}
