//! Creatures and scenes that clamber's tests, benches and examples share. Not published.
//!
//! - [`giant`]: the project's own giant, from its file, with any number of vertices.
//! - [`resample`]: any mesh with more or fewer vertices.
//! - [`Creature`]: a creature as scenes use it, from a file.
//! - [`bodies`]: ground, walls, ledges and creatures for the body of a climber.
//! - [`riders`]: the queries of riders on a walking giant, tick by tick.
//! - [`controllers`]: thirty scenes on moving ground, for any character controller.
//! - [`rocks`]: rocks that fall on a creature.
//! - [`valley`]: the terrain of the scenes.
//! - [`battle`]: the main scene: a climber against a giant that lives by its brain, or on a creature that walks and
//!   shakes.
//! - [`duel`]: two climbers against the giant, for fights over a network.
//! - `hero`, with the feature `record` or `render`: the body of a battle's climber.
//! - `picture`, with the feature `render`: a battle's meshes, light and cameras for the renderer.
//! - [`measure`]: tables, bounds, quantiles, times and exit codes for benches and examples.
//! - [`climbs`]: a creature that moves while it is climbed, and routes over it.
//! - [`solid_angle`]: whether a point is inside a mesh, without the library's queries.
//! - [`test_data`]: third-party files for tests.

pub mod battle;
pub mod bodies;
pub mod climbs;
pub mod controllers;
mod creature;
pub mod duel;
pub mod giant;
#[cfg(any(feature = "record", feature = "render"))]
pub mod hero;
mod json;
pub mod measure;
#[cfg(feature = "render")]
pub mod picture;
#[cfg(doctest)]
mod recipes;
pub mod resample;
pub mod riders;
pub mod rocks;
pub mod solid_angle;
pub mod test_data;
pub mod valley;

pub use creature::Creature;

/// Why a creature or a scene cannot be loaded, made, stepped, recorded or drawn.
pub type SceneError = Box<dyn std::error::Error>;
