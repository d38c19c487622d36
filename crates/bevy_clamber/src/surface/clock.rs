use std::time::Duration;

use bevy_ecs::prelude::*;
use bevy_time::{Fixed, Time, Virtual};

/// Time of the last frame, and the position of the current tick between it and this frame.
#[derive(Resource, Debug, Default)]
pub(crate) struct PoseClock {
    drawn: Duration,
    /// 0 at the last frame, 1 at this one.
    fraction: f64,
}

impl PoseClock {
    pub(crate) fn fraction(&self) -> f64 {
        self.fraction
    }
}

/// Runs in the fixed loop, before surfaces are posed.
pub(crate) fn tell_tick(
    mut clock: ResMut<PoseClock>,
    tick: Res<Time<Fixed>>,
    frame: Res<Time<Virtual>>,
) {
    let length = frame.elapsed().saturating_sub(clock.drawn).as_secs_f64();
    // The time from this tick to the end of the frame. It is right even if the fixed clock has discarded time.
    let left = tick.overstep().as_secs_f64();
    clock.fraction = if length > 0.0 {
        (1.0 - left / length).clamp(0.0, 1.0)
    } else {
        1.0
    };
}

/// Runs at the end of a frame, when its poses are recorded.
pub(crate) fn tell_frame(mut clock: ResMut<PoseClock>, frame: Res<Time<Virtual>>) {
    clock.drawn = frame.elapsed();
}
