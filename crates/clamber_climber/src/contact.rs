use clamber_world::{MaterialPoint, ObstacleId, SurfaceTag};
use glam::DVec3;

/// Something that touched a climber in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ClimberContact {
    /// The obstacle.
    pub obstacle: ObstacleId,
    /// The point of its material.
    pub material: MaterialPoint,
    /// What it is made of, with the game's own number.
    pub tag: SurfaceTag,
    /// Where, in world space.
    pub position: DVec3,
    /// Unit vector from the obstacle to the climber.
    pub normal: DVec3,
    /// How fast obstacle and climber approached each other along the normal before the contact, metres a second;
    /// negative while they part.
    pub closing_speed: f64,
    /// In which phase of the tick.
    pub phase: ContactPhase,
}

/// In which phase of a tick something touched a climber.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ContactPhase {
    /// The climber wanted to stay where its support carries it: this was in the way there, or struck it.
    Carried,
    /// It was met by the sweep of the climber's own movement.
    Swept,
    /// It overlapped the climber at the tick's end, and pushed it out.
    Overlapped,
    /// The climber stands on it at the tick's end.
    Ground,
    /// The climber grips it, or hangs from a grip on it, at the tick's end.
    Grip,
    /// The climber hangs from a ledge of it at the tick's end.
    Ledge,
}
