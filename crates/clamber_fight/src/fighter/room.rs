//! Room for a fighter: at a place, or as near to it as possible.

use clamber_climber::Climber;
use clamber_surface::geometry::WorldCapsule;
use clamber_world::{Contact, Obstacle, ObstacleId};
use glam::DVec3;

use super::Fighter;
use crate::arena::creature_of;

/// Number of rings of candidate places around a place.
const RING_COUNT: u32 = 16;
/// Places on the innermost ring. Each further ring has this many more, so that the distance along a ring stays the
/// same.
const PLACES_PER_RING: u32 = 6;
/// Distance between rings, in radii of the body. Equal bodies at neighbouring places do not touch.
const RING_DISTANCE: f64 = 2.5;

/// Number of further rings for a place inside a creature, since the creature may be larger than the inner rings.
const FAR_RINGS: u32 = 9;
/// Places on each further ring.
const FAR_PLACES: u32 = 24;
/// Ratio of the radii of consecutive further rings.
const FARTHER_RING_RATIO: f64 = 1.5;

/// A body has no room if an obstacle is nearer to its segment than this share of its radius, or if it overlaps another
/// body that is thinned likewise. Below 1, so that a body that stands on the ground has room.
const THINNED_BODY_SHARE: f64 = 0.8;

/// Radius of a body's core, as a share of its radius. A body whose core overlaps terrain is in rock.
const CORE_SHARE: f64 = 0.3;

/// Greatest depth of the ground below a place, in heights of the body. If the wanted place has ground, places without
/// ground are refused.
const DEEPEST_GROUND: f64 = 2.0;

/// Obstacles and bodies that take up room.
pub(crate) struct Room<'a> {
    /// Terrain and creatures.
    pub(crate) obstacles: &'a [(ObstacleId, &'a dyn Obstacle)],
    /// The bodies of other fighters.
    pub(crate) bodies: &'a [WorldCapsule],
}

impl Fighter {
    /// The free place nearest to `near` for this fighter. `None` if no place within about 40 radii is free, or within
    /// 1,500 radii if `near` is inside a creature.
    pub(crate) fn free_place(&self, near: DVec3, room: &Room<'_>) -> Option<DVec3> {
        let size = self.config.climber.body.radius;
        let body = |place: DVec3| Climber::new(self.config.climber, place).map(|new| new.body());
        let has_ground = |place: DVec3| {
            let depth = DEEPEST_GROUND * self.config.climber.body.height;
            let from = place + DVec3::Y * size;
            let mut all = room.obstacles.iter();
            all.any(|(_, obstacle)| {
                // An obstacle that the ray begins in is not ground.
                let hit = obstacle.cast_ray(from, DVec3::NEG_Y, depth);
                hit.is_some_and(|hit| hit.distance > 0.0)
            })
        };
        let needs_ground = has_ground(near);
        let is_free = |place: &DVec3| {
            let is_clear = body(*place).is_ok_and(|body| room.is_free(&body));
            is_clear && (!needs_ground || has_ground(*place))
        };
        let in_creature = room.obstacles.iter().any(|(id, obstacle)| {
            creature_of(*id).is_some() && is_inside(*obstacle, near + DVec3::Y * size)
        });
        let rings = if in_creature { FAR_RINGS } else { 0 };
        places(near, RING_DISTANCE * size, rings).find(is_free)
    }
}

impl Room<'_> {
    /// True if the core of a body overlaps terrain. Terrain pushes out only bodies that overlap it a little.
    pub(crate) fn is_in_rock(&self, body: &WorldCapsule) -> bool {
        let core = WorldCapsule {
            radius: CORE_SHARE * body.radius,
            ..*body
        };
        let mut contacts: Vec<Contact> = Vec::new();
        let terrain = self
            .obstacles
            .iter()
            .filter(|(id, _)| creature_of(*id).is_none());
        for (_, rock) in terrain {
            rock.overlap_capsule(&core, &mut contacts);
        }
        !contacts.is_empty()
    }

    /// True if a body overlaps no obstacle and no other body, and is not inside a creature.
    pub(crate) fn is_free(&self, body: &WorldCapsule) -> bool {
        let middle = 0.5 * (body.ends[0] + body.ends[1]);
        let mut contacts: Vec<Contact> = Vec::new();
        let clear = self.obstacles.iter().all(|(id, obstacle)| {
            contacts.clear();
            let slim = WorldCapsule {
                radius: THINNED_BODY_SHARE * body.radius,
                ..*body
            };
            obstacle.overlap_capsule(&slim, &mut contacts);
            contacts.is_empty() && (creature_of(*id).is_none() || !is_inside(*obstacle, middle))
        });
        clear && self.bodies.iter().all(|other| !overlap(body, other))
    }
}

/// True if a place may be inside a skin: at least two of six rays from it leave the skin through its back. From inside
/// not all six do, because skins have holes and overlapping pieces. From outside one ray may, through a hole.
fn is_inside(skin: &dyn Obstacle, place: DVec3) -> bool {
    let ways = [DVec3::X, DVec3::Y, DVec3::Z].map(|way| [way, -way]);
    let leaves = ways.as_flattened().iter().filter(|way| {
        let hit = skin.cast_ray(place, **way, f64::INFINITY);
        hit.is_some_and(|hit| hit.normal.dot(**way) > 0.0)
    });
    leaves.count() >= 2
}

/// True if two upright bodies overlap.
fn overlap(one: &WorldCapsule, other: &WorldCapsule) -> bool {
    let span = |body: &WorldCapsule| {
        let [a, b] = body.ends.map(|end| end.y);
        [a.min(b) - body.radius, a.max(b) + body.radius]
    };
    let ([low, high], [other_low, other_high]) = (span(one), span(other));
    let [a, b] = [one, other].map(|body| 0.5 * (body.ends[0] + body.ends[1]));
    let level = (a - b).with_y(0.0).length();
    low < other_high && other_low < high && level < THINNED_BODY_SHARE * (one.radius + other.radius)
}

/// Candidate places: the middle, then the rings around it from the inside out, then `far_rings` further rings.
fn places(middle: DVec3, apart: f64, far_rings: u32) -> impl Iterator<Item = DVec3> {
    let near = (1..=RING_COUNT).map(move |ring| (PLACES_PER_RING * ring, apart * f64::from(ring)));
    let last = apart * f64::from(RING_COUNT);
    let far = (0..far_rings).scan(last, |radius, _| {
        *radius *= FARTHER_RING_RATIO;
        Some((FAR_PLACES, *radius))
    });
    let rings = near.chain(far).flat_map(move |(count, radius)| {
        (0..count).map(move |index| {
            let angle = core::f64::consts::TAU * f64::from(index) / f64::from(count);
            let (sin, cos) = libm::sincos(angle);
            middle + DVec3::new(sin, 0.0, cos) * radius
        })
    });
    core::iter::once(middle).chain(rings)
}
