//! A fight as one value: the arena is stepped as a whole, and entities show its contents.

mod component;
mod figure;
mod plugin;
mod resource;
mod show;
mod step;
mod terrain;

pub use component::{ArenaCreature, ArenaFighter, ArenaProjectile};
pub use plugin::ArenaPlugin;
pub use resource::{FightArena, FightEvent};
pub use terrain::ArenaTerrain;
