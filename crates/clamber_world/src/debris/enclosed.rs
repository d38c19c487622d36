//! Whether skin encloses a point, however little of a creature's skin is closed.
//!
//! A ray from inside a closed surface to infinity leaves it once more than it enters it
//! ([`ModelSpace::is_inside`](clamber_surface::surface::ModelSpace::is_inside) has the sources). Models are often made of
//! open pieces that pass through each other, so no single ray can be trusted. Sixteen rays are cast, in opposite pairs:
//! behind a flat sheet of any size, at most half of them leave through it. Nearly all of them leave from inside a
//! creature, also where a neck is open below the head.

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

const RAYS: usize = 2 * DIRECTIONS.len();

/// A point is enclosed if at least this many rays leave. With fewer, rocks in an open bowl or under a dome would count as
/// enclosed; with more, rocks inside creatures with openings would not.
const ENCLOSED: usize = 14;

/// A point is in the open if at most this many rays leave: behind a flat sheet they are half of all.
const OPEN: usize = RAYS / 2;

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

/// True if at least `enough` rays leave. Stops as soon as that is decided.
fn at_least(enough: usize, space: ModelSpace<'_>, point: Vec3, hits: &mut Vec<SurfaceHit>) -> bool {
    let (mut leaving, mut asked) = (0, 0);
    for direction in DIRECTIONS.into_iter().flat_map(|one| [one, -one]) {
        leaving += usize::from(leaves(space, point, direction, hits));
        asked += 1;
        if leaving >= enough || leaving + (RAYS - asked) < enough {
            break;
        }
    }
    leaving >= enough
}

/// True if a ray leaves the skin more often than it enters it.
fn leaves(space: ModelSpace<'_>, point: Vec3, direction: Vec3, hits: &mut Vec<SurfaceHit>) -> bool {
    let Some(ray) = Ray::new(point, direction) else {
        return false;
    };
    space.cast_ray_all(&ray, f32::INFINITY, hits);
    let crossings = hits.iter().map(|hit| {
        let along = hit.normal.dot(direction);
        i32::from(along > 0.0) - i32::from(along < 0.0)
    });
    let crossings: i32 = crossings.sum();
    hits.clear();
    crossings > 0
}
