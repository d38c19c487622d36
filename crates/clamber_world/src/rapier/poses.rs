use rapier3d::dynamics::{RigidBody, RigidBodyHandle, RigidBodySet};
use rapier3d::math::{Pose, Vector};

/// The recorded pose and velocities of a body.
#[derive(Clone, Copy, Debug)]
struct Recorded {
    body: RigidBodyHandle,
    pose: Pose,
    linvel: Vector,
    angvel: Vector,
}

/// Poses and velocities of a rapier world's bodies before a step.
///
/// Velocities of bodies are measured as displacements over the tick, so that a character on a turning platform follows
/// its spot on the platform, not the tangent. Teleport bodies before `record`: a body that is teleported between
/// `record` and a query is swept over the whole distance. Record before each step:
///
/// ```
/// use clamber_world::{BodyPoses, RapierTerrain};
/// use rapier3d::prelude::*;
///
/// let mut world = PhysicsWorld::default();
/// let mut before = BodyPoses::default();
/// // Every tick:
/// before.record(&world.bodies);
/// world.step();
/// let terrain = RapierTerrain::of_world(&world, &before);
/// # let _ = terrain;
/// ```
#[derive(Clone, Debug, Default)]
pub struct BodyPoses {
    /// In ascending order of handles.
    poses: Vec<Recorded>,
}

impl BodyPoses {
    /// An empty set of poses, with which nothing in the world moves.
    pub const fn new() -> Self {
        Self { poses: Vec::new() }
    }

    /// Records the pose of every body that can move, in place of the poses recorded before. Keeps its memory.
    pub fn record(&mut self, bodies: &RigidBodySet) {
        self.poses.clear();
        let moving = bodies.iter().filter(|(_, body)| !body.is_fixed());
        self.poses.extend(moving.map(|(handle, body)| Recorded {
            body: handle,
            pose: *body.position(),
            linvel: body.linvel(),
            angvel: body.angvel(),
        }));
        self.poses
            .sort_unstable_by_key(|recorded| recorded.body.into_raw_parts());
    }

    /// Moves the recorded poses by a vector, metres, for a game that has moved all bodies by it, because the origin of
    /// its world is elsewhere now. The bodies then count as not moved.
    pub fn translate(&mut self, by: Vector) {
        for recorded in &mut self.poses {
            recorded.pose.translation += by;
        }
    }

    /// The recorded pose of a body. `None` if the body was fixed or did not exist when poses were recorded.
    pub fn get(&self, handle: RigidBodyHandle) -> Option<&Pose> {
        self.recorded(handle).map(|recorded| &recorded.pose)
    }

    /// The recorded linear and angular velocity of a body.
    pub(super) fn velocities(&self, handle: RigidBodyHandle) -> Option<[Vector; 2]> {
        self.recorded(handle)
            .map(|recorded| [recorded.linvel, recorded.angvel])
    }

    fn recorded(&self, handle: RigidBodyHandle) -> Option<&Recorded> {
        let key = |recorded: &Recorded| recorded.body.into_raw_parts();
        let index = self
            .poses
            .binary_search_by_key(&handle.into_raw_parts(), key);
        self.poses.get(index.ok()?)
    }

    /// Bodies that are dynamic and enabled and whose pose differs from the recorded one, in ascending order of handles.
    pub(super) fn moved_dynamic<'a>(
        &'a self,
        bodies: &'a RigidBodySet,
    ) -> impl Iterator<Item = (RigidBodyHandle, Pose, &'a RigidBody)> {
        self.poses.iter().filter_map(|recorded| {
            let body = bodies.get(recorded.body)?;
            let moves = body.is_dynamic() && body.is_enabled();
            let moved = moves && *body.position() != recorded.pose;
            moved.then_some((recorded.body, recorded.pose, body))
        })
    }

    /// Bodies whose pose differs from the recorded one.
    pub(super) fn moved<'a>(
        &'a self,
        bodies: &'a RigidBodySet,
    ) -> impl Iterator<Item = &'a RigidBody> {
        self.poses.iter().filter_map(|recorded| {
            let body = bodies.get(recorded.body)?;
            (*body.position() != recorded.pose).then_some(body)
        })
    }
}
