//! Pictures, and the numbers in them.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

mod common;
mod creatures;
mod overlays;
mod pictures;
mod shadows;
mod skinning;
mod stored;
mod text;
