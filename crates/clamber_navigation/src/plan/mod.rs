//! Plans: ways to a goal for a climber that tires.

mod forecast;
mod goal;
mod search;

pub use forecast::Forecast;
pub use goal::Goal;
pub(crate) use goal::{node, of_node};
pub(crate) use search::{Around, slips, throws};
pub use search::{Plan, PlanStep, Start};
