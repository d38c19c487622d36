//! Interop with parry: a posed surface answers parry's ray casts and point queries, and pieces of it
//! become parry's triangle meshes (feature `parry`).
//!
//! parry has no shape whose vertices follow a skeleton. Near a body, a [`SurfacePatch`] stands in: a
//! mesh of the few triangles there, with their velocities. `clamber_world`'s debris collides with such
//! patches.

mod patch;
mod posed;

/// The parry that this speaks to.
pub use parry3d;
pub use patch::{SurfacePatch, move_trimesh, trimesh};
pub use posed::PosedSurface;
