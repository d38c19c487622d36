#![doc = include_str!("../README.md")]

mod animator;
mod error;
pub mod ik;
mod inertialize;
mod mask;
mod pose;
mod root_motion;
mod seam;
mod set;
mod space;
mod spring;

pub use animator::{AnimationEvent, Animator, Layer, LayerKind, PoseBuffers};
/// Skeletons, poses and clips.
pub use clamber_surface::rig;
pub use error::AnimationError;
pub use glam;
pub use mask::JointMask;
pub use root_motion::RootDelta;
pub use seam::{Seam, SeamProbe};
pub use set::{AnimationSet, ClipId, MaskId};
pub use space::{joint_in_model, joints_in_model};
pub use spring::{RotationSpring, Spring, Springy, damp};
