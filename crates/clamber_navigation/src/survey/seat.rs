//! Finds the seat of a piece: a position of the climber's ball on it.

use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;

/// The most corrections of a ball's position. A ball that is not free after these has no seat.
const MOST_CORRECTIONS: u32 = 16;

/// Depth in skin up to which a ball still has room, as a share of its radius. A climber's own margin is 1/40.
const ALLOWED_DEPTH: f64 = 0.02;

/// Offset of a ray's start above its piece, as a share of the radius, so that the ray does not hit the piece itself.
const RAY_START_HEIGHT: f64 = 0.01;

/// Finds where a ball of `radius` rests at a point of the skin: above the point, moved out of the skin around. `None`
/// if that moves it by more than its radius, or if other skin lies between it and the point.
pub(super) fn seat(
    surface: &SkinnedSurface,
    point: DVec3,
    normal: DVec3,
    radius: f64,
) -> Option<DVec3> {
    let wanted = point + normal * radius;
    let mut center = wanted;
    for _ in 0..MOST_CORRECTIONS {
        let Some((depth, direction)) = deepest(surface, center, radius) else {
            return is_seen(surface, point, normal, center, radius).then_some(center);
        };
        if depth <= ALLOWED_DEPTH * radius {
            return is_seen(surface, point, normal, center, radius).then_some(center);
        }
        center += direction * depth;
        if center.distance(wanted) > radius {
            return None;
        }
    }
    None
}

/// Depth of a ball in the skin nearest to its middle, and the direction out of the skin; `None` if the ball touches no
/// skin.
fn deepest(surface: &SkinnedSurface, center: DVec3, radius: f64) -> Option<(f64, DVec3)> {
    let hit = surface.in_world().closest_point(center, radius)?;
    let apart = center - hit.point;
    if apart.dot(hit.normal) < 0.0 {
        // The ball's middle is behind the skin.
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
    let from = point + normal * (RAY_START_HEIGHT * radius);
    let way = center - from;
    let length = way.length();
    !surface
        .in_world()
        .intersects_ray(from, way, (length - RAY_START_HEIGHT * radius).max(0.0))
}
