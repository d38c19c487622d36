//! Climbers that avian's bodies collide with.

mod follow;
mod impact;
mod stop;
mod strike;

use std::collections::BTreeMap;

use avian3d::collision::contact_types::ContactId;
use avian3d::dynamics::integrator::IntegrationSystems;
use avian3d::dynamics::solver::schedule::SolverSystems;
use avian3d::prelude::{PhysicsSchedule, PhysicsStepSystems, PhysicsSystems};
use bevy_app::{App, FixedPostUpdate, Plugin};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use bevy_reflect::prelude::*;
use clamber_world::ProxyBody;

use crate::needs::need_plugin;
use crate::{ClamberSystems, ClimberPlugin, WorldOrigin};
use impact::{Impact, Recorded};

/// Lets dynamic bodies of avian collide with a climber: crates that fall on it rest on it or knock it down. Insert it
/// beside the [`Climber`](crate::Climber). Needs an [`AvianProxyPlugin`].
///
/// The climber gets a kinematic body on an entity of its own. A body that strikes it deals a blow
/// ([`ClimberInput::strike`](crate::ClimberInput::strike)) by the collider's entity, with the impulse that the
/// climber's mass takes ([`ProxyBody::share`]). The climber itself needs no collider.
///
/// A body that is fast for its size is swept by avian (`SweptCcd`): it stops at the climber for the rest of the tick,
/// even if it is one on which the climber lands.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
pub struct AvianProxy;

/// Lets bodies of avian collide with climbers that have an [`AvianProxy`].
#[derive(Clone, Copy, Debug)]
pub struct AvianProxyPlugin {
    schedule: InternedScheduleLabel,
}

impl AvianProxyPlugin {
    /// For `PhysicsPlugins` in this schedule, which must run once a tick.
    pub fn in_schedule(schedule: impl ScheduleLabel) -> Self {
        Self {
            schedule: schedule.intern(),
        }
    }
}

impl Default for AvianProxyPlugin {
    /// In [`FixedPostUpdate`], avian's own default.
    fn default() -> Self {
        Self::in_schedule(FixedPostUpdate)
    }
}

impl Plugin for AvianProxyPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<AvianProxy>()
            .register_type::<StandIn>()
            .init_resource::<AvianProxies>()
            .init_resource::<WorldOrigin>()
            .add_systems(
                self.schedule,
                (
                    follow::follow.before(PhysicsSystems::First),
                    (strike::strike, stop::stop)
                        .chain()
                        .after(PhysicsSystems::StepSimulation)
                        .before(PhysicsSystems::Writeback)
                        .before(ClamberSystems::Climb),
                ),
            )
            .add_systems(
                PhysicsSchedule,
                (
                    strike::keep_apart
                        .after(PhysicsStepSystems::NarrowPhase)
                        .before(PhysicsStepSystems::Solver),
                    strike::record
                        .in_set(SolverSystems::PreSubstep)
                        .after(IntegrationSystems::UpdateVelocityIncrements),
                ),
            );
    }

    fn finish(&self, app: &mut App) {
        need_plugin::<ClimberPlugin>(app, "clamber's AvianProxyPlugin", "ClimberPlugin");
    }
}

/// The body that stands for a climber in avian's world, which climbers do not touch.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
pub(super) struct StandIn;

/// A climber that avian knows.
struct Proxy {
    /// The entity of its body there.
    body: Entity,
    /// The climber as it was followed last.
    shown: ProxyBody,
    /// Bodies with which it does not collide: the climber's support, and bodies that the climber pushes by itself.
    apart: Vec<Entity>,
}

/// The climbers that avian knows.
#[derive(Resource, Default)]
pub(super) struct AvianProxies {
    proxies: BTreeMap<Entity, Proxy>,
    /// The bodies that can strike them before the step, in ascending order.
    recorded: Vec<Recorded>,
    /// Reused.
    impacts: Vec<Impact>,
    contacts: Vec<ContactId>,
}
