//! From animation to palette: skeletons, clips and poses.
//!
//! [`Clip::sample`] gives a [`Pose`] (local transforms), [`Pose::blend`] mixes two poses, and [`Skeleton::palette`]
//! turns a pose into the [`Palette`] that skins a mesh. All of these are pure functions of their inputs. Matrices
//! are composed in f64, and each is rounded to f32 once.
//!
//! A surface needs a new pose in every tick. Where poses are made less often, or at other times, [`PoseTrack`] blends
//! them.

mod clip;
mod error;
mod marker;
mod palette;
mod pose;
mod pose_clock;
mod pose_history;
mod pose_motion;
mod pose_track;
mod skeleton;
mod transform;
mod weak_point;

pub use clip::{Channel, Clip, Interpolation, Keyframes, Playback};
pub use error::RigError;
pub use marker::Marker;
pub use palette::Palette;
pub use pose::Pose;
pub use pose_clock::PoseClock;
pub use pose_history::{Between, PoseHistory};
pub use pose_motion::PoseMotion;
pub use pose_track::PoseTrack;
pub use skeleton::{Joint, JointId, Skeleton};
pub use transform::Transform;
pub(crate) use transform::{rotation_f32, rotation_f64};
pub use weak_point::WeakPoint;
