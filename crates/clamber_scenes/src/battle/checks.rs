//! What the scene holds against the climber, by means that owe nothing to it.

use clamber_climber::{Climber, ClimberMode};
use clamber_surface::rig::Palette;
use clamber_surface::skin::skin_vertex_reference;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{MaterialPoint, Obstacle};
use glam::DVec3;

use super::CREATURE;
use crate::{solid_angle, valley};

/// Ticks between two looks at whether the climber is inside the creature, which take longer than the
/// tick itself: they go over all triangles.
const INSIDE_EVERY: u64 = 10;

/// Watches a climber from tick to tick.
#[derive(Clone, Debug, Default)]
pub(super) struct Watch {
    /// The material point under the climber when it landed or its input ended.
    recorded: Option<MaterialPoint>,
    /// Ticks at which its centre was seen inside the creature or under the ground.
    pub(super) fell_through: u32,
    /// Ticks at which who climbs was farther from its hold than its arms are long.
    pub(super) out_of_reach: u32,
    /// Deepest that the sphere reached into the skin while it stood without input, metres.
    pub(super) deepest: f64,
}

impl Watch {
    /// Looks at one tick. Of a rider gives the drift, if it rode through all of the tick without input; of one who climbs,
    /// and may be shoved where creases close, how far its contact is from its own material point.
    pub(super) fn tick(
        &mut self,
        surface: &SkinnedSurface,
        palette: &Palette,
        climber: &Climber,
        (idle, climbs): (bool, bool),
        tick: u64,
    ) -> Option<f64> {
        let state = climber.state();
        let center = state.position;
        let look_inside = tick.is_multiple_of(INSIDE_EVERY);
        let under_ground = center.y < valley::height(center.x, center.z);
        if under_ground || look_inside && is_inside(surface, center) {
            self.fell_through += 1;
        }
        if climbs {
            let support = state
                .support
                .filter(|s| s.attachment.obstacle == CREATURE)?;
            let place = reference_position(surface, palette, &support.attachment.point);
            let place = place.unwrap_or(DVec3::INFINITY);
            self.out_of_reach += u32::from(center.distance(place) > reach(climber));
            return Some(support.attachment.contact.distance(place));
        }
        let riding = state
            .support
            .filter(|support| support.attachment.obstacle == CREATURE && idle);
        let Some(support) = riding else {
            self.recorded = None;
            return None;
        };
        let Some(recorded) = self.recorded else {
            self.recorded = Some(support.attachment.point);
            return None;
        };
        let radius = climber.config().body.radius;
        if let Some(nearest) = Obstacle::closest_point(surface, center, radius) {
            self.deepest = self.deepest.max(radius - nearest.distance);
        }
        // Off its point, or out of touch with it.
        let off = |expected: DVec3| {
            let gap = (center.distance(expected) - radius).abs();
            support.attachment.contact.distance(expected).max(gap)
        };
        Some(reference_position(surface, palette, &recorded).map_or(f64::INFINITY, off))
    }
}

/// How far a climber's centre may be from what it stands on or holds, metres.
fn reach(climber: &Climber) -> f64 {
    let config = climber.config();
    let body = config.body.radius + config.grip.map_or(0.0, |grip| grip.reach);
    let ledge = config
        .ledge
        .map_or(0.0, |ledge| ledge.reach_up + ledge.reach);
    match climber.state().mode {
        ClimberMode::Hanging => config.hang.arm_length.max(body) * 1.5,
        ClimberMode::LedgeHanging => body + ledge,
        _ => body,
    }
}

/// Where a material point of the creature is, in f64 from the palette on: none of the surface's own
/// skinning, interpolation or carrying.
fn reference_position(
    surface: &SkinnedSurface,
    palette: &Palette,
    point: &MaterialPoint,
) -> Option<DVec3> {
    let corners = surface.mesh().triangles().get(point.key as usize)?;
    let mut position = DVec3::ZERO;
    for (vertex, weight) in corners.iter().zip(point.coordinates) {
        position += skin_vertex_reference(surface.mesh(), palette.matrices(), *vertex)? * weight;
    }
    Some(surface.world_from_model().transform_point(position))
}

/// True if a point of the world is inside the creature.
fn is_inside(surface: &SkinnedSurface, point: DVec3) -> bool {
    let in_model = surface.world_from_model().inverse_transform_point(point);
    let mut positions = Vec::new();
    surface.skin_all(&mut positions);
    solid_angle::is_inside(&positions, surface.mesh(), in_model)
}
