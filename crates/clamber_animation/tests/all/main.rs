//! Layers and transitions of clips, heads that look at targets, and arms and legs.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod animator;
mod common;
mod gaze;
#[cfg(feature = "serde")]
mod serialised;
mod transitions;
mod two_bone;
