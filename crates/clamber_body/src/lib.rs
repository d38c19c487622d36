#![doc = include_str!("../README.md")]

mod body;
mod error;
mod figure;
mod humanoid;
mod retarget;

pub use body::{Body, BodyInput, OverlayClip, Plant};
/// The crate that plays clips and solves inverse kinematics, as for [`Limb::ik`].
pub use clamber_animation;
pub use error::BodyError;
pub use figure::{BodyClip, Extremity, Figure};
pub use humanoid::{HumanJoint, Humanoid, Limb, LimbEnd, Side};
pub use retarget::Retarget;
