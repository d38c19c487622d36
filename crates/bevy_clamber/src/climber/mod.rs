//! Climbers on entities: their obstacles, their ticks, their events, and where they are drawn.

mod component;
mod draw;
pub mod events;
mod input;
mod obstacles;
mod plugin;
mod rules;
mod shown;
mod step;
#[cfg(feature = "colossus")]
mod terrain_id;

pub use component::{Climber, ClimberBody, ClimberFilter, ClimberState};
#[cfg(feature = "fight")]
pub(crate) use input::LatchedInput;
pub use input::{ClimberBlow, ClimberInput};
#[cfg(feature = "avian")]
pub(crate) use obstacles::AVIAN;
pub use obstacles::CustomObstacle;
pub(crate) use obstacles::DrawnTouchable;
#[cfg(feature = "rapier")]
pub(crate) use obstacles::RAPIER;
#[cfg(feature = "colossus")]
pub(crate) use obstacles::Touchable;
pub use plugin::ClimberPlugin;
pub use rules::{AirVelocity, ClimberModes, ClimberRule, ClimberTouch, DefaultClimberRule};
#[cfg(feature = "colossus")]
pub use terrain_id::TerrainId;
