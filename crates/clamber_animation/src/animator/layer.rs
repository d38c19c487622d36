use clamber_surface::rig::Playback;

use crate::error::{finite, within};
use crate::{AnimationError, ClipId, MaskId};

/// How a layer combines with the pose of the layers below it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum LayerKind {
    /// Blends from the pose below to the layer's pose by the layer's weight.
    Override,
    /// Adds to the pose below: each joint's difference from the first frame of the layer's clip, in the joint's own
    /// space.
    Additive,
}

/// One clip with its playback state, as an [`Animator`](crate::Animator) plays it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Layer {
    /// The clip.
    pub clip: ClipId,
    /// Seconds since the clip's first key frame.
    pub time: f64,
    /// Seconds of the clip per second; negative plays backwards, 0 holds the pose.
    pub speed: f64,
    /// Weight of the layer, from 0 (no effect) to 1.
    pub weight: f64,
    /// Whether the clip repeats or holds its end.
    pub playback: Playback,
    /// Whether the layer replaces the pose below or adds to it.
    pub kind: LayerKind,
    /// The joints that the layer moves; `None` for all.
    pub mask: Option<MaskId>,
}

impl Layer {
    pub(super) fn check(&self) -> Result<(), AnimationError> {
        finite("a layer's time", self.time)?;
        finite("a layer's speed", self.speed)?;
        within("a layer's weight", "from 0 to 1", self.weight, 0.0, 1.0)
    }
}
