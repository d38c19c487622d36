//! Compiles and runs the programs of `docs/recipes`; each module is one page:
//!
//! ```sh
//! cargo test -p clamber_recipes --doc
//! ```
//!
//! The programs run in this crate's folder, and load `../../assets/colossus.glb`.

#[doc = include_str!("../../../docs/recipes/arrows.md")]
pub mod arrows {}
#[doc = include_str!("../../../docs/recipes/camera.md")]
pub mod camera {}
#[doc = include_str!("../../../docs/recipes/creature_from_blender.md")]
pub mod creature_from_blender {}
#[doc = include_str!("../../../docs/recipes/crouching.md")]
pub mod crouching {}
#[doc = include_str!("../../../docs/recipes/debugging.md")]
pub mod debugging {}
#[doc = include_str!("../../../docs/recipes/falling_crates.md")]
pub mod falling_crates {}
#[doc = include_str!("../../../docs/recipes/own_model.md")]
pub mod own_model {}
#[doc = include_str!("../../../docs/recipes/own_engine.md")]
pub mod own_engine {}
#[doc = include_str!("../../../docs/recipes/person.md")]
pub mod person {}
#[doc = include_str!("../../../docs/recipes/players.md")]
pub mod players {}
#[doc = include_str!("../../../docs/recipes/recording.md")]
pub mod recording {}
#[doc = include_str!("../../../docs/recipes/rules.md")]
pub mod rules {}
#[doc = include_str!("../../../docs/recipes/saving.md")]
pub mod saving {}
#[doc = include_str!("../../../docs/recipes/scaling.md")]
pub mod scaling {}
#[doc = include_str!("../../../docs/recipes/server.md")]
pub mod server {}
#[doc = include_str!("../../../docs/recipes/tuning.md")]
pub mod tuning {}
