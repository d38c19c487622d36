use clamber_world::{ObstacleId, SurfaceTag};
use glam::DVec3;

use crate::Extremity;

/// A hand or foot came down on an obstacle: for sounds, dust and prints.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Plant {
    /// The hand or foot.
    pub extremity: Extremity,
    /// The obstacle that it came down on.
    pub obstacle: ObstacleId,
    /// The touched point, in world space.
    pub point: DVec3,
    /// Unit normal of the surface at `point`, in world space, when the hand or foot came down. It does not follow the
    /// surface afterwards.
    pub normal: DVec3,
    /// Tag of the surface there.
    pub tag: SurfaceTag,
    /// Recent top speed of the hand or foot on its way, relative to the climber's support, metres a second: 1 to 3 for
    /// steps, more after falls.
    pub speed: f64,
}
