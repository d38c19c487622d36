#![doc = include_str!("../README.md")]

mod climber;
mod config;
mod discrete;
mod error;
mod state;
mod step;
mod surroundings;

pub use climber::{Climber, ClimberInput};
pub use config::ClimberConfig;
pub use discrete::{PushOut, average_push_out};
pub use error::ClimberError;
pub use state::{ClimberMode, ClimberState, Footing};
pub use step::{ClimberEvent, StepReport};
