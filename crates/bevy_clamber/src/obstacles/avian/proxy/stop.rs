use avian3d::parry::shape::Shape;
use avian3d::prelude::{
    Collider, ColliderDisabled, ColliderTransform, Physics, PhysicsTime, Position,
    RigidBodyColliders, Rotation, Sensor,
};
use bevy_ecs::prelude::*;
use bevy_time::Time;
use clamber_world::RigidPose;

use super::AvianProxies;
use crate::WorldOrigin;

type Solids<'w, 's> = Query<
    'w,
    's,
    (
        Entity,
        &'static Collider,
        Option<&'static ColliderTransform>,
    ),
    (Without<Sensor>, Without<ColliderDisabled>),
>;

/// Puts bodies that entered climbers back to where they touched them first.
pub(super) fn stop(
    all: Res<AvianProxies>,
    origin: Res<WorldOrigin>,
    mut bodies: Query<(&mut Position, &mut Rotation, &RigidBodyColliders)>,
    solids: Solids,
    time: Res<Time<Physics>>,
) {
    let dt = time.delta_secs_f64();
    if time.is_paused() || dt <= 0.0 {
        return;
    }
    for proxy in all.proxies.values() {
        for before in all
            .recorded
            .iter()
            .filter(|before| !proxy.apart.contains(&before.body))
        {
            let Ok((mut position, mut rotation, colliders)) = bodies.get_mut(before.body) else {
                continue;
            };
            let to = RigidPose::new(rotation.0, position.0);
            let solids = || {
                let solid = colliders
                    .iter()
                    .filter_map(|entity| solids.get(entity).ok());
                solid.map(|(entity, collider, on_body)| {
                    let on_body = on_body.filter(|_| entity != before.body);
                    let pose = on_body.map_or(RigidPose::IDENTITY, |on_body| {
                        RigidPose::new(on_body.rotation, on_body.translation)
                    });
                    let shape: &dyn Shape = &**collider.shape_scaled();
                    (shape, pose)
                })
            };
            let stopped = proxy
                .shown
                .stop(origin.0, [&before.pose, &to], solids(), dt);
            if let Some(pose) = stopped {
                // In this tick, avian has moved it, too. A later change would count as the game's own, and its
                // transform as old.
                position.bypass_change_detection().0 = pose.translation.as_vec3();
                rotation.bypass_change_detection().0 = pose.rotation.as_quat();
            }
        }
    }
}
