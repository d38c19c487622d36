//! Creatures and scenes that clamber's tests, benches and examples share. Not published.
//!
//! - [`ball`]: closed balls of plain triangles.
//! - [`beast`]: a quadruped built in code, of any number of vertices.
//! - [`giant`]: the project's own giant, from its file, at any number of vertices.
//! - [`resample`]: any mesh at any number of vertices.
//! - [`Creature`]: what a scene needs of a creature, from code or from a file.
//! - [`riders`]: what riders on a walking giant ask in a tick.
//! - [`controllers`]: thirty scenes on moving ground, for any character controller.
//! - [`rocks`]: rocks on a shaking giant.
//! - [`valley`]: terrain to walk in.
//! - [`battle`]: the main scene: a climber rides a walking, shaking creature.
//! - `picture`, with the feature `render`: what of a battle is to be seen.
//! - [`inspect`]: what an import found, and how the creature fares in motion.
//! - [`measure`]: tables, quantiles and yardsticks for benches.
//! - [`part_bounds`]: spheres and capsules about parts in any pose, in f64.
//! - [`tour`]: a bot climbs from a creature's foot to its head.
//! - [`closed`]: is a mesh closed, and which side of it is inside?
//! - [`solid_angle`]: is a point inside a mesh? An answer that owes nothing to the queries.
//! - [`test_data`]: third-party files for tests.

pub mod ball;
pub mod battle;
pub mod beast;
pub mod closed;
pub mod controllers;
mod creature;
pub mod giant;
pub mod inspect;
mod json;
pub mod measure;
pub mod part_bounds;
#[cfg(feature = "render")]
pub mod picture;
pub mod resample;
pub mod riders;
pub mod rocks;
pub mod solid_angle;
pub mod test_data;
pub mod tour;
pub mod valley;

pub use creature::{Creature, CreatureError};
