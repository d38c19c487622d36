//! From animation to palette: skeleton, pose, clip.
//!
//! `Clip::sample` gives a [`Pose`] (local transforms), [`Pose::blend`] mixes poses, and
//! [`Skeleton::palette`] turns one into the [`Palette`] that skins a mesh. All of it is a pure
//! function of its inputs; composition happens in f64 and is rounded to f32 once, per matrix.

mod clip;
mod error;
mod palette;
mod pose;
mod skeleton;
mod transform;
mod weak_point;

pub use clip::{Channel, Clip, Interpolation, Keyframes, Playback};
pub use error::RigError;
pub use palette::Palette;
pub use pose::Pose;
pub use skeleton::{Joint, JointId, Skeleton};
pub use transform::Transform;
pub(crate) use transform::{rotation_f32, rotation_f64};
pub use weak_point::WeakPoint;
