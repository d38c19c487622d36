#![doc = include_str!("../README.md")]

mod bot;
#[cfg(feature = "cache")]
mod cache;
mod clips;
mod config;
mod error;
mod future;
mod graph;
mod landing;
mod plan;
mod progress;
mod report;
mod ride;
mod survey;

pub use bot::{Bot, BotConfig, Danger, View};
#[cfg(feature = "cache")]
pub use cache::{CachedGraph, GraphOrigin};
pub use config::GraphConfig;
pub use error::NavigationError;
pub use future::{FutureSkin, PoseForecast};
pub use graph::{ClimbGraph, Entry, Footing, Patch};
pub use landing::{Airborne, Landing};
pub use plan::{Forecast, Goal, Plan, PlanStep, Start};
pub use progress::{Progress, Stage};
pub use report::{ClimbReport, ClipReport, EntryRoute, Missing, PointReport};
pub use ride::{Ride, RideEnd, ThrowOff};
