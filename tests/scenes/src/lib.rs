//! Creatures and scenes that clamber's tests, benches and examples share. Not published.
//!
//! - [`ball`]: closed balls as plain triangles.
//! - [`beast`]: a quadruped built in code, with any number of vertices.
//! - [`giant`]: the project's own giant, from its file, with any number of vertices.
//! - [`resample`]: any mesh with more or fewer vertices.
//! - [`Creature`]: a creature as scenes use it, from code or from a file.
//! - [`riders`]: the queries of riders on a walking giant, tick by tick.
//! - [`controllers`]: thirty scenes on moving ground, for any character controller.
//! - [`rocks`]: rocks that fall on a shaking giant.
//! - [`valley`]: the terrain of the scenes.
//! - [`battle`]: the main scene: a climber against a giant that lives by its brain, or on a creature that walks and shakes.
//! - [`duel`]: two climbers against the giant, for fights over a network.
//! - [`person`]: a climber as a creature senses it.
//! - `hero`, with the feature `record` or `render`: the body of a battle's climber.
//! - `picture`, with the feature `render`: a battle's meshes, light and cameras for the renderer.
//! - [`measure`]: tables, plots, quantiles and reference values for benches.
//! - [`part_bounds`]: spheres and capsules around parts in any pose, in f64.
//! - [`life`]: the giant lives in fast forward, with riders.
//! - [`tour`]: a bot climbs from a creature's foot to its head.
//! - [`closed`]: whether a mesh is closed, and the volume that it encloses.
//! - [`solid_angle`]: whether a point is inside a mesh, without the library's queries.
//! - [`test_data`]: third-party files for tests.

pub mod ball;
pub mod battle;
pub mod beast;
pub mod bodies;
pub mod climbs;
pub mod closed;
pub mod controllers;
mod creature;
pub mod duel;
pub mod giant;
#[cfg(any(feature = "record", feature = "render"))]
pub mod hero;
mod json;
pub mod life;
pub mod measure;
pub mod part_bounds;
mod person;
#[cfg(feature = "render")]
pub mod picture;
#[cfg(doctest)]
mod recipes;
pub mod resample;
pub mod riders;
pub mod rocks;
pub mod solid_angle;
pub mod test_data;
pub mod tour;
pub mod valley;

pub use creature::{Creature, CreatureError};
pub use person::person;
