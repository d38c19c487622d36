//! A fight as one value: an arena that is stepped whole, and entities that show what is in it.

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
