use bevy_ecs::prelude::*;

use super::rig::Hierarchy;
use super::{PoseClock, PosedSurface};

/// Once a tick.
pub(crate) fn pose_surfaces(
    clock: Res<PoseClock>,
    mut surfaces: Query<&mut PosedSurface>,
    hierarchy: Hierarchy<'_, '_>,
) {
    let fraction = clock.fraction();
    surfaces
        .par_iter_mut()
        .for_each(|mut surface| surface.pose(fraction, &hierarchy));
}

/// Once a frame.
pub(crate) fn sample_poses(mut surfaces: Query<&mut PosedSurface>, hierarchy: Hierarchy<'_, '_>) {
    surfaces
        .par_iter_mut()
        .for_each(|mut surface| surface.bypass_change_detection().sample(&hierarchy));
}
