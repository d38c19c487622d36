#![doc = include_str!("../README.md")]

mod body;
mod characters;
mod error;
mod filters;
mod grip;
mod ground;
mod half_spaces;
mod ledge;
mod mover;
mod path;
mod slide;
mod surroundings;
mod touch;
mod velocity;

pub use body::MoverBody;
pub use characters::is_beside;
pub use error::MoverError;
pub use filters::{ContactFilter, ContactFilters};
/// The version of glam that this crate's API uses.
pub use glam;
pub use ground::{Ground, GroundProbe, StepUp, slope};
pub use half_spaces::{MovePlane, Projection, project_onto_half_spaces};
pub use ledge::{Ledge, LedgeHold, LedgeProbe};
pub use mover::{Mover, MoverMemory};
pub use path::{Arm, Begin, IntoOthers, Moved, Path, Walking};
pub use touch::MoverContact;
