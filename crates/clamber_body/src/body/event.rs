use clamber_world::{ObstacleId, SurfaceTag};
use glam::DVec3;

use crate::Extremity;

/// A hand or foot came down on something: for sounds, dust and prints.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Plant {
    /// The hand or foot.
    pub extremity: Extremity,
    /// What it came down on.
    pub obstacle: ObstacleId,
    /// Where, in world space.
    pub point: DVec3,
    /// Unit normal of what it came down on, in world space.
    pub normal: DVec3,
    /// Tag of what it came down on.
    pub tag: SurfaceTag,
    /// How fast the hand or foot was on its way there, relative to what it came down on, metres a second: 1 to 3 for
    /// steps, more after falls.
    pub speed: f64,
}
