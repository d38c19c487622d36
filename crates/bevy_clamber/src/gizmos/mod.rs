//! Draws surfaces, anchors and the work of queries with Bevy's gizmos.

mod draw;
mod touched;

use bevy_app::{App, FixedPostUpdate, Plugin, PostUpdate};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use bevy_gizmos::config::GizmoConfigGroup;
use bevy_gizmos::{AppGizmoBuilder, GizmoPlugin};
use bevy_reflect::prelude::*;

use crate::needs::need_plugin;
use crate::{ClamberSystems, SurfacePlugin};
use draw::{draw_anchors, draw_surfaces};
use touched::{TouchedClusters, note_touched};

/// Which kinds of gizmos [`SurfaceGizmosPlugin`] draws. Default: all.
///
/// ```
/// # use bevy_app::App;
/// # use bevy_gizmos::{AppGizmoBuilder, config::GizmoConfig};
/// # use bevy_clamber::SurfaceGizmos;
/// # let mut app = App::new();
/// let show = SurfaceGizmos { parts: false, ..SurfaceGizmos::default() };
/// // The gizmos are drawn in front of the skin that they lie on.
/// let config = GizmoConfig { depth_bias: -1.0, ..GizmoConfig::default() };
/// app.insert_gizmo_config(show, config);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Reflect, GizmoConfigGroup)]
#[reflect(Default, Clone, Debug, PartialEq)]
pub struct SurfaceGizmos {
    /// Bounding spheres of the parts; a part is the triangles that one joint moves most.
    pub parts: bool,
    /// Borders of the clusters that queries reached and that were skinned for them.
    pub clusters: bool,
    /// Axes of the entities that are anchored to skin: X red, Y green, Z blue.
    pub anchors: bool,
    /// The triangles of the clusters that queries reached.
    pub contacts: bool,
    /// Arrows from anchors: the displacement of the skin there in 0.1 s at its velocity over the last tick.
    pub velocities: bool,
}

impl Default for SurfaceGizmos {
    fn default() -> Self {
        Self {
            parts: true,
            clusters: true,
            anchors: true,
            contacts: true,
            velocities: true,
        }
    }
}

/// Draws the gizmos that [`SurfaceGizmos`] selects. Add it beside Bevy's `GizmoPlugin` and
/// [`ClamberPlugins`](crate::ClamberPlugins), with the schedule of the latter.
///
/// The plugin draws in `PostUpdate`, after [`ClamberSystems::Anchor`], on the pose that this frame draws. Clusters and
/// contacts are those that queries reached in the surface's current and previous pose. On a surface that stands still
/// they accumulate until it moves.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceGizmosPlugin {
    schedule: InternedScheduleLabel,
}

impl SurfaceGizmosPlugin {
    /// For surfaces that are posed in this schedule of the fixed loop.
    pub fn in_schedule(schedule: impl ScheduleLabel) -> Self {
        Self {
            schedule: schedule.intern(),
        }
    }
}

impl Default for SurfaceGizmosPlugin {
    fn default() -> Self {
        Self::in_schedule(FixedPostUpdate)
    }
}

impl Plugin for SurfaceGizmosPlugin {
    fn build(&self, app: &mut App) {
        app.init_gizmo_group::<SurfaceGizmos>()
            .init_resource::<TouchedClusters>()
            .register_type::<SurfaceGizmos>()
            .add_systems(self.schedule, note_touched.before(ClamberSystems::Pose))
            .add_systems(
                PostUpdate,
                (draw_surfaces, draw_anchors)
                    .chain()
                    .after(ClamberSystems::Anchor),
            );
    }

    fn finish(&self, app: &mut App) {
        let me = "clamber's SurfaceGizmosPlugin";
        need_plugin::<SurfacePlugin>(app, me, "ClamberPlugins");
        need_plugin::<GizmoPlugin>(app, me, "GizmoPlugin of bevy_gizmos");
    }
}
