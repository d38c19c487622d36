use bevy_app::{App, FixedUpdate, Plugin};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use bevy_ecs::system::SystemParam;
use bevy_rapier3d::prelude::{DefaultRapierContext, PhysicsSet, RapierRigidBodySet};
use bevy_rapier3d::prelude::{RapierContext, RapierContextColliders, ReadRapierContext, Velocity};
use clamber_world::{BodyPoses, MaterialPoint, RapierTerrain, apply_push};
use glam::DVec3;

use crate::{ClamberSystems, WorldOrigin};

/// Records the poses of rapier's bodies before each step, so that climbers on them can be carried. `ClimberPlugin` adds
/// it by itself.
#[derive(Clone, Copy, Debug)]
pub struct RapierObstaclesPlugin {
    schedule: InternedScheduleLabel,
}

impl RapierObstaclesPlugin {
    /// For a `RapierPhysicsPlugin` in this schedule, which must run once a tick.
    pub fn in_schedule(schedule: impl ScheduleLabel) -> Self {
        Self {
            schedule: schedule.intern(),
        }
    }
}

impl Default for RapierObstaclesPlugin {
    /// In [`FixedUpdate`], for `RapierPhysicsPlugin::in_fixed_schedule`.
    fn default() -> Self {
        Self::in_schedule(FixedUpdate)
    }
}

impl Plugin for RapierObstaclesPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<StepPoses>()
            .init_resource::<WorldOrigin>()
            .add_systems(
                self.schedule,
                note.after(PhysicsSet::Writeback)
                    .before(ClamberSystems::Climb),
            );
    }
}

/// The default context of `bevy_rapier3d` as an obstacle.
///
/// A read-only system parameter; needs [`RapierObstaclesPlugin`]. Moving bodies are seen where the last step has put
/// them: query after `PhysicsSet::Writeback` to see them without lag.
///
/// ```
/// # use bevy_clamber::RapierObstacles;
/// # use clamber_world::Obstacle;
/// # use glam::DVec3;
/// fn height_of_ground(rapier: RapierObstacles) {
///     let Some(terrain) = rapier.terrain() else {
///         return;
///     };
///     let below = terrain.cast_ray(DVec3::Y * 10.0, DVec3::NEG_Y, 100.0);
///     println!("{:?}", below.map(|contact| contact.point.y));
/// }
/// ```
#[derive(SystemParam)]
pub struct RapierObstacles<'w, 's> {
    context: ReadRapierContext<'w, 's>,
    poses: Res<'w, StepPoses>,
}

impl RapierObstacles<'_, '_> {
    /// All colliders except sensors; [`RapierTerrain::with_filter`] restricts them. `None` while there is no default
    /// context.
    pub fn terrain(&self) -> Option<RapierTerrain<'_>> {
        let RapierContext {
            simulation,
            colliders,
            rigidbody_set,
            ..
        } = self.context.single().ok()?;
        Some(RapierTerrain::new(
            &rigidbody_set.bodies,
            &colliders.colliders,
            &simulation.broad_phase,
            &self.poses.before,
        ))
    }
}

impl RapierObstacles<'_, '_> {
    /// The entity of the collider that a point belongs to.
    pub(crate) fn entity(&self, point: &MaterialPoint) -> Option<Entity> {
        let colliders = &self.context.single().ok()?.colliders.colliders;
        let collider = colliders.get(RapierTerrain::collider_of(point))?;
        Entity::try_from_bits(u64::try_from(collider.user_data).ok()?)
    }
}

/// Applies the impulses of climbers to rapier's bodies.
#[derive(SystemParam)]
pub(crate) struct RapierPushes<'w, 's> {
    worlds: Query<
        'w,
        's,
        (
            &'static mut RapierRigidBodySet,
            &'static RapierContextColliders,
        ),
        With<DefaultRapierContext>,
    >,
    velocities: Query<'w, 's, &'static mut Velocity>,
}

impl RapierPushes<'_, '_> {
    /// Applies an impulse, newton seconds, to a point of a collider.
    pub(crate) fn push(&mut self, point: &MaterialPoint, impulse: DVec3) {
        let Ok((mut bodies, colliders)) = self.worlds.single_mut() else {
            return;
        };
        let (bodies, colliders) = (&mut bodies.bodies, &colliders.colliders);
        apply_push(bodies, colliders, point, impulse);
        let collider = colliders.get(RapierTerrain::collider_of(point));
        let body = collider.and_then(|collider| bodies.get(collider.parent()?));
        let Some(body) = body else {
            return;
        };
        let entity = u64::try_from(body.user_data).ok();
        let entity = entity.and_then(Entity::try_from_bits);
        // The component changes with each step, and so replaces the body's velocity before the next one.
        if let Some(mut velocity) = entity.and_then(|entity| self.velocities.get_mut(entity).ok()) {
            velocity.set_if_neq(Velocity {
                linear: body.linvel(),
                angular: body.angvel(),
            });
        }
    }
}

/// Poses of the bodies before and after the last step.
#[derive(Resource, Default)]
struct StepPoses {
    before: BodyPoses,
    after: BodyPoses,
    /// The [`WorldOrigin`] at the last step.
    origin: DVec3,
}

/// Records poses after each step, not before it, so that bodies that a game moves between two steps have motion, too.
fn note(
    mut poses: ResMut<StepPoses>,
    origin: Res<WorldOrigin>,
    bodies: Query<&RapierRigidBodySet, With<DefaultRapierContext>>,
) {
    let poses = &mut *poses;
    std::mem::swap(&mut poses.before, &mut poses.after);
    if poses.origin != origin.0 {
        let by = (poses.origin - origin.0).as_vec3();
        poses.before.translate(by);
        poses.origin = origin.0;
    }
    if let Ok(bodies) = bodies.single() {
        poses.after.record(&bodies.bodies);
    }
}
