#![doc = include_str!("../README.md")]

pub mod actions;
pub mod aim;
mod arena;
mod error;
mod fighter;
mod projectile;
#[cfg(feature = "ggrs")]
pub mod rollback;
#[cfg(test)]
mod testing;

pub use actions::PlayerInput;
pub use arena::{
    Aimed, Arena, ArenaConfig, ArenaEvent, ArenaPart, ArenaState, CreatureId, KindId, Order,
    SavedCreature, SavedFighter, SwordLight, Weapon, creature_obstacle, fighter_obstacle,
};
pub use error::ArenaError;
pub use fighter::{
    Blade, BowConfig, CrushConfig, Fighter, FighterConfig, FighterFrame, FighterId, FighterState,
    StabTarget, StoneConfig, SwordConfig, WeaponAction,
};
pub use projectile::{
    Ballistics, Projectile, ProjectileBody, ProjectileId, ProjectileKind, ProjectileMotion,
    ProjectilePlace,
};
