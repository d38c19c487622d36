//! Surfaces on entities: which entities pose them, when their poses are read, and how they get to ticks.

mod clock;
mod plugin;
mod pose;
mod posed;
mod rig;

use bevy_reflect::prelude::*;

pub(crate) use clock::PoseClock;
pub use plugin::SurfacePlugin;
pub use posed::PoseError;
pub use posed::PosedSurface;
pub(crate) use rig::{Hierarchy, Rig};

/// When an entity's `Transform` is written, which decides how it gets to ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Default, Clone, Debug, PartialEq, Hash)]
pub enum PoseTiming {
    /// Once a frame, in `Update` or by Bevy's `AnimationPlugin` in `PostUpdate`.
    ///
    /// A tick takes the pose between the last two that were drawn: at the same fraction of the last frame as the tick
    /// is of this one. So it lags by one frame, and moves evenly at any frame rate.
    #[default]
    EachFrame,
    /// Once a tick, in the fixed loop before [`ClamberSystems::Pose`](crate::ClamberSystems::Pose). A tick takes
    /// what it finds then: no lag.
    EachTick,
}
