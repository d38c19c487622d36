use bevy_app::{
    App, FixedPostUpdate, Plugin, PostUpdate, RunFixedMainLoop, RunFixedMainLoopSystems,
};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};

use super::component::{Climber, ClimberBody, ClimberFilter, ClimberState};
use super::input::{ClimberInput, LatchedInput, PassedTicks, count_climbs, count_ticks, latch};
use super::rules::AirVelocity;
use super::{draw, events, step};
use crate::needs::need_plugin;
#[cfg(feature = "avian")]
use crate::obstacles::AvianObstaclesPlugin;
#[cfg(feature = "rapier")]
use crate::obstacles::RapierObstaclesPlugin;
use crate::{ClamberSystems, ClimberTicks, SurfacePlugin};

/// Steps [`Climber`]s. Needs [`ClamberPlugins`](crate::ClamberPlugins) as well.
#[derive(Clone, Copy, Debug)]
pub struct ClimberPlugin {
    schedule: InternedScheduleLabel,
}

impl ClimberPlugin {
    /// Steps climbers in this schedule of the fixed loop, in which surfaces are posed as well.
    pub fn in_schedule(schedule: impl ScheduleLabel) -> Self {
        Self {
            schedule: schedule.intern(),
        }
    }
}

impl Default for ClimberPlugin {
    /// In [`FixedPostUpdate`], as [`ClamberPlugins`](crate::ClamberPlugins).
    fn default() -> Self {
        Self::in_schedule(FixedPostUpdate)
    }
}

impl Plugin for ClimberPlugin {
    fn build(&self, app: &mut App) {
        events::add(app);
        #[cfg(feature = "colossus")]
        app.register_type::<super::TerrainId>();
        app.register_type::<Climber>()
            .register_type::<ClimberState>()
            .register_type::<ClimberInput>()
            .register_type::<ClimberFilter>()
            .register_type::<AirVelocity>()
            .init_resource::<AirVelocity>()
            .init_resource::<PassedTicks>()
            .add_observer(remove_body)
            .configure_sets(
                self.schedule,
                (
                    ClamberSystems::Climb.after(ClamberSystems::Pose),
                    ClimberTicks.in_set(ClamberSystems::Climb),
                ),
            )
            .add_systems(
                RunFixedMainLoop,
                latch.in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop),
            )
            .add_systems(
                self.schedule,
                (count_ticks, count_climbs.in_set(ClamberSystems::Climb)).chain(),
            )
            .add_systems(
                self.schedule,
                (step::follow_changes, step::step_climbers, step::tell)
                    .chain()
                    .in_set(ClimberTicks),
            )
            .add_systems(PostUpdate, draw::draw.in_set(ClamberSystems::Draw));
    }

    fn finish(&self, app: &mut App) {
        need_plugin::<SurfacePlugin>(app, "clamber's ClimberPlugin", "ClamberPlugins");
        #[cfg(any(feature = "avian", feature = "rapier"))]
        app.add_systems(
            self.schedule,
            step::push.in_set(ClimberTicks).after(step::tell),
        );
        #[cfg(feature = "avian")]
        if app.is_plugin_added::<avian3d::schedule::PhysicsSchedulePlugin>()
            && !app.is_plugin_added::<AvianObstaclesPlugin>()
        {
            AvianObstaclesPlugin::in_schedule(self.schedule).build(app);
        }
        #[cfg(feature = "rapier")]
        if app
            .world()
            .contains_resource::<bevy_rapier3d::plugin::TimestepMode>()
            && !app.is_plugin_added::<RapierObstaclesPlugin>()
        {
            RapierObstaclesPlugin::default().build(app);
        }
    }
}

/// Removes the body of a removed climber.
fn remove_body(removed: On<Remove<Climber>>, mut commands: Commands) {
    if let Ok(mut entity) = commands.get_entity(removed.entity) {
        entity.try_remove::<(ClimberBody, ClimberState, LatchedInput)>();
    }
}
