use bevy_app::{FixedPostUpdate, PluginGroup, PluginGroupBuilder};
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel, SystemSet};

use crate::{SurfaceAnchorPlugin, SurfacePlugin};

/// The plugins for surfaces and anchors. Surfaces are posed in a schedule that runs once a tick.
///
/// ```
/// # use bevy_app::{App, FixedUpdate};
/// use bevy_clamber::prelude::*;
///
/// App::new().add_plugins(ClamberPlugins::default());
/// // Surfaces are posed with gameplay instead of after it:
/// App::new().add_plugins(ClamberPlugins::in_schedule(FixedUpdate));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ClamberPlugins {
    schedule: InternedScheduleLabel,
}

impl ClamberPlugins {
    /// Poses surfaces in this schedule of the fixed loop.
    pub fn in_schedule(schedule: impl ScheduleLabel) -> Self {
        Self {
            schedule: schedule.intern(),
        }
    }
}

impl Default for ClamberPlugins {
    /// Poses surfaces in [`FixedPostUpdate`], where physics engines step: after gameplay and animation of the same
    /// tick.
    fn default() -> Self {
        Self::in_schedule(FixedPostUpdate)
    }
}

impl PluginGroup for ClamberPlugins {
    fn build(self) -> PluginGroupBuilder {
        PluginGroupBuilder::start::<Self>()
            .add(SurfacePlugin::in_schedule(self.schedule))
            .add(SurfaceAnchorPlugin)
    }
}

/// The sets of this crate's systems, for a game to order its own systems by. A frame runs them in the order of this
/// list, as long as every plugin keeps its default schedule.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ClamberSystems {
    /// In `PreUpdate`, after Bevy's `InputSystems`: `ClimberControls` fill the inputs of climbers and cameras.
    Input,
    /// In `PreUpdate`: colliders are built from mesh assets, surfaces are inserted and removed.
    Build,
    /// In the schedule of `RigPlayerPlugin`, `FixedUpdate` by default, before [`ClamberSystems::Pose`]: rigs that
    /// `clamber_gltf` loaded play their clips. Part of `AnimationSystems`.
    Animate,
    /// In the schedule of [`ClamberPlugins`], `FixedPostUpdate` by default: surfaces take this tick's pose.
    Pose,
    /// In the schedule of `ClimberPlugin`, `FixedPostUpdate` by default, after [`ClamberSystems::Pose`] and after the
    /// physics engine: climbers are stepped, and their events triggered.
    Climb,
    /// In `PostUpdate`, after `AnimationSystems`: the poses that this frame draws are recorded.
    Sample,
    /// In `PostUpdate`, after [`ClamberSystems::Sample`], before `TransformSystems::Propagate`: climbers are moved to
    /// where this frame draws them.
    Draw,
    /// In `PostUpdate`, after [`ClamberSystems::Draw`], before `TransformSystems::Propagate`: the figures of climbers
    /// are posed.
    Body,
    /// In `PostUpdate`, after [`ClamberSystems::Body`], before `TransformSystems::Propagate`: cameras follow climbers.
    Follow,
    /// In `PostUpdate`, after [`ClamberSystems::Sample`], before `TransformSystems::Propagate`: anchored
    /// entities are moved to the skin as it is drawn.
    Anchor,
}

/// The part of [`ClamberSystems::Climb`] in which climbers that are entities of their own are stepped, before an arena
/// is.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct ClimberTicks;
