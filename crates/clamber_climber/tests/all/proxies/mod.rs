//! Climbers that rapier's dynamic bodies collide with, by their proxies.

mod falling;
mod heavy;
mod memory;
mod pushing;
mod restoring;
mod scene;
mod skins;
mod striking;
