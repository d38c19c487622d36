//! Tests whether skin encloses a point, however little of a creature's skin is closed.
//!
//! A ray from inside a closed surface to infinity leaves it once more than it enters it
//! ([`ModelSpace::is_inside`](clamber_surface::surface::ModelSpace::is_inside) has the sources). Models are often made
//! of open pieces that pass through each other, so no single ray can be trusted. Sixteen rays are cast, in opposite
//! pairs: behind a flat sheet of any size, at most half of them leave through it. Nearly all of them leave from inside
//! a creature, also where a neck is open below the head.
//!
//! An edit may add skin above a creature's own: a scab, a plate. A body cannot leave the hollow between them. From the
//! hollow's floor, half of all rays leave, and the others meet the creature's skin.

use clamber_surface::geometry::Ray;
use clamber_surface::surface::{ModelSpace, SurfaceHit};
use glam::Vec3;

/// One direction of each pair, some 49 degrees apart. They are at least 6 degrees off axes and planes of symmetry,
/// along which the edges of modelled creatures run.
const DIRECTIONS: [Vec3; 8] = [
    Vec3::new(0.509, -0.825, 0.246),
    Vec3::new(-0.351, -0.460, -0.816),
    Vec3::new(0.231, 0.966, 0.117),
    Vec3::new(0.570, 0.109, -0.815),
    Vec3::new(-0.861, -0.490, 0.139),
    Vec3::new(-0.205, 0.395, -0.896),
    Vec3::new(-0.457, 0.678, 0.576),
    Vec3::new(0.893, -0.107, 0.437),
];

/// Number of rays: both directions of each pair.
const RAYS: usize = 2 * DIRECTIONS.len();

/// A point is enclosed if at least this many rays leave. With fewer, rocks in an open bowl or under a dome would count
/// as enclosed; with more, rocks inside creatures with openings would not.
const ENCLOSED: usize = 14;

/// A point is in the open if at most this many rays leave: behind a flat sheet, half of all rays leave.
const OPEN: usize = RAYS / 2;

/// A point is in a hollow if [`ENCLOSED`] rays meet skin, and at least this many leave: skin that was added above other
/// skin closes it. From the floor of such a hollow, half of all rays leave through the added skin. With fewer, a rock
/// in a mouth could count, where parts that pass through each other let single rays leave.
const HOLLOW: usize = 6;

/// True if skin encloses a point, in model space, nearly all around. False for a point that is not finite. `hits` is
/// reused memory.
pub(super) fn is_enclosed(space: ModelSpace<'_>, point: Vec3, hits: &mut Vec<SurfaceHit>) -> bool {
    at_least(ENCLOSED, space, point, hits)
}

/// True if more skin than a flat sheet is around a point, in model space: a point that was
/// [enclosed](is_enclosed) is not out of the creature yet.
pub(super) fn is_within(space: ModelSpace<'_>, point: Vec3, hits: &mut Vec<SurfaceHit>) -> bool {
    at_least(OPEN + 1, space, point, hits)
}

/// True if at least `enough` rays leave, or if the point is in a hollow. Stops as soon as the result is certain.
fn at_least(enough: usize, space: ModelSpace<'_>, point: Vec3, hits: &mut Vec<SurfaceHit>) -> bool {
    let (mut leaving, mut meeting) = (0, 0);
    let directions = DIRECTIONS.into_iter().flat_map(|one| [one, -one]);
    for (asked, direction) in directions.enumerate() {
        let ray = Met::by(space, point, direction, hits);
        leaving += usize::from(ray.leaves);
        meeting += usize::from(ray.meets);
        let rest = RAYS - 1 - asked;
        let decided =
            |leaving, meeting| leaving >= enough || leaving >= HOLLOW && meeting >= ENCLOSED;
        if decided(leaving, meeting) {
            return true;
        }
        if !decided(leaving + rest, meeting + rest) {
            return false;
        }
    }
    false
}

/// How a ray met skin on its way to infinity.
struct Met {
    /// True if the ray met skin.
    meets: bool,
    /// True if the ray left the skin more often than it entered it.
    leaves: bool,
}

impl Met {
    fn by(space: ModelSpace<'_>, point: Vec3, direction: Vec3, hits: &mut Vec<SurfaceHit>) -> Self {
        let nothing = Self {
            meets: false,
            leaves: false,
        };
        let Some(ray) = Ray::new(point, direction) else {
            return nothing;
        };
        space.cast_ray_all(&ray, f32::INFINITY, hits);
        let crossings = hits.iter().map(|hit| {
            let along = hit.normal.dot(direction);
            i32::from(along > 0.0) - i32::from(along < 0.0)
        });
        let crossings: i32 = crossings.sum();
        let meets = !hits.is_empty();
        hits.clear();
        Self {
            meets,
            leaves: crossings > 0,
        }
    }
}
