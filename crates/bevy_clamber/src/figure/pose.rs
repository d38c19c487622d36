use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_time::Time;
use bevy_transform::components::Transform;
use clamber_body::BodyInput;
use clamber_world::{Attachment, Obstacle, ObstacleId};

use super::component::ClimberFigure;
use crate::WorldOrigin;
use crate::climber::{ClimberBody, ClimberFilter, ClimberState, DrawnTouchable};

/// Anything that moves may have moved so far from one frame to the next, metres: skin is placed where a frame draws it.
const ANYWHERE: f64 = 1e9;

type Figures<'w, 's> = Query<
    'w,
    's,
    (
        Entity,
        &'static mut ClimberFigure,
        &'static ClimberBody,
        &'static ClimberState,
        Option<&'static ClimberFilter>,
    ),
>;

pub(crate) fn pose(
    time: Res<Time>,
    origin: Res<WorldOrigin>,
    touchable: DrawnTouchable<'_, '_>,
    mut figures: Figures<'_, '_>,
    mut transforms: Query<&mut Transform>,
    mut told: Local<bool>,
    mut commands: Commands,
) {
    let dt = time.delta_secs_f64();
    for (entity, mut shown, climber, state, filter) in &mut figures {
        let Ok(drawn) = transforms.get(entity).copied() else {
            continue;
        };
        let shown = shown.bypass_change_detection();
        let look_at = shown.look_at.map(|at| at.as_dvec3() + origin.0);
        let posed = touchable.around(entity, filter, |obstacles| {
            // As the frame draws it, on skin as the frame draws it.
            let mut state = state.0;
            state.position = drawn.translation.as_dvec3() + origin.0;
            let ahead = (drawn.rotation * Vec3::NEG_Z).as_dvec3();
            let up = climber.config().up();
            let level = ahead - up * ahead.dot(up);
            state.heading = level.normalize_or(state.heading);
            if let Some(support) = &mut state.support {
                follow(&mut support.attachment, obstacles, dt);
            }
            let frame = BodyInput {
                state: &state,
                config: climber.config(),
                obstacles,
                look_at,
            };
            shown.update(&frame, dt)
        });
        if let Err(error) = posed {
            if !std::mem::replace(&mut *told, true) {
                tracing::warn!("the figure of {entity} cannot be posed: {error}");
            }
            continue;
        }
        shown.write(entity, &origin, &mut transforms, &mut commands);
    }
}

/// Moves what a tick has attached to where the frame draws it.
fn follow(on: &mut Attachment, obstacles: &[(ObstacleId, &dyn Obstacle)], dt: f64) {
    let obstacle = obstacles.iter().find(|(id, _)| *id == on.obstacle);
    if let Some((_, obstacle)) = obstacle {
        // Where it is gone, the body follows the climber alone.
        let _ = on.follow(*obstacle, dt.max(f64::MIN_POSITIVE), ANYWHERE);
    }
}
