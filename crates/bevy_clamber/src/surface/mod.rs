//! Surfaces on entities: the entities that pose them, when their transforms are read, and the pose of each tick.

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

/// When an entity's `Transform` is written. It decides which pose a tick sees.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Default, Clone, Debug, PartialEq, Hash)]
pub enum PoseTiming {
    /// Once a frame, in `Update` or by Bevy's `AnimationPlugin` in `PostUpdate`.
    ///
    /// A tick sees a pose between the last two that were drawn, interpolated at the tick's fraction of the current
    /// frame. This pose lags by one frame, and moves evenly at any frame rate.
    #[default]
    EachFrame,
    /// Once a tick, in the fixed loop before [`ClamberSystems::Pose`](crate::ClamberSystems::Pose).
    ///
    /// A tick sees the `Transform` of that moment, without lag.
    EachTick,
}
