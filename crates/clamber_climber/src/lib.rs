// Of two targets of a link the first counts: here the README's picture is in no folder.
#![doc = include_str!("guide/modes_link.md")]
#![doc = include_str!("../README.md")]

mod body;
mod climber;
mod config;
mod discrete;
mod error;
mod event;
pub mod guide;
mod input;
mod mover;
mod pendulum;
mod planes;
mod shake;
mod state;
mod step;
mod surroundings;

pub use body::ClimberBody;
pub use climber::{CanGrip, Climber};
pub use config::{
    BodyConfig, ClimberConfig, GripConfig, GroundConfig, HangConfig, HealthConfig, LedgeConfig,
    StaminaConfig, TumbleConfig,
};
pub use discrete::{PushOut, average_push_out};
pub use error::ClimberError;
pub use event::{ClimberEvent, Push, StepReport};
pub use input::{Blow, ClimberInput};
pub use state::{ClimberMode, ClimberState, Support, TRANSITIONS};
