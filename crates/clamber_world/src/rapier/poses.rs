use rapier3d::dynamics::{RigidBody, RigidBodyHandle, RigidBodySet};
use rapier3d::math::Pose;

/// Where the bodies of a rapier world stood before a step.
///
/// Velocities of bodies are measured as displacements over the tick, so that a character on a
/// turning platform goes where its spot goes and not along the tangent. Teleport bodies before `record`: one that is
/// teleported between `record` and a query is swept along the whole way. Record before each step:
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
    poses: Vec<(RigidBodyHandle, Pose)>,
}

impl BodyPoses {
    /// None yet: nothing of the world moves.
    pub const fn new() -> Self {
        Self { poses: Vec::new() }
    }

    /// Takes note of every body that can move. Keeps its memory.
    pub fn record(&mut self, bodies: &RigidBodySet) {
        self.poses.clear();
        let moving = bodies.iter().filter(|(_, body)| !body.is_fixed());
        self.poses
            .extend(moving.map(|(handle, body)| (handle, *body.position())));
        self.poses
            .sort_unstable_by_key(|(handle, _)| handle.into_raw_parts());
    }

    /// The pose of a body when it was last recorded; `None` for a body that is fixed or new.
    pub fn get(&self, handle: RigidBodyHandle) -> Option<&Pose> {
        let index = self
            .poses
            .binary_search_by_key(&handle.into_raw_parts(), |(known, _)| {
                known.into_raw_parts()
            })
            .ok()?;
        Some(&self.poses[index].1)
    }

    /// Bodies that are elsewhere than they were.
    pub(super) fn moved<'a>(
        &'a self,
        bodies: &'a RigidBodySet,
    ) -> impl Iterator<Item = &'a RigidBody> {
        self.poses.iter().filter_map(|(handle, before)| {
            let body = bodies.get(*handle)?;
            (body.position() != before).then_some(body)
        })
    }
}
