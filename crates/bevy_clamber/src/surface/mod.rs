//! Surfaces on entities: the entities that pose them, when their transforms are read, and the pose of each tick.

mod clock;
mod drawn;
mod history;
mod origin;
mod plugin;
mod pose;
mod posed;
mod rig;

use bevy_reflect::prelude::*;

pub(crate) use clock::FrameClock;
pub use drawn::DrawnSurface;
pub use origin::WorldOrigin;
pub use plugin::SurfacePlugin;
pub use posed::PoseError;
pub use posed::PosedSurface;
pub(crate) use rig::{Hierarchy, Rig, Scene};

/// When an entity's `Transform` is written. It decides which pose a tick sees.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Default, Clone, Debug, PartialEq, Hash)]
pub enum PoseTiming {
    /// Once a frame, in `Update` or by Bevy's `AnimationPlugin` in `PostUpdate`.
    ///
    /// A tick sees a pose between two that were drawn, of a time that lags by a little more than a frame. So the skin
    /// moves evenly, however unevenly frames come. Where a frame takes much longer than those before it, the skin
    /// stands still in that frame's ticks and is then moved on, which is no motion: nobody on it feels it.
    #[default]
    EachFrame,
    /// Once a tick, in the fixed loop before [`ClamberSystems::Pose`](crate::ClamberSystems::Pose).
    ///
    /// A tick sees the `Transform` of that moment, without lag.
    EachTick,
}
