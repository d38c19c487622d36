// Markdown takes a link's first target. The README's own target is a file that rustdoc's pages do not have, so the
// picture itself comes first.
#![doc = include_str!("guide/modes_link.md")]
#![doc = include_str!("../README.md")]

mod climber;
mod config;
mod contact;
mod error;
mod event;
mod group;
pub mod guide;
mod input;
mod knockback;
mod obstacle;
mod pendulum;
mod proxy;
mod resize;
mod rule;
mod shake;
mod state;
mod step;

pub use climber::{Climber, StepRules};
pub use config::{
    BodyConfig, ClimberConfig, GripConfig, GroundConfig, HangConfig, HealthConfig, LedgeConfig,
    Others, OthersError, StaminaConfig, TumbleConfig,
};
pub use contact::{ClimberContact, ContactPhase};
pub use error::ClimberError;
pub use event::{ClimberEvent, Push, StepReport};
/// The crate of the vectors and quaternions in this API.
pub use glam;
pub use group::ClimberGroup;
pub use input::ClimberInput;
pub use knockback::Knockback;
pub use obstacle::ClimberObstacle;
pub use rule::{ContactQuery, ContactRule, ContactRuleFn};
pub use shake::Shake;
pub use state::{CUSTOM_SLOTS, ClimberMode, ClimberState, Support, TRANSITIONS};
pub use step::{
    CustomMode, FlyingMemory, HangingMemory, HoldingMemory, LedgeHangingMemory, ModeContext,
    NextMode, StandingMemory, TumblingMemory,
};
