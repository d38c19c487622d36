use clamber_world::Obstacle;
use glam::DVec3;

/// The ground, which feet find by rays down.
#[derive(Clone, Copy)]
pub(crate) struct Ground<'a> {
    pub(crate) terrain: &'a [&'a dyn Obstacle],
    /// Distance above and below a place within which the ground is found, metres.
    pub(crate) reach: f64,
}

/// Sideways offset of the rays that are cast if the first one finds no ground, as a share of the reach.
const SIDE_RAY_OFFSET: f64 = 1e-4;

impl Ground<'_> {
    /// Height of the ground below a place, and its normal, which points up; `None` if no ground is in reach.
    pub(crate) fn below(&self, place: DVec3) -> Option<(f64, DVec3)> {
        // Rapier's rays may slip through the edge between two triangles.
        let aside = SIDE_RAY_OFFSET * self.reach;
        // The offset is along neither the sides nor the diagonals of a height field's cells.
        let places = [0.0, aside, -aside].map(|aside| place + DVec3::new(aside, 0.0, 0.6 * aside));
        places.into_iter().find_map(|place| self.cast(place))
    }

    fn cast(&self, place: DVec3) -> Option<(f64, DVec3)> {
        let from = place + DVec3::Y * self.reach;
        let hits = self.terrain.iter().filter_map(|obstacle| {
            let hit = obstacle.cast_ray(from, -DVec3::Y, 2.0 * self.reach)?;
            let up = if hit.normal.y < 0.0 {
                -hit.normal
            } else {
                hit.normal
            };
            Some((hit.point.y, up))
        });
        hits.max_by(|a, b| a.0.total_cmp(&b.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clamber_world::rapier3d::math::Vector;
    use clamber_world::rapier3d::parry::utils::Array2;
    use clamber_world::rapier3d::prelude::{ColliderBuilder, PhysicsWorld};
    use clamber_world::{BodyPoses, RapierTerrain};

    /// Rays slip through a height field beside the lines of its cells, within rounding errors. The ground is found
    /// nevertheless.
    #[test]
    fn no_ray_slips_through_the_ground() {
        /// Number of heights along each side of the height field.
        const FIELD_LINES: usize = 401;
        let heights = Array2::new(
            FIELD_LINES,
            FIELD_LINES,
            vec![0.0; FIELD_LINES * FIELD_LINES],
        );
        let field = ColliderBuilder::heightfield(heights, Vector::new(400.0, 1.0, 400.0));
        let mut world = PhysicsWorld::default();
        world.insert_collider(field, None);
        world.detect_collisions(&(), &());
        let poses = BodyPoses::default();
        let terrain = RapierTerrain::of_world(&world, &poses);
        let terrain: [&dyn Obstacle; 1] = [&terrain];
        for reach in [0.5, 10.0, 30.0] {
            let ground = Ground {
                terrain: &terrain,
                reach,
            };
            let mut slipped = 0;
            for line in -190..190 {
                for step in -8..9 {
                    let z = f64::from(line) + f64::from(step) * 4e-6;
                    let place = DVec3::new(0.3, 0.2, z);
                    slipped += u32::from(ground.cast(place).is_none());
                    assert!(ground.below(place).is_some(), "{z}");
                }
            }
            println!("{slipped} rays of 6460 slip through");
            assert!(slipped > 100, "{slipped}");
        }
    }
}
