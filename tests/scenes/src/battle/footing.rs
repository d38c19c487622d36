//! Where a climber is relative to its material point, computed independently of the climber.

use clamber_climber::{Climber, ClimberMode};
use clamber_surface::measure::skin_vertex_reference;
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{MaterialPoint, Obstacle};
use glam::DVec3;

use super::checks::MAX_DRIFT;
use crate::solid_angle;

/// How far a rider's body is off its material point. A distance is not a drift: where folding skin leaves its ball no
/// room at the point, the climber stays attached to the point and leans away, by design.
#[derive(Clone, Copy, Debug)]
pub(super) struct Off {
    /// Position of the point in the world.
    pub(super) point: DVec3,
    /// Depth of the point in the body, metres.
    pub(super) sunk: f64,
    /// Distance of the body from the point with no skin in between, metres.
    pub(super) gap: f64,
    /// Distance of the body from the point because of other skin, metres.
    pub(super) pushed: f64,
}

impl Off {
    /// Measures a body at `center`. It counts as pushed off its point if the ball touches skin now, and would overlap
    /// skin if it stood upright on the point. Any other distance is a gap.
    pub(super) fn measure(
        surface: &SkinnedSurface,
        palette: &Palette,
        recorded: &MaterialPoint,
        center: DVec3,
        radius: f64,
    ) -> Self {
        let Some(point) = reference_position(surface, palette, recorded) else {
            return Self {
                point: DVec3::INFINITY,
                sunk: 0.0,
                gap: f64::INFINITY,
                pushed: 0.0,
            };
        };
        let off = center.distance(point) - radius;
        let is_pushed = off > MAX_DRIFT
            && touches(surface, center, radius + MAX_DRIFT)
            && reference_normal(surface, palette, recorded).is_some_and(|normal| {
                touches(surface, point + normal * radius, radius - MAX_DRIFT)
            });
        let (gap, pushed) = if is_pushed { (0.0, off) } else { (off, 0.0) };
        Self {
            point,
            sunk: (-off).max(0.0),
            gap: gap.max(0.0),
            pushed,
        }
    }
}

fn touches(surface: &SkinnedSurface, center: DVec3, radius: f64) -> bool {
    surface.closest_point(center, radius).is_some()
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
fn reference_corners(
    surface: &SkinnedSurface,
    palette: &Palette,
    point: &MaterialPoint,
) -> Option<[DVec3; 3]> {
    let corners = surface.mesh().triangles().get(point.key as usize)?;
    let mut places = [DVec3::ZERO; 3];
    for (place, vertex) in places.iter_mut().zip(corners) {
        let in_model = skin_vertex_reference(surface.mesh(), palette.matrices(), *vertex)?;
        *place = surface.world_from_model().transform_point(in_model);
    }
    Some(places)
}

/// Position of a material point of the creature in the world, from [`reference_corners`].
pub(super) fn reference_position(
    surface: &SkinnedSurface,
    palette: &Palette,
    point: &MaterialPoint,
) -> Option<DVec3> {
    let corners = reference_corners(surface, palette, point)?;
    let weighted = corners.iter().zip(point.coordinates).map(|(c, w)| *c * w);
    Some(weighted.fold(DVec3::ZERO, |sum, part| sum + part))
}

/// Unit normal of the skin at a material point; `None` where the triangle has collapsed.
fn reference_normal(
    surface: &SkinnedSurface,
    palette: &Palette,
    point: &MaterialPoint,
) -> Option<DVec3> {
    let [a, b, c] = reference_corners(surface, palette, point)?;
    (b - a).cross(c - a).try_normalize()
}

/// True if a point of the world is inside the creature.
pub(super) fn is_inside(surface: &SkinnedSurface, point: DVec3) -> bool {
    let in_model = surface.world_from_model().inverse_transform_point(point);
    let mut positions = Vec::new();
    surface.skin_all(&mut positions);
    solid_angle::is_inside_skin(&positions, surface, in_model)
}
