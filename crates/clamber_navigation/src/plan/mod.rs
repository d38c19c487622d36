//! Ways to a goal for a climber that tires.

mod forecast;
mod goal;
mod search;

pub use forecast::Forecast;
pub use goal::Goal;
pub use search::{Plan, PlanStep, Start};
pub(crate) use search::{slips, throws};
