use bevy_ecs::prelude::*;

use super::rig::Hierarchy;
use super::{PoseClock, PosedSurface};

/// Up to this number, one thread poses all surfaces sooner than other threads wake up.
const FEW: usize = 4;

/// Runs once a tick.
pub(crate) fn pose_surfaces(
    clock: Res<PoseClock>,
    surfaces: Query<&mut PosedSurface>,
    hierarchy: Hierarchy<'_, '_>,
) {
    let fraction = clock.fraction();
    each(surfaces, |mut surface| {
        let posed = surface.bypass_change_detection();
        if posed.pose(fraction, &hierarchy) {
            surface.set_changed();
        }
    });
}

/// Runs once a frame.
pub(crate) fn sample_poses(surfaces: Query<&mut PosedSurface>, hierarchy: Hierarchy<'_, '_>) {
    each(surfaces, |mut surface| {
        surface.bypass_change_detection().sample(&hierarchy);
    });
}

/// Runs on all cores if there are more than [`FEW`] surfaces.
fn each(
    mut surfaces: Query<&mut PosedSurface>,
    run: impl Fn(Mut<'_, PosedSurface>) + Send + Sync + Clone,
) {
    if surfaces.iter().len() <= FEW {
        surfaces.iter_mut().for_each(run);
    } else {
        surfaces.par_iter_mut().for_each(run);
    }
}
