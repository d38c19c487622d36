#![doc = include_str!("../README.md")]

mod config;
mod error;
mod graph;
mod patches;
mod report;
mod source;

pub use config::GraphConfig;
pub use error::NavigationError;
pub use graph::{ClimbGraph, Entry, Progress, Stage};
pub use patches::Patch;
pub use report::{ClimbReport, Missing, PointReport};
pub use source::GraphSource;
