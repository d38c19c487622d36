use bevy_app::{FixedPostUpdate, PluginGroup, PluginGroupBuilder};
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel, SystemSet};

use crate::{SurfaceAnchorPlugin, SurfacePlugin};

/// Surfaces and anchors, posed in a schedule that runs once a tick.
///
/// ```
/// # use bevy_app::{App, FixedUpdate};
/// use bevy_clamber::prelude::*;
///
/// App::new().add_plugins(ClamberPlugins::default());
/// // Posed with gameplay instead of after it:
/// App::new().add_plugins(ClamberPlugins::in_schedule(FixedUpdate));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ClamberPlugins {
    schedule: InternedScheduleLabel,
}

impl ClamberPlugins {
    /// With surfaces posed in a schedule of the fixed loop.
    pub fn in_schedule(schedule: impl ScheduleLabel) -> Self {
        Self {
            schedule: schedule.intern(),
        }
    }
}

impl Default for ClamberPlugins {
    /// In [`FixedPostUpdate`], where physics engines step: after gameplay and animation of the same tick.
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

/// When this crate's systems run, in this order within a frame, unless plugins are given other schedules.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ClamberSystems {
    /// In `PreUpdate`: colliders are built from mesh assets, surfaces appear and go.
    Build,
    /// In the schedule of `RigPlayerPlugin`, `FixedUpdate` unless told otherwise, before [`ClamberSystems::Pose`]: rigs
    /// that `clamber_gltf` loaded play their clips. Part of `AnimationSystems`.
    Animate,
    /// In the plugins' schedule, `FixedPostUpdate` unless told otherwise: surfaces take this tick's pose.
    Pose,
    /// In `PostUpdate`, after `AnimationSystems`: the poses that this frame draws are noted.
    Sample,
    /// In `PostUpdate`, after [`ClamberSystems::Sample`], before `TransformSystems::Propagate`: anchored
    /// entities are moved to the skin as it is drawn.
    Anchor,
}
