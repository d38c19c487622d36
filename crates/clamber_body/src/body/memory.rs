use clamber_animation::ik::LookMemory;
use clamber_animation::{RotationSpring, Spring};
use clamber_surface::geometry::Similarity;
use clamber_world::Attachment;
use glam::DVec3;

use super::climb::Climb;
use super::ground::Ground;
use super::legs::Legs;
use super::limb::LimbMemory;
use super::root::Root;
use super::stance::Stance;
use super::walk::Walk;

/// All that a body remembers from frame to frame, but for its clips. In world space; what carries the climber moves it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Memory {
    pub(crate) carrier: Option<Attachment>,
    /// The climber's position.
    pub(crate) position: DVec3,
    pub(crate) stance: Stance,
    /// Seconds since hands took hold.
    pub(crate) held: f64,
    /// Seconds without ground.
    pub(crate) in_air: f64,
    /// Where the model was shown, and how fast it moved relative to the carrier.
    pub(crate) root: Root,
    pub(crate) velocity: DVec3,
    /// Velocity of the carrier.
    pub(crate) base: DVec3,
    pub(crate) turn: RotationSpring,
    /// Difference from the stance's own place.
    pub(crate) offset: Spring<DVec3>,
    /// Time for half of it, seconds.
    pub(crate) offset_half: f64,
    pub(crate) ground: Ground,
    /// How far the pelvis is down for the feet.
    pub(crate) drop: f64,
    /// How far the body is pulled by hands and feet that hold.
    pub(crate) pull: Spring<DVec3>,
    /// Velocity along the ground that the body has settled to: it leans into the difference.
    pub(crate) slow: Spring<DVec3>,
    /// Velocity of the climber relative to the carrier.
    pub(crate) motion: DVec3,
    /// The same, and not only along what it stands on or holds.
    pub(crate) full_motion: DVec3,
    pub(crate) walk: Walk,
    pub(crate) climb: Climb,
    pub(crate) legs: Legs,
    pub(crate) look: LookMemory,
    pub(crate) look_weight: Spring<f64>,
    pub(crate) look_at: DVec3,
    pub(crate) limbs: [LimbMemory; 4],
    pub(crate) scale: f64,
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
