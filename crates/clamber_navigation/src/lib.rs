#![doc = include_str!("../README.md")]

mod bot;
mod clips;
mod config;
mod error;
mod graph;
mod plan;
mod progress;
mod report;
mod source;
mod survey;

pub use bot::{Bot, BotConfig, Danger, View};
pub use config::GraphConfig;
pub use error::NavigationError;
pub use graph::{ClimbGraph, Entry, Footing, Patch};
pub use plan::{Forecast, Goal, Plan, PlanStep, Start};
pub use progress::{Progress, Stage};
pub use report::{ClimbReport, Missing, PointReport};
pub use source::GraphSource;
