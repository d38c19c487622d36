#![doc = include_str!("../README.md")]

mod error;
mod humanoid;
mod retarget;

/// Poses over time, and the inverse kinematics that [`Limb::ik`] is for.
pub use clamber_animation;
pub use error::HumanoidError;
pub use humanoid::{HumanJoint, Humanoid, Limb, LimbEnd, Side};
pub use retarget::{Retarget, RetargetError};
