use bevy_app::{App, FixedPostUpdate, Plugin, PostUpdate};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};

use super::resource::FightEvent;
use super::{figure, show, step};
use crate::needs::need_plugin;
use crate::{ClamberSystems, ClimberPlugin, ClimberTicks};

/// Steps the [`FightArena`](super::FightArena) once a tick, in [`ClamberSystems::Climb`], and shows what is in it. Add
/// it beside [`ClamberPlugins`](crate::ClamberPlugins) and [`ClimberPlugin`].
///
/// Creatures and climbers can be entities of their own instead, with [`Colossus`](crate::Colossus) and
/// [`Climber`](crate::Climber), each stepped by its own plugin. Which of both suits a game is told in
/// `docs/recipes/fight.md`.
#[derive(Clone, Copy, Debug)]
pub struct ArenaPlugin {
    schedule: InternedScheduleLabel,
    steps: bool,
}

impl ArenaPlugin {
    /// Steps the arena in this schedule of the fixed loop, after physics engines.
    pub fn in_schedule(schedule: impl ScheduleLabel) -> Self {
        Self {
            schedule: schedule.intern(),
            steps: true,
        }
    }

    /// Only shows the arena. The app steps it before [`ClamberSystems::Climb`], with
    /// [`ArenaTerrain`](super::ArenaTerrain), and writes [`FightEvent`]s itself: for a rollback session, which steps as
    /// often as it has to.
    #[must_use]
    pub fn without_steps(self) -> Self {
        Self {
            steps: false,
            ..self
        }
    }
}

impl Default for ArenaPlugin {
    /// In [`FixedPostUpdate`], as [`ClimberPlugin`].
    fn default() -> Self {
        Self::in_schedule(FixedPostUpdate)
    }
}

impl Plugin for ArenaPlugin {
    fn build(&self, app: &mut App) {
        let show = (show::creatures, show::fighters, show::projectiles).chain();
        app.add_message::<FightEvent>()
            .add_systems(
                self.schedule,
                show.in_set(ClamberSystems::Climb).after(ClimberTicks),
            )
            .add_systems(
                PostUpdate,
                figure::pose
                    .in_set(ClamberSystems::Body)
                    .after(crate::figure::pose),
            );
        if self.steps {
            let step = step::step.after(ClimberTicks).before(show::creatures);
            app.add_systems(self.schedule, step.in_set(ClamberSystems::Climb));
        }
    }

    fn finish(&self, app: &mut App) {
        need_plugin::<ClimberPlugin>(app, "clamber's ArenaPlugin", "ClimberPlugin");
    }
}
