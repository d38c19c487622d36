use bevy_ecs::prelude::*;
use bevy_time::{Fixed, Time, Virtual};
use clamber_surface::rig::{PoseClock, PoseMotion};

/// The time whose poses a tick sees, of those that frames have drawn.
///
/// A tick in frame n runs before frame n is drawn, so it has to look back: by the length of the current frame at least.
#[derive(Resource, Debug, Default)]
pub(crate) struct FrameClock(PoseClock);

impl FrameClock {
    /// Time of the last frame whose poses are recorded, seconds.
    pub(crate) fn drawn(&self) -> f64 {
        self.0.newest().unwrap_or(0.0)
    }

    /// The time whose poses this tick sees, seconds.
    pub(crate) fn at(&self) -> f64 {
        self.0.time()
    }

    /// True if that is not one tick later than the time which the last tick saw.
    pub(crate) fn jumped(&self) -> bool {
        self.0.motion() == PoseMotion::Teleported
    }
}

/// Runs in the fixed loop, before surfaces are posed.
pub(crate) fn tell_tick(
    mut clock: ResMut<FrameClock>,
    fixed: Res<Time<Fixed>>,
    frame: Res<Time<Virtual>>,
    tick: Res<Time>,
) {
    // The time from this tick to the end of the frame is right even if the fixed clock has discarded time.
    let now = frame.elapsed().saturating_sub(fixed.overstep());
    // Both times are seconds of a `Duration`, which are never refused.
    clock.0.tick(now.as_secs_f64(), tick.delta_secs_f64()).ok();
}

/// Runs at the end of a frame, before its poses are recorded.
pub(crate) fn tell_frame(mut clock: ResMut<FrameClock>, frame: Res<Time<Virtual>>) {
    let now = frame.elapsed_secs_f64();
    if clock.0.record(now).is_err() {
        // The app has set the clock back.
        clock.0.restart(now).ok();
    }
}
