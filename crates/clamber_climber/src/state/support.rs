use clamber_world::{Attachment, SurfaceTag};
use glam::DVec3;

/// The material point that a climber stands on, grips or hangs from, and that carries it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct Support {
    /// The material point, with the climber's position attached to it. The point stays the same until the climber moves
    /// on its own, is pushed onto other ground, or takes a new support.
    pub attachment: Attachment,
    /// Separation normal: unit vector from the material point to the climber, in the frame of the material.
    pub normal: DVec3,
    /// Outward unit normal of the last face that the climber lay flat on, in the frame of the material. A corner is
    /// turned when the climber lies flat on a face with another normal.
    pub face: DVec3,
    /// Tag of the material, as it was when the support was found.
    pub tag: SurfaceTag,
}

impl Support {
    /// [`Support::normal`] in world space: a unit vector, for the pose of the material in the climber's last step.
    pub fn normal_in_world(&self) -> DVec3 {
        self.attachment.frame * self.normal
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.attachment.is_finite() && self.normal.is_finite() && self.face.is_finite()
    }
}
