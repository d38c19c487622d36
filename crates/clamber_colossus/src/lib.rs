#![doc = include_str!("../README.md")]

mod angle;
pub mod brain;
mod creature;
mod error;
mod feet;
mod kind;
mod propose;
pub mod senses;

pub use brain::{Brain, BrainError, BrainFile, BrainProblem, BrainReport, BrainState};
pub use creature::{
    ActiveBeam, ActiveShot, ActiveWave, AttackPhase, Creature, CreatureConfig, CreatureEvent,
    CreatureReport, CreatureState, Foresight, Noise, Person, Riding, StrikeHit, Surroundings,
};
pub use error::ColossusError;
pub use kind::{
    BodyFile, ClipFile, CreatureKind, Facing, FurFile, GaitFile, HeadFile, Knee, LegFile, Plate,
    PlateFile, Times, WeakPointFile,
};
pub use senses::{RegionSense, Sense, Senses};
