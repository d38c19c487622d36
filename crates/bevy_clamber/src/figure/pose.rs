use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_time::Time;
use bevy_transform::components::Transform;
use clamber_body::{Body, BodyFrame};
use clamber_world::{Attachment, Obstacle, ObstacleId};

use super::component::{ClimberFigure, ClimberPlant};
use crate::WorldOrigin;
use crate::climber::{ClimberBody, ClimberFilter, ClimberState, DrawnTouchable};
use crate::creature::transform;

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

pub(super) fn pose(
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
        let figure = shown.figure.clone();
        let look_at = shown.look_at.map(|at| at.as_dvec3() + origin.0);
        let body: &mut Body = &mut shown.body;
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
            let frame = BodyFrame {
                state: &state,
                config: climber.config(),
                obstacles,
                look_at,
            };
            body.update(&figure, &frame, dt)
        });
        if let Err(error) = posed {
            if !std::mem::replace(&mut *told, true) {
                tracing::warn!("the figure of {entity} cannot be posed: {error}");
            }
            continue;
        }
        for plant in shown.body.plants().iter().copied() {
            commands.queue(move |world: &mut World| {
                let planted = ClimberPlant { entity, plant };
                world.write_message(planted);
                world.trigger(planted);
            });
        }
        let place = shown.body.world_from_model();
        if let Ok(mut root) = transforms.get_mut(shown.root) {
            root.set_if_neq(Transform {
                translation: (place.translation - origin.0).as_vec3(),
                rotation: place.rotation.as_quat(),
                scale: Vec3::splat(place.scale as f32),
            });
        }
        let locals = &shown.body.pose().transforms;
        for (joint, local) in shown.joints.iter().zip(locals) {
            // A joint that the app has despawned needs no pose.
            if let Ok(mut found) = transforms.get_mut(*joint) {
                found.set_if_neq(transform(local));
            }
        }
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
