#![doc = include_str!("../README.md")]

mod body;
mod error;
mod figure;
mod humanoid;
mod retarget;

pub use body::{Act, Body, BodyError, BodyFrame, Plant};
/// Poses over time, and the inverse kinematics that [`Limb::ik`] is for.
pub use clamber_animation;
pub use error::HumanoidError;
pub use figure::{BodyClip, Extremity, Figure, FigureError};
pub use humanoid::{HumanJoint, Humanoid, Limb, LimbEnd, Side};
pub use retarget::{Retarget, RetargetError};
