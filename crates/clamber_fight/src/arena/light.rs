//! The light of a raised sword, which shows the way to the next weak point.

use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;

use super::{Arena, CreatureId};
use crate::fighter::FighterId;

/// Rays of a sword in the sun.
const RAYS: usize = 12;

/// The half angle of the rays' cone while the sword points away, and while it points at the weak point, radians.
const WIDE: f64 = 0.6;
const NARROW: f64 = 0.005;

/// How far the sun is looked for, metres.
const SHADE: f64 = 2000.0;

/// The light of a sword.
#[derive(Clone, Debug, PartialEq)]
pub struct SwordLight {
    /// Where the rays begin: at the blade's tip.
    pub origin: DVec3,
    /// Whose weak point they lead to.
    pub creature: CreatureId,
    /// The weak point, by its index.
    pub weak_point: usize,
    /// Angle between where the sword points and the weak point, radians.
    pub off: f64,
    /// Half angle of the rays' cone, radians: the smaller, the nearer the sword points to the weak point.
    pub spread: f64,
    /// The rays: unit vectors around the direction in which the sword points. At the smallest spread all of them lead
    /// to the weak point.
    pub rays: [DVec3; RAYS],
}

impl Arena {
    /// The light of a fighter's sword that points along `aim`, a direction in world space: rays that gather as it turns
    /// to the nearest weak point that can be hurt now. `None` in the shade of terrain or creatures, without a sword,
    /// and if no weak point is open.
    pub fn sword_light(
        &self,
        fighter: FighterId,
        aim: DVec3,
        terrain: &[(ObstacleId, &dyn Obstacle)],
    ) -> Option<SwordLight> {
        let aim = aim.try_normalize()?;
        let origin = self.fighter(fighter)?.blade()?.tip;
        let sun = self.config.sun.try_normalize()?;
        let creatures = self.creatures().map(|(_, one)| {
            let obstacle: &dyn Obstacle = one.surface();
            obstacle
        });
        let all = terrain
            .iter()
            .map(|(_, obstacle)| *obstacle)
            .chain(creatures);
        if all
            .into_iter()
            .any(|one| one.cast_ray(origin, sun, SHADE).is_some())
        {
            return None;
        }
        let (creature, weak_point, place) = self.next_weak_point(origin)?;
        let to = (place - origin).try_normalize()?;
        let off = libm::atan2(aim.cross(to).length(), aim.dot(to));
        let spread = NARROW + (WIDE - NARROW) * (off / core::f64::consts::PI);
        // The nearer it points, the more its rays lean to the weak point.
        let (aside, along) = (aim.any_orthonormal_vector(), aim);
        let other = along.cross(aside);
        let gathered = 1.0 - off / core::f64::consts::PI;
        let middle = (aim * (1.0 - gathered) + to * gathered).normalize_or(aim);
        let (sin, cos) = libm::sincos(spread);
        let rays = core::array::from_fn(|ray| {
            let (y, x) = libm::sincos(ray as f64 / RAYS as f64 * core::f64::consts::TAU);
            let radial = aside * x + other * y;
            let radial = (radial - middle * radial.dot(middle)).normalize_or(aside);
            middle * cos + radial * sin
        });
        Some(SwordLight {
            origin,
            creature,
            weak_point,
            off,
            spread,
            rays,
        })
    }

    /// The weak point nearest to a place among those that can be hurt now, and where it is.
    pub fn next_weak_point(&self, from: DVec3) -> Option<(CreatureId, usize, DVec3)> {
        let open = self.creatures().flat_map(|(id, creature)| {
            let points = 0..creature.kind().weak_points().len();
            points.filter_map(move |index| {
                let place = creature
                    .weak_point(index)
                    .filter(|_| creature.is_open(index))?;
                Some((id, index, place))
            })
        });
        open.min_by(|a, b| {
            let [x, y] = [a, b].map(|one| one.2.distance_squared(from));
            x.total_cmp(&y).then((a.0, a.1).cmp(&(b.0, b.1)))
        })
    }
}
