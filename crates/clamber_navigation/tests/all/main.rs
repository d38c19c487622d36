//! Graphs and plans on bodies of known shape.

mod areas;
#[cfg(feature = "cache")]
mod cache;
mod jumps;
mod plans;
mod support;
