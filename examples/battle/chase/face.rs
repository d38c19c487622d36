//! The position and direction of the creature's face.

use clamber::prelude::*;
use clamber_scenes::Creature;
use clamber_scenes::battle::Battle;
use glam::{DVec3, Vec3};

/// The front of the head, in the space of its joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    head: JointId,
    place: DVec3,
    ahead: DVec3,
}

/// The face in one tick, in world space.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub(super) place: DVec3,
    /// Unit vector in the direction that the face looks.
    pub(super) ahead: DVec3,
}

impl Face {
    /// The front of the skin of the joint `head` of a creature that faces +Z; `None` without such a joint.
    pub(super) fn find(creature: &Creature) -> Option<Self> {
        let head = creature.skeleton.find("head")?;
        let rest = creature
            .skeleton
            .palette(&creature.skeleton.rest_pose())
            .ok()?;
        let joint_from_model = rest.model_from_joint(head)?.inverse();
        let mesh = &creature.collider;
        let part = mesh.parts().iter().find(|part| part.joint == head)?;
        let corners = part.vertices.iter();
        let corners = corners.filter_map(|vertex| mesh.positions().get(vertex.index()));
        let [low, high] = corners.fold(
            [Vec3::INFINITY, Vec3::NEG_INFINITY],
            |[low, high], corner| [low.min(*corner), high.max(*corner)],
        );
        let front = (0.5 * (low + high)).with_z(high.z).as_dvec3();
        let ahead = (joint_from_model.matrix3 * DVec3::Z).try_normalize()?;
        front.is_finite().then(|| Self {
            head,
            place: joint_from_model.transform_point3(front),
            ahead,
        })
    }

    /// The face in the battle's current pose.
    pub(super) fn now(&self, battle: &Battle<'_>) -> Option<Seen> {
        let frame = battle.palette().model_from_joint(self.head)?;
        let root = battle.surface().world_from_model();
        let ahead = root.rotation * (frame.matrix3 * self.ahead);
        Some(Seen {
            place: root.transform_point(frame.transform_point3(self.place)),
            ahead: ahead.try_normalize()?,
        })
    }
}
