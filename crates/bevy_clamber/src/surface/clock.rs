use std::collections::VecDeque;
use std::time::Duration;

use bevy_ecs::prelude::*;
use bevy_time::{Fixed, Time, Virtual};

/// Number of frames whose lengths decide the lag.
const FRAMES: usize = 32;

/// Largest change of the lag in a tick, as a share of the tick. Motion is seen faster or slower by as much.
const DRIFT: u32 = 200;

/// A tick whose pose is this much later than the last one's, as a share of the tick, too much or too little, is a jump.
const JUMP: u32 = 100;

/// The time whose poses a tick sees, of those that frames have drawn.
///
/// A tick in frame n runs before frame n is drawn, so it has to look back: by the length of the current frame at least.
/// Frames differ in length, so the lag is a little longer than all recent frames but the longest, which may be a
/// hitch. It changes slowly, unless it is more than twice as long as it should be. Where the time that is asked for has
/// not been drawn yet, the last pose stays, and the tick is a jump: so is the next that is on time again.
#[derive(Resource, Debug, Default)]
pub(crate) struct PoseClock {
    /// Time of the last frame whose poses are recorded.
    drawn: Duration,
    /// Lengths of the last frames.
    lengths: VecDeque<Duration>,
    lag: Duration,
    /// The time whose poses this tick sees.
    at: Duration,
    jumped: bool,
    is_running: bool,
}

impl PoseClock {
    /// Time of the last frame whose poses are recorded.
    pub(crate) fn drawn(&self) -> Duration {
        self.drawn
    }

    /// The time whose poses this tick sees.
    pub(crate) fn at(&self) -> Duration {
        self.at
    }

    /// True if that is not one tick later than the time which the last tick saw.
    pub(crate) fn jumped(&self) -> bool {
        self.jumped
    }

    /// The lag that suits the last frames.
    fn wanted_lag(&self) -> Duration {
        let Some(first) = self.lengths.front().copied() else {
            return Duration::ZERO;
        };
        // The longest but one; the only one, if there are no others.
        let (mut shortest, mut longest, mut second) = (first, first, Duration::ZERO);
        for length in self.lengths.iter().skip(1).copied() {
            shortest = shortest.min(length);
            second = second.max(length.min(longest));
            longest = longest.max(length);
        }
        let long = second.max(shortest);
        long + ((long - shortest) / 2).min(long / 4)
    }

    fn tick(&mut self, now: Duration, dt: Duration) {
        let wanted = self.wanted_lag();
        let drift = dt / DRIFT;
        let is_far_off = self.lag > wanted * 2;
        self.lag = if self.jumped || is_far_off || !self.is_running {
            wanted
        } else {
            wanted.clamp(self.lag.saturating_sub(drift), self.lag + drift)
        };
        let before = self.at;
        let at = now.saturating_sub(self.lag).min(self.drawn);
        self.at = at.max(before);
        self.jumped = !self.is_running || (self.at - before).abs_diff(dt) > dt / JUMP;
        self.is_running = true;
    }

    fn frame(&mut self, now: Duration) {
        let length = now.saturating_sub(self.drawn);
        if !length.is_zero() {
            self.lengths.truncate(FRAMES - 1);
            self.lengths.push_front(length);
        }
        self.drawn = now;
    }
}

/// Runs in the fixed loop, before surfaces are posed.
pub(crate) fn tell_tick(
    mut clock: ResMut<PoseClock>,
    fixed: Res<Time<Fixed>>,
    frame: Res<Time<Virtual>>,
    tick: Res<Time>,
) {
    // The time from this tick to the end of the frame is right even if the fixed clock has discarded time.
    let now = frame.elapsed().saturating_sub(fixed.overstep());
    clock.tick(now, tick.delta());
}

/// Runs at the end of a frame, before its poses are recorded.
pub(crate) fn tell_frame(mut clock: ResMut<PoseClock>, frame: Res<Time<Virtual>>) {
    clock.frame(frame.elapsed());
}

#[cfg(test)]
mod tests {
    use super::*;

    const TICK: Duration = Duration::from_micros(15_625);

    /// Runs frames of these lengths, in milliseconds; gives, per tick, how much later its pose is than the last one's,
    /// in ticks, and whether it is a jump.
    fn run(frames: impl IntoIterator<Item = f64>) -> Vec<(f64, bool)> {
        let mut clock = PoseClock::default();
        let (mut now, mut next) = (Duration::ZERO, TICK);
        let mut ticks = Vec::new();
        for length in frames {
            now += Duration::from_secs_f64(length / 1000.0);
            while next <= now {
                let before = clock.at();
                clock.tick(next, TICK);
                let moved = (clock.at() - before).as_secs_f64() / TICK.as_secs_f64();
                ticks.push((moved, clock.jumped()));
                next += TICK;
            }
            clock.frame(now);
        }
        ticks
    }

    fn random(count: usize, low: f64, high: f64) -> Vec<f64> {
        let mut random = fastrand::Rng::with_seed(7);
        let length = |_| low + (high - low) * random.f64();
        (0..count).map(length).collect()
    }

    #[test]
    fn with_jitter_time_passes_evenly_after_the_first_frames() {
        for (low, high) in [
            (15.7, 17.7),
            (10.0, 23.0),
            (3.0, 9.0),
            (30.0, 45.0),
            (16.0, 16.0),
        ] {
            let ticks = run(random(2000, low, high));
            let jumps = ticks[100..].iter().filter(|(_, jumped)| *jumped).count();
            assert_eq!(jumps, 0, "{low} to {high} ms");
            for (moved, _) in &ticks[100..] {
                assert!((moved - 1.0).abs() <= 0.01, "{low} to {high} ms: {moved}");
            }
        }
    }

    #[test]
    fn a_long_frame_is_jumped_and_does_not_change_the_lag() {
        for hitch in [50.0, 250.0, 2000.0] {
            let mut frames = random(400, 16.0, 17.0);
            frames[200] = hitch;
            let ticks = run(frames);
            let jumps = ticks[100..].iter().filter(|(_, jumped)| *jumped).count();
            // As many as there are ticks in the long frame, and the one that comes back.
            let most = hitch / 15.625 + 3.0;
            assert!(
                jumps > 0 && (jumps as f64) < most,
                "{hitch} ms: {jumps} jumps"
            );
            for (moved, jumped) in &ticks[100..] {
                assert!(
                    *jumped || (moved - 1.0).abs() <= 0.01,
                    "{hitch} ms: {moved}"
                );
            }
        }
    }

    #[test]
    fn longer_frames_are_followed() {
        let mut frames = random(100, 16.0, 17.0);
        frames.extend(random(300, 33.0, 34.0));
        frames.extend(random(300, 5.0, 6.0));
        let ticks = run(frames);
        let jumps = ticks[90..].iter().filter(|(_, jumped)| *jumped).count();
        assert!((2..8).contains(&jumps), "{jumps}");
    }
}
