use bevy_ecs::prelude::*;
use bevy_ecs::query::{ArchetypeQueryData, IterQueryData};
use bevy_time::Time;

use super::rig::{Hierarchy, Scene};
use super::{DrawnSurface, FrameClock, PosedSurface};
use crate::{SkinnedCollider, WorldOrigin};

/// Up to this number, one thread poses all surfaces sooner than other threads wake up.
const FEW: usize = 4;

/// Runs once a tick.
pub(crate) fn pose_surfaces(
    clock: Res<FrameClock>,
    tick: Res<Time>,
    origin: Res<WorldOrigin>,
    surfaces: Query<(&mut PosedSurface, &mut DrawnSurface, &SkinnedCollider)>,
    hierarchy: Hierarchy<'_, '_>,
) {
    let scene = Scene {
        hierarchy: &hierarchy,
        origin: origin.0,
    };
    let dt = tick.delta_secs_f64();
    each(surfaces, |(mut surface, mut drawn, timing)| {
        let posed = surface.bypass_change_detection();
        if posed.pose(drawn.bypass_change_detection(), timing, &scene, &clock, dt) {
            surface.set_changed();
        }
    });
}

/// Runs once a frame.
pub(crate) fn sample_poses(
    clock: Res<FrameClock>,
    origin: Res<WorldOrigin>,
    surfaces: Query<(&PosedSurface, &mut DrawnSurface, &SkinnedCollider)>,
    hierarchy: Hierarchy<'_, '_>,
) {
    let scene = Scene {
        hierarchy: &hierarchy,
        origin: origin.0,
    };
    let time = clock.drawn();
    each(surfaces, |(surface, mut drawn, timing)| {
        drawn
            .bypass_change_detection()
            .sample(surface, timing, &scene, time);
    });
}

/// Runs on all cores if there are more than [`FEW`] surfaces.
fn each<D: IterQueryData<ReadOnly: ArchetypeQueryData>>(
    mut surfaces: Query<D>,
    run: impl Fn(D::Item<'_, '_>) + Send + Sync + Clone,
) {
    if surfaces.iter().len() <= FEW {
        surfaces.iter_mut().for_each(run);
    } else {
        surfaces.par_iter_mut().for_each(run);
    }
}
