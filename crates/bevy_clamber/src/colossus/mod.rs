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
    ColossusBurst, ColossusEntered, ColossusHurt, ColossusMarker, ColossusPlanted,
    ColossusStaggered, ColossusStruck, ColossusThrew, ColossusWave,
};
pub use plugin::ColossusPlugin;
pub use senses::ColossusNoise;
