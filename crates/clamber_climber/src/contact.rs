use clamber_world::{MaterialPoint, ObstacleId, SurfaceTag};
use glam::DVec3;

/// A contact between a climber and an obstacle in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ClimberContact {
    /// The obstacle.
    pub obstacle: ObstacleId,
    /// The touched point of its material.
    pub material: MaterialPoint,
    /// Tag of the obstacle's material there, with the game's own number.
    pub tag: SurfaceTag,
    /// Position of the contact, in world space.
    pub position: DVec3,
    /// Separation normal: unit vector from the contact towards the climber, in world space.
    pub normal: DVec3,
    /// Speed at which obstacle and climber approached each other along the normal before the contact, metres a second.
    /// Negative if they were separating; 0 for the support.
    pub closing_speed: f64,
    /// The phase of the tick that found the contact.
    pub phase: ContactPhase,
}

/// The phase of a tick that found a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ContactPhase {
    /// The obstacle was in the way of the climber, or struck it, while the support carried the climber and it did not
    /// move on its own.
    Carried,
    /// The sweep of the climber's own movement hit the obstacle.
    Swept,
    /// The obstacle overlapped the climber after its own movement, at the tick's end, and pushed it out.
    Overlapped,
    /// The climber stands on the obstacle at the tick's end.
    Ground,
    /// The climber grips the obstacle, or hangs from a grip on it, at the tick's end.
    Grip,
    /// The climber hangs from a ledge of the obstacle at the tick's end.
    Ledge,
}
