use clamber_world::{ObstacleId, SurfaceTag};
use glam::DVec3;

use crate::Extremity;

/// The event that a hand or foot came down on an obstacle, in the frame in which it arrives: for sounds, dust and
/// prints. [`Body::plants`](crate::Body::plants) lists those of the last update; while the hand or foot stays there,
/// [`Body::hold`](crate::Body::hold) gives its place.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Plant {
    /// The hand or foot that came down.
    pub extremity: Extremity,
    /// The obstacle that it came down on.
    pub obstacle: ObstacleId,
    /// The point of the obstacle's surface on which the hand or foot came down, in world space, metres, at that time.
    /// It does not follow the surface afterwards.
    pub point: DVec3,
    /// Unit normal of the surface at `point`, in world space, when the hand or foot came down. It does not follow the
    /// surface afterwards.
    pub normal: DVec3,
    /// Tag of the surface at `point`, such as its material.
    pub tag: SurfaceTag,
    /// Recent top speed of the hand or foot on its way, relative to the climber's support, metres a second: 1 to 3 for
    /// steps, more after falls.
    pub speed: f64,
}
