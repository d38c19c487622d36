use std::collections::BTreeSet;

use bevy_app::{App, FixedPostUpdate, Plugin};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use bevy_ecs::system::SystemParam;
use bevy_rapier3d::prelude::{
    BevyPhysicsHooks, DefaultRapierContext, PairFilterContextView, PhysicsSet, RapierConfiguration,
    RapierContextColliders, RapierContextSimulation, RapierPhysicsPlugin, RapierRigidBodyHandle,
    RapierRigidBodySet, TimestepMode,
};
use bevy_rapier3d::rapier::geometry::ColliderHandle;
use bevy_rapier3d::rapier::pipeline::PhysicsHooks;
use bevy_rapier3d::rapier::prelude::{RigidBodyHandle, SolverFlags};
use bevy_reflect::prelude::*;
use bevy_time::Time;
use clamber_world::{DebrisConfig, DebrisError, DebrisReport, ObstacleId};
use glam::DVec3;
use thiserror::Error;

use crate::needs::need_plugin;
use crate::{ClamberSystems, PosedSurface, SurfacePlugin, WorldOrigin};

/// Lets a dynamic body of `bevy_rapier3d` collide with skin: rocks, tree trunks, the stones of a wall. Insert it beside
/// the `RigidBody`. Needs a [`DebrisPlugin`].
///
/// Creatures push such a body, and it lies and slides on them; nothing ever pushes a creature. A body that a creature
/// presses into the ground is let through. See [`clamber_world::Debris`] for how it works.
///
/// The body's colliders are read when the component is inserted: insert it again after they have changed.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
pub struct Debris;

/// Lets bodies with [`Debris`] collide with skin, in the default context of `bevy_rapier3d`. `DebrisHooks` must be the
/// physics hooks of rapier's plugin, and rapier must step once a tick, without substeps, in the schedule that poses
/// surfaces:
///
/// ```
/// # use bevy_app::{App, FixedPostUpdate};
/// use bevy_clamber::prelude::*;
/// use bevy_clamber::{DebrisHooks, DebrisPlugin, RapierObstaclesPlugin};
/// use bevy_rapier3d::prelude::RapierPhysicsPlugin;
///
/// # let mut app = App::new();
/// # app.add_plugins((bevy_app::TaskPoolPlugin::default(), bevy_time::TimePlugin, bevy_asset::AssetPlugin::default()));
/// # app.add_plugins((bevy_mesh::MeshPlugin, bevy_transform::TransformPlugin));
/// app.add_plugins((
///     RapierPhysicsPlugin::<DebrisHooks>::default().in_schedule(FixedPostUpdate),
///     ClamberPlugins::default(),
///     DebrisPlugin::default(),
///     // For climbers, where rapier does not step in `FixedUpdate`.
///     RapierObstaclesPlugin::in_schedule(FixedPostUpdate),
///     ClimberPlugin::default(),
/// ));
/// # app.finish();
/// ```
#[derive(Clone, Copy, Debug)]
pub struct DebrisPlugin {
    schedule: InternedScheduleLabel,
    config: DebrisConfig,
}

impl DebrisPlugin {
    /// For surfaces and a rapier that both run in this schedule.
    pub fn in_schedule(schedule: impl ScheduleLabel) -> Self {
        Self {
            schedule: schedule.intern(),
            config: DebrisConfig::default(),
        }
    }

    /// With this friction, restitution and collision groups of skin.
    #[must_use]
    pub fn with_config(mut self, config: DebrisConfig) -> Self {
        self.config = config;
        self
    }
}

impl Default for DebrisPlugin {
    /// In [`FixedPostUpdate`].
    fn default() -> Self {
        Self::in_schedule(FixedPostUpdate)
    }
}

impl Plugin for DebrisPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<Debris>()
            .init_resource::<WorldOrigin>()
            .insert_resource(DebrisBodies {
                debris: clamber_world::Debris::new(self.config),
                origin: DVec3::ZERO,
                dt: None,
                report: DebrisReport::default(),
                refused: BTreeSet::new(),
                trouble: None,
            })
            .configure_sets(
                self.schedule,
                ClamberSystems::Pose.before(PhysicsSet::SyncBackend),
            )
            .add_systems(
                self.schedule,
                (
                    before_step
                        .after(PhysicsSet::SyncBackend)
                        .before(PhysicsSet::StepSimulation),
                    after_step
                        .after(PhysicsSet::StepSimulation)
                        .before(PhysicsSet::Writeback),
                ),
            );
    }

    fn finish(&self, app: &mut App) {
        let me = "clamber's DebrisPlugin";
        need_plugin::<SurfacePlugin>(app, me, "ClamberPlugins");
        need_plugin::<RapierPhysicsPlugin<DebrisHooks<'static>>>(
            app,
            me,
            "RapierPhysicsPlugin::<DebrisHooks>",
        );
    }
}

/// The bodies that collide with skin.
#[derive(Resource, Clone, Debug)]
pub struct DebrisBodies {
    debris: clamber_world::Debris,
    /// The [`WorldOrigin`] of the last step.
    origin: DVec3,
    /// Length of the step that is under way.
    dt: Option<f64>,
    report: DebrisReport,
    /// Bodies that cannot collide with skin.
    refused: BTreeSet<(u32, u32)>,
    trouble: Option<DebrisTrouble>,
}

impl DebrisBodies {
    /// The report of the last tick.
    pub fn report(&self) -> &DebrisReport {
        &self.report
    }

    /// True if a collider of rapier is skin.
    pub(crate) fn is_skin(&self, collider: ColliderHandle) -> bool {
        self.debris.triangle_at(collider, 0).is_some()
    }
}

/// The physics hooks of `RapierPhysicsPlugin` beside a [`DebrisPlugin`]: skin near a body collides with that body
/// alone. Hooks of your own can call [`DebrisHooks::filter_contact_pair`] first.
#[derive(SystemParam)]
pub struct DebrisHooks<'w> {
    bodies: Option<Res<'w, DebrisBodies>>,
}

impl BevyPhysicsHooks for DebrisHooks<'_> {
    fn filter_contact_pair(&self, context: PairFilterContextView) -> Option<SolverFlags> {
        match &self.bodies {
            Some(bodies) => bodies.debris.filter_contact_pair(context.raw),
            None => Some(SolverFlags::COMPUTE_RIGID_IMPULSES),
        }
    }
}

type Context = (
    &'static mut RapierRigidBodySet,
    &'static mut RapierContextColliders,
    &'static RapierContextSimulation,
    &'static RapierConfiguration,
);

/// All skin, with the ids that climbers use, too.
fn skin<'a>(
    surfaces: &'a Query<'_, '_, (Entity, &'static PosedSurface)>,
) -> Vec<(ObstacleId, &'a clamber_surface::surface::SkinnedSurface)> {
    let placed = surfaces.iter().filter(|(_, surface)| surface.is_placed());
    placed
        .map(|(entity, surface)| (ObstacleId(entity.to_bits()), &**surface))
        .collect()
}

/// The length of rapier's step; an error if nobody knows it.
pub(super) fn step_of(mode: TimestepMode, time: &Time) -> Result<f64, DebrisTrouble> {
    match mode {
        TimestepMode::Fixed { dt, substeps: 1 } => Ok(dt.into()),
        TimestepMode::Variable {
            max_dt,
            time_scale,
            substeps: 1,
        } => Ok((time.delta_secs() * time_scale).min(max_dt).into()),
        _ => Err(DebrisTrouble::Substeps),
    }
}

/// Why no body collides with skin in a tick.
#[derive(Clone, Debug, PartialEq, Error)]
pub(super) enum DebrisTrouble {
    #[error("rapier's TimestepMode must be Fixed or Variable, with one substep")]
    Substeps,
    #[error(transparent)]
    Debris(#[from] DebrisError),
}

impl DebrisBodies {
    /// Warns of a trouble once, until it is over.
    fn tell<T>(&mut self, result: Result<T, DebrisTrouble>) -> Option<T> {
        let (value, trouble) = match result {
            Ok(value) => (Some(value), None),
            Err(trouble) => (None, Some(trouble)),
        };
        if let Some(trouble) = &trouble
            && self.trouble.is_none()
        {
            tracing::warn!("bodies do not collide with skin: {trouble}");
        }
        self.trouble = trouble;
        value
    }

    /// Takes over what the app has inserted and removed.
    fn follow(
        &mut self,
        wanted: &Query<Wanted>,
        bodies: &mut RapierRigidBodySet,
        colliders: &mut RapierContextColliders,
    ) {
        let is_known = |(_, body, debris): (_, &RapierRigidBodyHandle, Ref<'_, Debris>)| {
            !debris.is_changed() && self.debris.contains(body.0)
        };
        let count = wanted.iter().len();
        if count == self.debris.bodies().len() && wanted.iter().all(is_known) {
            return;
        }
        let handles: BTreeSet<_> = wanted.iter().map(|(_, body, _)| parts(body.0)).collect();
        let gone = self
            .debris
            .bodies()
            .filter(|body| !handles.contains(&parts(*body)));
        for body in gone.collect::<Vec<_>>() {
            self.debris.remove(body, &mut colliders.colliders);
        }
        self.refused.retain(|body| handles.contains(body));
        for (entity, body, debris) in wanted {
            if !debris.is_changed() && self.debris.contains(body.0) {
                continue;
            }
            let added = self
                .debris
                .add(body.0, &mut bodies.bodies, &colliders.colliders);
            match added {
                Ok(()) => {
                    self.refused.remove(&parts(body.0));
                }
                Err(error) if self.refused.insert(parts(body.0)) => {
                    tracing::warn!("the Debris of {entity} waits: {error}");
                }
                Err(_) => {}
            }
        }
    }
}

/// A handle that can be ordered.
fn parts(body: RigidBodyHandle) -> (u32, u32) {
    body.into_raw_parts()
}

type Wanted = (Entity, &'static RapierRigidBodyHandle, Ref<'static, Debris>);

pub(super) fn before_step(
    mode: Res<TimestepMode>,
    time: Res<Time>,
    origin: Res<WorldOrigin>,
    surfaces: Query<(Entity, &'static PosedSurface)>,
    wanted: Query<Wanted>,
    mut contexts: Query<Context, With<DefaultRapierContext>>,
    mut bodies: ResMut<DebrisBodies>,
) {
    let bodies = &mut *bodies;
    bodies.dt = None;
    let Ok((mut set, mut colliders, _, configuration)) = contexts.single_mut() else {
        return;
    };
    bodies.follow(&wanted, &mut set, &mut colliders);
    let dt = bodies.tell(step_of(*mode, &time));
    let Some(dt) = dt.filter(|dt| *dt > 0.0 && configuration.physics_pipeline_active) else {
        return;
    };
    if bodies.origin != origin.0 {
        bodies.origin = origin.0;
        let known = clamber_world::Debris::new(DebrisConfig::default());
        let known = std::mem::replace(&mut bodies.debris, known);
        bodies.debris = known.with_origin(origin.0);
    }
    let skin = skin(&surfaces);
    let shown = bodies
        .debris
        .before_step(&skin, &mut set.bodies, &mut colliders.colliders, dt);
    bodies.dt = bodies.tell(shown.map_err(DebrisTrouble::from)).map(|()| dt);
}

pub(super) fn after_step(
    surfaces: Query<(Entity, &'static PosedSurface)>,
    mut contexts: Query<Context, With<DefaultRapierContext>>,
    mut bodies: ResMut<DebrisBodies>,
) {
    let bodies = &mut *bodies;
    let (Some(dt), Ok((mut set, colliders, simulation, _))) = (bodies.dt, contexts.single_mut())
    else {
        return;
    };
    let report = bodies.debris.after_step(
        &skin(&surfaces),
        &mut set.bodies,
        &colliders.colliders,
        &simulation.broad_phase,
        &simulation.narrow_phase,
        dt,
    );
    let report = bodies.tell(report.map_err(DebrisTrouble::from));
    bodies.report = report.unwrap_or_default();
}
