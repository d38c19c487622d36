use bevy_app::{
    App, FixedPostUpdate, Plugin, PostUpdate, RunFixedMainLoop, RunFixedMainLoopSystems,
};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};

use super::component::{Climber, ClimberBody, ClimberFilter, ClimberState};
use super::input::{ClimberInput, LatchedInput, latch};
use super::{draw, events, step};
use crate::ClamberSystems;

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
        app.register_type::<Climber>()
            .register_type::<ClimberState>()
            .register_type::<ClimberInput>()
            .register_type::<ClimberFilter>()
            .add_observer(remove_body)
            .configure_sets(
                self.schedule,
                ClamberSystems::Climb.after(ClamberSystems::Pose),
            )
            .add_systems(
                RunFixedMainLoop,
                latch.in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop),
            )
            .add_systems(
                self.schedule,
                (step::follow_changes, step::step_climbers, step::tell)
                    .chain()
                    .in_set(ClamberSystems::Climb),
            )
            .add_systems(PostUpdate, draw::draw.in_set(ClamberSystems::Draw));
    }
}

/// Removes the body of a removed climber.
fn remove_body(removed: On<Remove<Climber>>, mut commands: Commands) {
    if let Ok(mut entity) = commands.get_entity(removed.entity) {
        entity.try_remove::<(ClimberBody, ClimberState, LatchedInput)>();
    }
}
