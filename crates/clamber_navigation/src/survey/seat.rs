//! Where the climber's ball has room at a piece.

use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;

/// Most corrections until a ball has room.
const ROUNDS: u32 = 16;

/// How deep a ball may be in skin and still have room, as a share of its radius: a climber's margin is 1/40.
const GIVE: f64 = 0.02;

/// A ray from a piece to its ball starts so far above the piece, as a share of the radius, so that it does not meet the
/// piece itself.
const ABOVE: f64 = 0.01;

/// Finds where a ball of `radius` rests at a point of the skin: above it, moved out of the skin around. `None` if it
/// has no room within its radius, or other skin lies between it and the point.
pub(super) fn seat(
    surface: &SkinnedSurface,
    point: DVec3,
    normal: DVec3,
    radius: f64,
) -> Option<DVec3> {
    let wanted = point + normal * radius;
    let mut center = wanted;
    for _ in 0..ROUNDS {
        let Some((depth, direction)) = deepest(surface, center, radius) else {
            return is_seen(surface, point, normal, center, radius).then_some(center);
        };
        if depth <= GIVE * radius {
            return is_seen(surface, point, normal, center, radius).then_some(center);
        }
        center += direction * depth;
        if center.distance(wanted) > radius {
            return None;
        }
    }
    None
}

/// How deep a ball is in the skin that is nearest to its middle, and the way out; `None` if it touches nothing.
fn deepest(surface: &SkinnedSurface, center: DVec3, radius: f64) -> Option<(f64, DVec3)> {
    let hit = surface.in_world().closest_point(center, radius)?;
    let apart = center - hit.point;
    if apart.dot(hit.normal) < 0.0 {
        // Its middle is behind the skin.
        return Some((radius + hit.distance, hit.normal));
    }
    Some((radius - hit.distance, apart.normalize_or(hit.normal)))
}

/// True if no skin lies between a point and its ball.
fn is_seen(
    surface: &SkinnedSurface,
    point: DVec3,
    normal: DVec3,
    center: DVec3,
    radius: f64,
) -> bool {
    let from = point + normal * (ABOVE * radius);
    let way = center - from;
    let length = way.length();
    !surface
        .in_world()
        .intersects_ray(from, way, (length - ABOVE * radius).max(0.0))
}
