use bevy_app::{App, FixedUpdate, Plugin};
use bevy_asset::{AssetApp, AssetServer};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use bevy_time::{Fixed, Time};

use super::asset::{BrainLoader, ColossusBrain};
use super::senses::ColossusNoise;
use super::{events, live};
use crate::needs::{need_plugin, need_resource};
use crate::{ClamberSystems, ClimberPlugin, RigPlayerPlugin};

/// Loads brains, and lets every [`Colossus`](super::Colossus) live, in [`ClamberSystems::Animate`]. Add it beside
/// [`RigPlayerPlugin`] and [`ClimberPlugin`].
#[derive(Clone, Copy, Debug)]
pub struct ColossusPlugin {
    schedule: InternedScheduleLabel,
}

impl ColossusPlugin {
    /// Lets creatures live in this schedule of the fixed loop. Use the schedule of [`RigPlayerPlugin`].
    pub fn in_schedule(schedule: impl ScheduleLabel) -> Self {
        Self {
            schedule: schedule.intern(),
        }
    }
}

impl Default for ColossusPlugin {
    /// In [`FixedUpdate`].
    fn default() -> Self {
        Self::in_schedule(FixedUpdate)
    }
}

impl Plugin for ColossusPlugin {
    fn build(&self, app: &mut App) {
        events::add(app);
        let alive = (live::renew, live::step).chain();
        app.add_message::<ColossusNoise>().add_systems(
            self.schedule,
            alive
                .in_set(ClamberSystems::Animate)
                .after(crate::creature::play),
        );
        if app.world().contains_resource::<AssetServer>() {
            add_brains(app);
        }
    }

    fn finish(&self, app: &mut App) {
        let me = "clamber's ColossusPlugin";
        need_resource::<Time<Fixed>>(app, me, "TimePlugin of bevy_time");
        need_resource::<AssetServer>(app, me, "AssetPlugin of bevy_asset");
        need_plugin::<RigPlayerPlugin>(app, me, "RigPlayerPlugin");
        need_plugin::<ClimberPlugin>(app, me, "ClimberPlugin");
        // `AssetPlugin` was added after this plugin.
        if !app
            .world()
            .contains_resource::<bevy_asset::Assets<ColossusBrain>>()
        {
            add_brains(app);
        }
    }
}

fn add_brains(app: &mut App) {
    app.init_asset::<ColossusBrain>()
        .register_asset_loader(BrainLoader);
}
