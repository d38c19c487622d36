//! The light of a sword, which shows the way to the next weak point.

use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;

use super::{Arena, CreatureId};
use crate::fighter::FighterId;

/// Number of rays of a sword's light.
const LIGHT_RAYS: usize = 12;

/// Half angle of the rays' cone while the sword points directly away from the weak point, radians.
const WIDE_CONE_ANGLE: f64 = 0.6;
/// Half angle of the rays' cone while the sword points at the weak point, radians.
const NARROW_CONE_ANGLE: f64 = 0.005;

/// Length of the ray towards the sun, metres. Obstacles farther away cast no shade on the sword.
const SHADE_DISTANCE: f64 = 2000.0;

/// Rays of light from a fighter's sword that lead a player to a weak point, for drawing: [`Arena::sword_light`] makes
/// them. The nearer the sword points to the weak point, the narrower they are.
#[derive(Clone, Debug, PartialEq)]
pub struct SwordLight {
    /// Origin of the rays, in world space, metres: the blade's tip.
    pub origin: DVec3,
    /// The creature whose weak point the rays lead to.
    pub creature: CreatureId,
    /// Index of the weak point in its creature's
    /// [`CreatureKind::weak_points`](clamber_colossus::CreatureKind::weak_points).
    pub weak_point: usize,
    /// Angle between the sword's direction and the direction to the weak point, radians.
    pub off: f64,
    /// Half angle of the rays' cone, radians. It shrinks as the sword turns towards the weak point.
    pub spread: f64,
    /// The rays: unit vectors in world space around a direction between the sword's and the weak point's. At the
    /// smallest spread all of them lead to the weak point.
    pub rays: [DVec3; LIGHT_RAYS],
}

impl Arena {
    /// Rays of light from a fighter's sword, for drawing: they show the player where the nearest weak point that can be
    /// hurt now is. `aim` is the direction in which the sword points, in world space; the rays gather as it turns
    /// towards that weak point. `None` if there is no such fighter or it has no sword, if terrain or a creature is
    /// between the blade's tip and the sun within 2,000 m of the tip, if no weak point is open, if the blade's tip is
    /// at the weak point, or if `aim` or the direction to the sun is zero.
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
            .any(|one| one.cast_ray(origin, sun, SHADE_DISTANCE).is_some())
        {
            return None;
        }
        let (creature, weak_point, place) = self.next_weak_point(origin)?;
        let to = (place - origin).try_normalize()?;
        let off = libm::atan2(aim.cross(to).length(), aim.dot(to));
        let spread = NARROW_CONE_ANGLE
            + (WIDE_CONE_ANGLE - NARROW_CONE_ANGLE) * (off / core::f64::consts::PI);
        // The closer the sword points to the weak point, the more the cone's axis leans towards it.
        let (aside, along) = (aim.any_orthonormal_vector(), aim);
        let other = along.cross(aside);
        let gathered = 1.0 - off / core::f64::consts::PI;
        let middle = (aim * (1.0 - gathered) + to * gathered).normalize_or(aim);
        let (sin, cos) = libm::sincos(spread);
        let rays = core::array::from_fn(|ray| {
            let (y, x) = libm::sincos(ray as f64 / LIGHT_RAYS as f64 * core::f64::consts::TAU);
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

    /// The weak point nearest to a place among those that can be hurt now: its creature, its index in
    /// [`CreatureKind::weak_points`](clamber_colossus::CreatureKind::weak_points), and its centre in world space,
    /// metres.
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
