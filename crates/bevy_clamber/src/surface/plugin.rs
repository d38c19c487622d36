use bevy_app::{AnimationSystems, App, FixedPostUpdate, Plugin, PostUpdate, PreUpdate};
use bevy_asset::{AssetServer, Assets};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use bevy_mesh::Mesh;
use bevy_mesh::skinning::SkinnedMeshInverseBindposes;
use bevy_tasks::AsyncComputeTaskPool;
use bevy_time::{Fixed, Time};
use bevy_transform::{TransformPlugin, TransformSystems};

use super::clock::{tell_frame, tell_tick};
use super::pose::{pose_surfaces, sample_poses};
use super::{DrawnSurface, FrameClock, PoseTiming, PosedSurface};
use crate::collider::{
    ColliderMeshes, build_colliders, forget_changed_assets, tag_colliders, tell_waiting,
};
use crate::needs::{need, need_resource};
use crate::{ClamberSystems, ColliderStatus, ColliderTag, SkinnedCollider, WorldOrigin};

/// Builds colliders and poses surfaces; part of [`ClamberPlugins`](crate::ClamberPlugins).
///
/// Needs `TaskPoolPlugin`, `TimePlugin`, `AssetPlugin`, and the assets `Mesh` and `SkinnedMeshInverseBindposes`.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePlugin {
    schedule: InternedScheduleLabel,
}

impl SurfacePlugin {
    /// Poses surfaces in this schedule of the fixed loop.
    pub fn in_schedule(schedule: impl ScheduleLabel) -> Self {
        Self {
            schedule: schedule.intern(),
        }
    }
}

impl Default for SurfacePlugin {
    fn default() -> Self {
        Self::in_schedule(FixedPostUpdate)
    }
}

impl Plugin for SurfacePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ColliderMeshes>()
            .init_resource::<FrameClock>()
            .init_resource::<WorldOrigin>()
            .register_type::<WorldOrigin>()
            .register_type::<SkinnedCollider>()
            .register_type::<PoseTiming>()
            .register_type::<ColliderTag>()
            .register_type::<ColliderStatus>()
            .add_observer(remove_surface)
            .configure_sets(
                PostUpdate,
                (
                    ClamberSystems::Sample,
                    ClamberSystems::Draw,
                    ClamberSystems::Body,
                    ClamberSystems::Follow,
                    ClamberSystems::Anchor,
                )
                    .chain()
                    .after(AnimationSystems)
                    .before(TransformSystems::Propagate),
            )
            .add_systems(
                PreUpdate,
                (
                    forget_changed_assets,
                    tag_colliders,
                    build_colliders,
                    tell_waiting,
                )
                    .chain()
                    .in_set(ClamberSystems::Build),
            )
            .add_systems(
                self.schedule,
                (tell_tick, pose_surfaces)
                    .chain()
                    .in_set(ClamberSystems::Pose),
            )
            .add_systems(
                PostUpdate,
                (tell_frame, sample_poses)
                    .chain()
                    .in_set(ClamberSystems::Sample),
            );
    }

    fn finish(&self, app: &mut App) {
        let me = "clamber's SurfacePlugin (of ClamberPlugins)";
        let has_tasks = AsyncComputeTaskPool::try_get().is_some();
        need(has_tasks, me, "TaskPoolPlugin of bevy_app");
        need_resource::<Time<Fixed>>(app, me, "TimePlugin of bevy_time");
        need_resource::<AssetServer>(app, me, "AssetPlugin of bevy_asset");
        need_resource::<Assets<Mesh>>(app, me, "MeshPlugin of bevy_mesh");
        need_resource::<Assets<SkinnedMeshInverseBindposes>>(app, me, "MeshPlugin of bevy_mesh");
        if !app.is_plugin_added::<TransformPlugin>() {
            tracing::warn!(
                "the app has no TransformPlugin (bevy_transform): surfaces and climbers work without it, but nothing \
                 that reads a GlobalTransform, such as a renderer, sees them move"
            );
        }
    }
}

/// Removes the surface of a removed collider.
fn remove_surface(removed: On<Remove<SkinnedCollider>>, mut commands: Commands) {
    if let Ok(mut entity) = commands.get_entity(removed.entity) {
        entity.try_remove::<(PosedSurface, DrawnSurface, ColliderStatus)>();
    }
}
