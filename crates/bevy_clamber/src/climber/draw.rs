//! Where climbers are drawn.

use bevy_ecs::prelude::*;
use bevy_time::{Fixed, Time};
use bevy_transform::components::Transform;
use clamber_world::{Attachment, Obstacle};
use glam::{DQuat, DVec3};

use super::component::{Climber, ClimberBody};
use super::step::facing;
use crate::{DrawnSurface, PosedSurface, WorldOrigin};

/// Writes the transforms of climbers.
pub(super) fn draw(
    time: Res<Time<Fixed>>,
    mut climbers: Query<(&mut ClimberBody, &mut Transform), With<Climber>>,
    surfaces: Query<(&PosedSurface, &DrawnSurface)>,
    origin: Res<WorldOrigin>,
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
            translation: (position - origin.0).as_vec3(),
            rotation: rotation.as_quat(),
            scale: transform.scale,
        };
        transform.set_if_neq(body.drawn);
    }
}

/// Position and heading of a state: on skin, as the frame draws it.
fn on_drawn_skin(
    state: &clamber_climber::ClimberState,
    surfaces: &Query<(&PosedSurface, &DrawnSurface)>,
) -> (DVec3, DVec3) {
    let on_skin = state.support.and_then(|support| {
        let (place, turn) = followed(&support.attachment, surfaces)?;
        Some((place, turn * state.heading))
    });
    on_skin.unwrap_or((state.position, state.heading))
}

/// Where something attached to skin is drawn, and how much it is turned there from where the tick has it.
fn followed(
    attachment: &Attachment,
    surfaces: &Query<(&PosedSurface, &DrawnSurface)>,
) -> Option<(DVec3, DQuat)> {
    let entity = Entity::try_from_bits(attachment.obstacle.0)?;
    let (surface, drawn) = surfaces.get(entity).ok()?;
    let skin = drawn.pose(surface)?;
    let motion = Obstacle::motion(skin, &attachment.material, 1.0)?;
    let frame = motion.frame.unwrap_or(attachment.frame);
    Some((
        motion.position + frame * attachment.offset,
        frame * attachment.frame.conjugate(),
    ))
}
