// Of two targets of a link the first counts: here the README's picture is in no folder.
#![doc = include_str!("guide/modes_link.md")]
#![doc = include_str!("../README.md")]

mod climber;
mod config;
mod contact;
mod error;
mod event;
pub mod guide;
mod input;
mod obstacle;
mod pendulum;
mod shake;
mod state;
mod step;

pub use climber::{CanGrip, Climber, StepRules};
pub use config::{
    BodyConfig, ClimberConfig, GripConfig, GroundConfig, HangConfig, HealthConfig, LedgeConfig,
    StaminaConfig, TumbleConfig,
};
pub use contact::{ClimberContact, ContactPhase};
pub use error::ClimberError;
pub use event::{ClimberEvent, Push, StepReport};
/// The crate whose vectors and quaternions are used here.
pub use glam;
pub use input::{Blow, ClimberInput};
pub use obstacle::ClimberObstacle;
pub use state::{ClimberMode, ClimberState, MEMORY, Support, TRANSITIONS};
pub use step::{
    CustomMode, FlyingMemory, HangingMemory, LedgeHangingMemory, ModeContext, NextMode,
    StandingMemory, TumblingMemory,
};
