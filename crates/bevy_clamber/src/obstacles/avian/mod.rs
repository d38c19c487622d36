//! Avian's world as an obstacle.

mod moving;
mod proxy;
mod push;
mod terrain;

use avian3d::collider_tree::ColliderTrees;
use avian3d::prelude::{
    Collider, ColliderDisabled, CollisionLayers, PhysicsSystems, Position, Rotation, Sensor,
    SpatialQueryFilter,
};
use bevy_app::{App, FixedPostUpdate, Plugin};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use bevy_ecs::system::SystemParam;

use crate::{ClamberSystems, WorldOrigin};
use moving::{MovingColliders, note};
use proxy::StandIn;
pub use proxy::{AvianProxy, AvianProxyPlugin};
pub(crate) use push::AvianPushes;
use push::Masses;
pub use terrain::AvianTerrain;

/// Records the poses of avian's moving colliders after each step and before it. `ClimberPlugin` adds it by itself.
#[derive(Clone, Copy, Debug)]
pub struct AvianObstaclesPlugin {
    schedule: InternedScheduleLabel,
}

impl AvianObstaclesPlugin {
    /// For `PhysicsPlugins` in this schedule, which must run once a tick.
    pub fn in_schedule(schedule: impl ScheduleLabel) -> Self {
        Self {
            schedule: schedule.intern(),
        }
    }
}

impl Default for AvianObstaclesPlugin {
    /// In [`FixedPostUpdate`], avian's own default.
    fn default() -> Self {
        Self::in_schedule(FixedPostUpdate)
    }
}

impl Plugin for AvianObstaclesPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<MovingColliders>()
            .init_resource::<WorldOrigin>()
            .add_systems(
                self.schedule,
                note.after(PhysicsSystems::Last)
                    .before(ClamberSystems::Climb),
            )
            // If a creature's root is a body, its surface is posed where the step has put it.
            .configure_sets(
                self.schedule,
                ClamberSystems::Pose.after(PhysicsSystems::Writeback),
            );
    }
}

/// Colliders that can be touched. Climbers touch each other as obstacles of their own.
type Solids<'w, 's> = Query<
    'w,
    's,
    (
        &'static Position,
        &'static Rotation,
        &'static Collider,
        Option<&'static CollisionLayers>,
    ),
    (Without<Sensor>, Without<ColliderDisabled>, Without<StandIn>),
>;

/// Avian's world as an obstacle.
///
/// A read-only system parameter; needs [`AvianObstaclesPlugin`]. Moving bodies are seen where the last step has put
/// them: query after `PhysicsSystems::Last` to see them without lag.
///
/// ```
/// # use bevy_clamber::AvianObstacles;
/// # use clamber_world::Obstacle;
/// # use glam::DVec3;
/// fn height_of_ground(avian: AvianObstacles) {
///     let below = avian.terrain().cast_ray(DVec3::Y * 10.0, DVec3::NEG_Y, 100.0);
///     println!("{:?}", below.map(|contact| contact.point.y));
/// }
/// ```
#[derive(SystemParam)]
pub struct AvianObstacles<'w, 's> {
    solids: Solids<'w, 's>,
    trees: Res<'w, ColliderTrees>,
    moving: Res<'w, MovingColliders>,
    masses: Masses<'w, 's>,
}

impl AvianObstacles<'_, '_> {
    /// All colliders except sensors; [`AvianTerrain::with_filter`] restricts them.
    pub fn terrain(&self) -> AvianTerrain<'_> {
        AvianTerrain::new(self, SpatialQueryFilter::DEFAULT)
    }
}
