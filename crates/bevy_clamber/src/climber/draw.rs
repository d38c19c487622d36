//! Writes the transforms of climbers.

use bevy_ecs::prelude::*;
use bevy_time::{Fixed, Time};
use bevy_transform::components::Transform;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::Attachment;

use super::component::{Climber, ClimberBody};
use super::step::facing;
use crate::{DrawnSurface, PosedSurface, WorldOrigin};

pub(super) fn draw(
    tick: Res<Time<Fixed>>,
    frame: Res<Time>,
    mut climbers: Query<(&mut ClimberBody, &mut Transform), With<Climber>>,
    surfaces: Query<(&PosedSurface, &DrawnSurface)>,
    origin: Res<WorldOrigin>,
) {
    let fraction = tick.overstep_fraction_f64();
    let dt = frame.delta_secs_f64();
    let drawn = |on: &Attachment| -> Option<&SkinnedSurface> {
        let entity = Entity::try_from_bits(on.obstacle.0)?;
        let (surface, drawn) = surfaces.get(entity).ok()?;
        drawn.pose(surface)
    };
    for (mut body, mut transform) in &mut climbers {
        let body = body.bypass_change_detection();
        if body.is_moved(&transform, origin.0) {
            // The app has moved it; the next tick follows.
            continue;
        }
        let (position, heading) = {
            let base = body.climber.state().base_velocity;
            body.shown.draw(fraction, dt, base, drawn)
        };
        let up = body.climber.config().up();
        let level = heading - up * heading.dot(up);
        let heading = level.normalize_or(body.climber.state().heading);
        let Some(rotation) = facing(heading, up) else {
            continue;
        };
        body.drawn = Transform {
            translation: (position - origin.0).as_vec3(),
            rotation: rotation.as_quat(),
            scale: transform.scale,
        };
        body.origin = origin.0;
        transform.set_if_neq(body.drawn);
    }
}
