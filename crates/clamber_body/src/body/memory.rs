use clamber_animation::Spring;
use clamber_surface::geometry::Similarity;
use clamber_world::Attachment;
use glam::DVec3;

use super::climb::Climb;
use super::ground::Ground;
use super::legs::Legs;
use super::limb::LimbMemory;
use super::root::Root;
use super::stance::Stance;
use super::update::{Displacement, Gaze, Turning};
use super::walk::Walk;

/// Everything that a body remembers from frame to frame, except its clips. Lengths are metres in world space. The
/// memory moves with the climber's support, the carrier.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Memory {
    pub(crate) climber: ClimberMemory,
    pub(crate) stance: Stance,
    /// Seconds since the hands took hold.
    pub(crate) held: f64,
    /// Seconds since the climber left the ground in a step down; 0 otherwise.
    pub(crate) in_air: f64,
    /// The model's shown place.
    pub(crate) root: Root,
    /// Velocity of the shown place, relative to the carrier.
    pub(crate) velocity: DVec3,
    pub(crate) turning: Turning,
    pub(crate) displacement: Displacement,
    pub(crate) ground: Ground,
    /// Depth of the pelvis below its height in the clips' pose, for the feet.
    pub(crate) drop: f64,
    /// Displacement of the body towards the holds of its hands and feet.
    pub(crate) pull: Spring<DVec3>,
    pub(crate) walk: Walk,
    pub(crate) climb: Climb,
    pub(crate) legs: Legs,
    pub(crate) gaze: Gaze,
    pub(crate) limbs: [LimbMemory; 4],
    pub(crate) scale: f64,
}

/// The climber's place and motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClimberMemory {
    pub(crate) carrier: Option<Attachment>,
    pub(crate) position: DVec3,
    /// Velocity of the carrier.
    pub(crate) base: DVec3,
    /// Velocity of the climber relative to the carrier; on a wall, its part along the skin.
    pub(crate) motion: DVec3,
    /// Velocity of the climber relative to the carrier, in all directions.
    pub(crate) full_motion: DVec3,
}

impl Memory {
    pub(crate) fn similarity(&self) -> Similarity {
        Similarity {
            translation: self.root.position,
            rotation: self.root.rotation,
            scale: self.scale,
        }
    }
}
