//! Where climbers are drawn.

use bevy_ecs::prelude::*;
use bevy_time::{Fixed, Time};
use bevy_transform::components::Transform;
use clamber_world::{Attachment, Obstacle};
use glam::{DQuat, DVec3};

use super::component::{Climber, ClimberBody};
use super::step::facing;
use crate::PosedSurface;

/// Poses the surfaces that climbers are on as this frame draws them.
pub(super) fn pose_below(
    climbers: Query<&ClimberBody, With<Climber>>,
    mut surfaces: Query<&mut PosedSurface>,
) {
    for body in &climbers {
        for state in [&body.before, body.climber.state()] {
            let support = state.support.map(|support| support.attachment);
            let entity = support.and_then(|on| Entity::try_from_bits(on.obstacle.0));
            if let Some(entity) = entity
                && let Ok(mut surface) = surfaces.get_mut(entity)
            {
                surface.bypass_change_detection().pose_as_drawn();
            }
        }
    }
}

/// Writes the transforms of climbers.
pub(super) fn draw(
    time: Res<Time<Fixed>>,
    mut climbers: Query<(&mut ClimberBody, &mut Transform), With<Climber>>,
    surfaces: Query<&PosedSurface>,
) {
    let fraction = time.overstep_fraction_f64();
    for (mut body, mut transform) in &mut climbers {
        let body = body.bypass_change_detection();
        if transform.translation != body.drawn.translation {
            // The app has moved it; the next tick follows.
            continue;
        }
        let (before, now) = (&body.before, body.climber.state());
        let drawn = |at: &clamber_climber::ClimberState| on_drawn_skin(at, &surfaces);
        let (from, to) = (drawn(before), drawn(now));
        let position = from.0.lerp(to.0, fraction);
        let up = body.climber.config().up();
        let heading = from.1.lerp(to.1, fraction);
        let level = (heading - up * heading.dot(up)).normalize_or(now.heading);
        let Some(rotation) = facing(level, up) else {
            continue;
        };
        body.drawn = Transform {
            translation: position.as_vec3(),
            rotation: rotation.as_quat(),
            scale: transform.scale,
        };
        transform.set_if_neq(body.drawn);
    }
}

/// Position and heading of a state: on skin, as the frame draws it.
fn on_drawn_skin(
    state: &clamber_climber::ClimberState,
    surfaces: &Query<&PosedSurface>,
) -> (DVec3, DVec3) {
    let on_skin = state.support.and_then(|support| {
        let (place, turn) = followed(&support.attachment, surfaces)?;
        Some((place, turn * state.heading))
    });
    on_skin.unwrap_or((state.position, state.heading))
}

/// Where something attached to skin is drawn, and how much it is turned there from where the tick has it.
fn followed(attachment: &Attachment, surfaces: &Query<&PosedSurface>) -> Option<(DVec3, DQuat)> {
    let entity = Entity::try_from_bits(attachment.obstacle.0)?;
    let skin = surfaces.get(entity).ok()?.as_drawn()?;
    let motion = Obstacle::motion(skin, &attachment.material, 1.0)?;
    let frame = motion.frame.unwrap_or(attachment.frame);
    Some((
        motion.position + frame * attachment.offset,
        frame * attachment.frame.conjugate(),
    ))
}
