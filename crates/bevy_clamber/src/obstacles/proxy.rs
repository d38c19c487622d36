use std::collections::{BTreeMap, HashSet};

use bevy_app::{App, FixedUpdate, Plugin};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use bevy_rapier3d::plugin::context::RapierContextJoints;
use bevy_rapier3d::prelude::{
    DefaultRapierContext, PhysicsSet, RapierConfiguration, RapierContextColliders,
    RapierContextSimulation, RapierRigidBodySet, TimestepMode,
};
use bevy_rapier3d::rapier::dynamics::SoftBodySet;
use bevy_rapier3d::rapier::geometry::ColliderHandle;
use bevy_reflect::prelude::*;
use bevy_time::Time;
use clamber_world::{BodyPoses, ClimberProxy, RapierTerrain};
use glam::DVec3;

use super::debris::{self, step_of};
use crate::climber::RAPIER;
use crate::needs::need_plugin;
use crate::{ClimberBlow, ClimberBody, ClimberInput, ClimberPlugin, WorldOrigin};

/// Lets dynamic bodies of `bevy_rapier3d` collide with a climber: crates that fall on it rest on it or knock it down.
/// Insert it beside the [`Climber`](crate::Climber). Needs a [`RapierProxyPlugin`].
///
/// A body that strikes the climber deals a blow ([`ClimberInput::strike`]) by the collider's entity. See
/// [`clamber_world::ClimberProxy`] for how it works. The climber itself needs no collider.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
pub struct RapierProxy;

/// Lets bodies collide with climbers that have a [`RapierProxy`], in the default context of `bevy_rapier3d`. Rapier
/// must step once a tick, without substeps.
#[derive(Clone, Copy, Debug)]
pub struct RapierProxyPlugin {
    schedule: InternedScheduleLabel,
}

impl RapierProxyPlugin {
    /// For a `RapierPhysicsPlugin` in this schedule.
    pub fn in_schedule(schedule: impl ScheduleLabel) -> Self {
        Self {
            schedule: schedule.intern(),
        }
    }
}

impl Default for RapierProxyPlugin {
    /// In [`FixedUpdate`], for `RapierPhysicsPlugin::in_fixed_schedule`.
    fn default() -> Self {
        Self::in_schedule(FixedUpdate)
    }
}

impl Plugin for RapierProxyPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<RapierProxy>()
            .init_resource::<RapierProxies>()
            .init_resource::<WorldOrigin>()
            .add_systems(
                self.schedule,
                (
                    follow
                        .after(PhysicsSet::SyncBackend)
                        .before(PhysicsSet::StepSimulation)
                        .before(debris::before_step),
                    strike
                        .after(PhysicsSet::StepSimulation)
                        .before(PhysicsSet::Writeback)
                        .after(debris::after_step),
                ),
            );
    }

    fn finish(&self, app: &mut App) {
        need_plugin::<ClimberPlugin>(app, "clamber's RapierProxyPlugin", "ClimberPlugin");
    }
}

/// The climbers that rapier knows.
#[derive(Resource, Default)]
pub(crate) struct RapierProxies {
    proxies: BTreeMap<Entity, ClimberProxy>,
    /// Their colliders.
    colliders: HashSet<ColliderHandle>,
    /// The bodies before the step that is under way.
    before: BodyPoses,
    /// Length of that step; `None` if no step is under way.
    dt: Option<f64>,
}

impl RapierProxies {
    /// True if a collider of rapier is a climber.
    pub(crate) fn has(&self, collider: ColliderHandle) -> bool {
        self.colliders.contains(&collider)
    }
}

type Context = (
    &'static mut RapierRigidBodySet,
    &'static mut RapierContextColliders,
    &'static mut RapierContextJoints,
    &'static mut RapierContextSimulation,
    &'static RapierConfiguration,
);

/// Puts the proxies where the climbers are, and records the bodies.
fn follow(
    mode: Res<TimestepMode>,
    time: Res<Time>,
    origin: Res<WorldOrigin>,
    climbers: Query<(Entity, &ClimberBody), With<RapierProxy>>,
    mut contexts: Query<Context, With<DefaultRapierContext>>,
    mut all: ResMut<RapierProxies>,
) {
    let all = &mut *all;
    all.dt = None;
    let Ok((mut bodies, mut colliders, mut joints, mut simulation, configuration)) =
        contexts.single_mut()
    else {
        return;
    };
    let (bodies, colliders) = (&mut bodies.bodies, &mut colliders.colliders);
    let joints = &mut *joints;
    all.proxies.retain(|entity, proxy| {
        let stays = climbers.contains(*entity);
        if !stays {
            bodies.remove(
                proxy.body(),
                &mut simulation.islands,
                colliders,
                &mut joints.impulse_joints,
                &mut joints.multibody_joints,
                // No soft body is attached to a proxy.
                &mut SoftBodySet::default(),
                true,
            );
        }
        stays
    });
    for (entity, body) in &climbers {
        let climber = body.climber();
        let shown = climber.proxy_body(RAPIER);
        let proxy = all.proxies.entry(entity).or_insert_with(|| {
            let proxy = ClimberProxy::insert(&shown, DVec3::ZERO, bodies, colliders);
            if let Some(collider) = colliders.get_mut(proxy.collider()) {
                // Rapier's events and queries name the climber.
                collider.user_data = entity.to_bits().into();
            }
            proxy
        });
        proxy.set_origin(origin.0);
        let joints = &mut joints.impulse_joints;
        proxy.follow(
            &shown,
            climber.proxy_touches(RAPIER),
            bodies,
            colliders,
            joints,
        );
    }
    all.colliders.clear();
    all.colliders
        .extend(all.proxies.values().map(ClimberProxy::collider));
    let dt = step_of(*mode, &time).ok();
    all.dt = dt.filter(|dt| *dt > 0.0 && configuration.physics_pipeline_active);
    all.before.record(bodies);
}

/// Strikes the climbers that something has hit in the step.
fn strike(
    mut climbers: Query<(&ClimberBody, &mut ClimberInput), With<RapierProxy>>,
    mut contexts: Query<Context, With<DefaultRapierContext>>,
    mut all: ResMut<RapierProxies>,
) {
    let RapierProxies {
        proxies,
        before,
        dt,
        ..
    } = &mut *all;
    let (Some(dt), Ok((mut bodies, mut colliders, _, simulation, _))) =
        (*dt, contexts.single_mut())
    else {
        return;
    };
    let (bodies, colliders) = (&mut bodies.bodies, &mut colliders.colliders);
    for (entity, proxy) in proxies {
        let hit = proxy.after_step(before, bodies, colliders, &simulation.narrow_phase, dt);
        let (Some(hit), Ok((body, mut input))) = (hit, climbers.get_mut(*entity)) else {
            continue;
        };
        let Some(blow) = body.climber().knockback_of(hit.impulse, None) else {
            continue;
        };
        let collider = colliders.get(RapierTerrain::collider_of(&hit.material));
        let by = collider.and_then(|collider| u64::try_from(collider.user_data).ok());
        input.strike(ClimberBlow {
            velocity: blow.velocity.as_vec3(),
            damage: blow.damage as f32,
            by: by.and_then(Entity::try_from_bits),
        });
    }
}
