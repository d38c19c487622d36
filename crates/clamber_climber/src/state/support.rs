use clamber_world::{Attachment, SurfaceTag};
use glam::DVec3;

/// What a climber stands on, grips, or hangs from: a point of the material, which carries it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Support {
    /// The material point, which changes only when the climber lands, goes or grips; the climber's position is attached
    /// to it.
    pub attachment: Attachment,
    /// Unit vector from the material to the climber, in the frame of the material.
    pub normal: DVec3,
    /// Outward unit normal of the last face that it lay on flat, in the frame of the material: corners are counted
    /// from face to face.
    pub face: DVec3,
    /// What the material is made of, as of when it was found.
    pub tag: SurfaceTag,
}

impl Support {
    /// [`Support::normal`] in world space.
    pub fn normal_in_world(&self) -> DVec3 {
        self.attachment.frame * self.normal
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.attachment.is_finite() && self.normal.is_finite() && self.face.is_finite()
    }
}
