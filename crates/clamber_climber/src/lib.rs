// Markdown takes a link's first target. The README's own target is a file that rustdoc's pages do not have, so the
// picture itself comes first.
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
mod proxy;
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
/// The crate of the vectors and quaternions in this API.
pub use glam;
pub use input::{Blow, ClimberInput};
pub use obstacle::ClimberObstacle;
pub use shake::Shake;
pub use state::{ClimberMode, ClimberState, MEMORY, Support, TRANSITIONS};
pub use step::{
    CustomMode, FlyingMemory, HangingMemory, HoldingMemory, LedgeHangingMemory, ModeContext,
    NextMode, StandingMemory, TumblingMemory,
};
