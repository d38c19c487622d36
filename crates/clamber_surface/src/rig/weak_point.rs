use glam::Vec3;

use super::JointId;

/// A place where a creature can be wounded: a ball that moves with a joint.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct WeakPoint {
    /// Name for display and for lookup; need not be unique.
    pub name: String,
    /// The joint that moves the weak point.
    pub joint: JointId,
    /// The centre, in the joint's space.
    pub position: Vec3,
    /// Radius of the ball in model units, finite, at least 0. A joint that is scaled in a pose does not change it.
    pub radius: f32,
    /// Damage that the weak point takes before it is used up, finite, greater than 0.
    pub hit_points: f64,
    /// True if the creature dies when the weak point is used up.
    pub major: bool,
    /// The weak point is hidden, and cannot be wounded, until all weak points of lower order are used up.
    pub order: u32,
}

impl WeakPoint {
    /// A minor weak point of radius 0 with 1 hit point, of order 0.
    pub fn new(name: impl Into<String>, joint: JointId, position: Vec3) -> Self {
        Self {
            name: name.into(),
            joint,
            position,
            radius: 0.0,
            hit_points: 1.0,
            major: false,
            order: 0,
        }
    }
}
