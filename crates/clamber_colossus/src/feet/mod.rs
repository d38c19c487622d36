//! Feet on the ground: planted where they came down, and put where the ground will be.
//!
//! A clip shows when a foot stands ([`Contacts`](crate::kind::Contacts)). While it does, its ball stays where it came
//! down; while it swings, the difference to the clip goes to that of the place where it will land, by a cubic in time,
//! which takes the least acceleration for given ends. When the clip stands elsewhere than the foot, it takes a step of
//! its own. Speeds that decide scale with the square root of the leg's length (Froude's law).

mod arrive;
mod foot;
mod ground;
mod sole;

pub(crate) use foot::{Foot, FootGoal, GRAVITY, MOST_ASIDE, SHARES, STEP_TIME};
pub(crate) use ground::Ground;
pub(crate) use sole::{Footing, Sole};
