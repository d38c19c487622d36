//! What surfaces are and do, drawn with Bevy's gizmos.

mod draw;
mod touched;

use bevy_app::{App, FixedPostUpdate, Plugin, PostUpdate};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use bevy_gizmos::AppGizmoBuilder;
use bevy_gizmos::config::GizmoConfigGroup;
use bevy_reflect::prelude::*;

use crate::ClamberSystems;
use draw::{draw_anchors, draw_surfaces};
use touched::{TouchedClusters, note_touched};

/// Which kinds of [`SurfaceGizmosPlugin`] are drawn. Default: all.
///
/// ```
/// # use bevy_app::App;
/// # use bevy_gizmos::{AppGizmoBuilder, config::GizmoConfig};
/// # use bevy_clamber::SurfaceGizmos;
/// # let mut app = App::new();
/// let show = SurfaceGizmos { parts: false, ..SurfaceGizmos::default() };
/// // In front of the skin that they lie on.
/// let config = GizmoConfig { depth_bias: -1.0, ..GizmoConfig::default() };
/// app.insert_gizmo_config(show, config);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Reflect, GizmoConfigGroup)]
#[reflect(Default, Clone, Debug, PartialEq)]
pub struct SurfaceGizmos {
    /// Around the triangles that each joint moves most: the sphere that bounds them.
    pub parts: bool,
    /// Borders of the clusters that queries reached: what was skinned for them.
    pub clusters: bool,
    /// Axes where entities are stuck to skin: X red, Y green, Z blue.
    pub anchors: bool,
    /// The triangles that queries came near to: those of the clusters that they reached.
    pub contacts: bool,
    /// From anchors: how far the skin there moves in a tenth of a second, at its speed over the last tick.
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

/// Draws surfaces and anchors on the skin as it is drawn, as [`SurfaceGizmos`] says; beside
/// [`ClamberPlugins`](crate::ClamberPlugins) and Bevy's `GizmoPlugin`, and in the same schedule as the former.
///
/// In `PostUpdate`, after [`ClamberSystems::Anchor`], it draws this frame's pose. Clusters and contacts are those of
/// queries since the surface's pose before its current one; before [`ClamberSystems::Pose`], which forgets them, they
/// are noted. On a surface that stands still they add up until it moves.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceGizmosPlugin {
    schedule: InternedScheduleLabel,
}

impl SurfaceGizmosPlugin {
    /// With surfaces posed in a schedule of the fixed loop.
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
}
