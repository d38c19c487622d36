use clamber_world::{MaterialPoint, ObstacleId};
use glam::{DQuat, DVec3};

/// What a climber stands on, grips, or hangs from: a point of the material, which carries it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Support {
    /// The obstacle.
    pub obstacle: ObstacleId,
    /// The material point. Changes only when the climber lands, goes or grips.
    pub point: MaterialPoint,
    /// Where it was after the last step, in world space.
    pub contact: DVec3,
    /// From there to the climber's centre, in the frame of the material: it turns with what it is on.
    pub offset: DVec3,
    /// Unit vector from the material to the climber, in the frame of the material.
    pub normal: DVec3,
    /// Outward unit normal of the last face that it lay on flat, in the frame of the material: corners are counted
    /// from face to face.
    pub face: DVec3,
    /// The frame of the material as last known: where the skin collapses, it stands.
    pub frame: DQuat,
}

impl Support {
    /// [`Support::offset`] in world space.
    pub fn offset_in_world(&self) -> DVec3 {
        self.frame * self.offset
    }

    /// [`Support::normal`] in world space.
    pub fn normal_in_world(&self) -> DVec3 {
        self.frame * self.normal
    }

    pub(crate) fn is_finite(&self) -> bool {
        let vectors = [
            self.contact,
            self.offset,
            self.normal,
            self.face,
            DVec3::from_array(self.point.coordinates),
        ];
        vectors.iter().all(|v| v.is_finite()) && self.frame.is_finite()
    }
}
