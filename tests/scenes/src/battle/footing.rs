//! Where a climber is relative to its material point, computed independently of the climber.

use clamber_climber::{Climber, ClimberMode};
use clamber_surface::measure::skin_vertex_reference;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{MaterialPoint, Obstacle};
use glam::DVec3;

use super::Battle;
use super::checks::MAX_DRIFT;
use crate::solid_angle;

/// How far a rider's body at a place is off its material point: the position of the point in the world, the distance of
/// the body's surface from it, metres, which is negative for a point inside the body, and whether other skin pushed the
/// body away.
///
/// A body counts as pushed off its point if the ball touches skin now, and would overlap skin if it stood upright on
/// the point: where folding skin leaves its ball no room at the point, the climber stays attached to the point and
/// leans away, by design. Any other distance is a gap.
pub(super) fn off_its_point(
    (battle, center): (&Battle<'_>, DVec3),
    recorded: &MaterialPoint,
    radius: f64,
) -> (DVec3, f64, bool) {
    let point = reference_position(battle, recorded).unwrap_or(DVec3::INFINITY);
    let off = center.distance(point) - radius;
    let touches = |center, radius| battle.surface().closest_point(center, radius).is_some();
    let is_pushed = off > MAX_DRIFT
        && touches(center, radius + MAX_DRIFT)
        && reference_normal(battle, recorded)
            .is_some_and(|normal| touches(point + normal * radius, radius - MAX_DRIFT));
    (point, off, is_pushed)
}

/// Stretch of a climber's arms before it loses its hold, as a share of its radius: the climber's own bound.
const GIVE: f64 = 0.25;

/// Largest distance of a climber's centre from the point that it stands on or holds, metres, in its mode.
pub(super) fn reach(climber: &Climber) -> f64 {
    let config = climber.config();
    let body = config.body.radius + config.grip.map_or(0.0, |grip| grip.reach);
    let ledge = config
        .ledge
        .map_or(0.0, |ledge| ledge.reach_up + ledge.reach);
    match climber.state().mode {
        ClimberMode::Hanging => config.hang.arm_length.max(body) * 1.5,
        ClimberMode::LedgeHanging => body + ledge,
        ClimberMode::Holding => body + GIVE * config.body.radius,
        _ => body,
    }
}

/// Corners of a material point's triangle in the world, computed in f64 from the palette, without the surface's own
/// skinning, interpolation or carrying. `None` if there is no such triangle.
fn reference_corners(battle: &Battle<'_>, point: &MaterialPoint) -> Option<[DVec3; 3]> {
    let (surface, matrices) = (battle.surface(), battle.palette().matrices());
    let corners = surface.mesh().triangles().get(point.key as usize)?;
    let [a, b, c] = corners.map(|vertex| {
        let in_model = skin_vertex_reference(surface.mesh(), matrices, vertex)?;
        Some(surface.world_from_model().transform_point(in_model))
    });
    Some([a?, b?, c?])
}

/// Position of a material point of the creature in the world, from [`reference_corners`].
pub(super) fn reference_position(battle: &Battle<'_>, point: &MaterialPoint) -> Option<DVec3> {
    let corners = reference_corners(battle, point)?;
    let weighted = corners.iter().zip(point.coordinates).map(|(c, w)| *c * w);
    Some(weighted.fold(DVec3::ZERO, |sum, part| sum + part))
}

/// Unit normal of the skin at a material point; `None` where the triangle has collapsed.
fn reference_normal(battle: &Battle<'_>, point: &MaterialPoint) -> Option<DVec3> {
    let [a, b, c] = reference_corners(battle, point)?;
    (b - a).cross(c - a).try_normalize()
}

/// True if a point of the world is inside the creature.
pub(super) fn is_inside(surface: &SkinnedSurface, point: DVec3) -> bool {
    let in_model = surface.world_from_model().inverse_transform_point(point);
    let mut positions = Vec::new();
    surface.skin_all(&mut positions);
    solid_angle::is_inside_skin(&positions, surface, in_model)
}
