//! Graphs and plans on bodies of known shape.

mod areas;
#[cfg(feature = "cache")]
mod cache;
mod jumps;
mod leaps;
mod moving;
mod plans;
mod strength;
mod support;
