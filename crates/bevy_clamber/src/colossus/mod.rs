//! Creatures that live by a brain from a file.

mod asset;
mod component;
mod events;
mod live;
mod plugin;
mod senses;

pub use asset::{BrainLoadError, ColossusBrain};
pub use component::{Colossus, ColossusBody};
pub use events::{
    ColossusEntered, ColossusHurt, ColossusMarker, ColossusPlanted, ColossusStaggered,
    ColossusStruck,
};
pub use plugin::ColossusPlugin;
pub use senses::ColossusNoise;
