use super::{PoseMotion, RigError};

/// Number of intervals between poses that decide the lag. An interval that is unusually long counts only if another one
/// of these is as long.
const INTERVALS: usize = 32;

/// Largest change of the lag in a tick, as a share of the tick. Motion appears faster or slower by the same share.
const DRIFT: f64 = 1.0 / 200.0;

/// Largest deviation of the seen time's step from the length of the tick, as a share of the tick. A larger one is a
/// jump.
const JUMP: f64 = 1.0 / 100.0;

/// Chooses the time whose pose a tick sees, for poses that come less often than ticks, or at other times.
///
/// A tick sees a time between two known poses, so the clock looks back by a lag. If poses come regularly, the lag is
/// one interval. Otherwise it is a little longer than the second longest of the last 32 intervals, since the longest
/// one may be a single pose that came late. The lag changes by at most 1/200 of a tick in each tick, unless it is more
/// than twice as long as it should be. If a tick would see a later time than the newest pose has, it sees the newest
/// pose, and is [`PoseMotion::Teleported`]. The first tick that is on time again is `Teleported` as well.
///
/// For poses of joints, [`PoseTrack`](super::PoseTrack) does all of this. A clock alone is for engines that have their
/// own poses, together with a [`PoseHistory`](super::PoseHistory). Times are in seconds, from any zero.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PoseClock {
    /// Time of the newest pose.
    newest: Option<f64>,
    /// Largest age of the newest pose in a tick so far, seconds.
    waited: f64,
    /// The last intervals between poses, seconds, as a ring.
    intervals: [f64; INTERVALS],
    /// Number of intervals so far.
    count: u64,
    lag: f64,
    /// The time whose pose the last tick saw.
    time: f64,
    has_jumped: bool,
    is_running: bool,
}

impl PoseClock {
    /// Records that a pose of this time has come. The pose may come late: an interval counts as at least as long as
    /// ticks have waited for it.
    ///
    /// # Errors
    /// [`RigError::NotFinite`] for a time that is infinite or NaN, [`RigError::TimeGoesBack`] for one before the newest
    /// pose. The clock is unchanged then.
    pub fn record(&mut self, time: f64) -> Result<(), RigError> {
        check_time("the pose's time", time, self.newest)?;
        if let Some(newest) = self.newest {
            let interval = (time - newest).max(self.waited);
            // While time stands still, no pose is later.
            if time > newest && interval.is_finite() {
                self.intervals[self.count as usize % INTERVALS] = interval;
                self.count = self.count.wrapping_add(1);
            }
        }
        if self.newest != Some(time) {
            self.waited = 0.0;
        }
        self.newest = Some(time);
        Ok(())
    }

    /// Forgets all poses, and starts anew with one of this time, which may be earlier. The lag stays.
    ///
    /// # Errors
    /// [`RigError::NotFinite`] for a time that is infinite or NaN. The clock is unchanged then.
    pub fn restart(&mut self, time: f64) -> Result<(), RigError> {
        check_time("the pose's time", time, None)?;
        self.newest = Some(time);
        self.waited = 0.0;
        self.is_running = false;
        Ok(())
    }

    /// Makes a tick of `dt` seconds that ends at `now`, and chooses the time whose pose it sees: [`PoseClock::time`].
    /// Returns [`PoseMotion::Teleported`] if this time is not `dt` later than in the last tick, in the first tick, and
    /// before the first pose. A tick before the last one sees the same time as the last one.
    ///
    /// # Errors
    /// [`RigError::NotFinite`] for a number that is infinite or NaN, [`RigError::TimeGoesBack`] for a negative `dt`.
    /// The clock is unchanged then.
    pub fn tick(&mut self, now: f64, dt: f64) -> Result<PoseMotion, RigError> {
        check_time("the tick's time", now, None)?;
        check_time("the tick's end", now, Some(now - dt))?;
        let Some(newest) = self.newest else {
            self.has_jumped = true;
            return Ok(PoseMotion::Teleported);
        };
        self.waited = self.waited.max(now - newest);
        let wanted = self.wanted_lag();
        let drift = dt * DRIFT;
        let is_far_off = self.lag > wanted * 2.0;
        self.lag = if self.has_jumped || is_far_off || !self.is_running {
            wanted
        } else {
            wanted.max(self.lag - drift).min(self.lag + drift)
        };
        let time = (now - self.lag).min(newest);
        if self.is_running {
            let before = self.time;
            self.time = time.max(before);
            self.has_jumped = (self.time - before - dt).abs() > dt * JUMP;
        } else {
            self.time = time;
            self.has_jumped = true;
        }
        self.is_running = true;
        Ok(self.motion())
    }

    /// The time whose pose the last tick saw; 0 before the first.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The result of the last [`PoseClock::tick`].
    pub fn motion(&self) -> PoseMotion {
        if self.has_jumped {
            PoseMotion::Teleported
        } else {
            PoseMotion::Moved
        }
    }

    /// Time of the newest pose; `None` before the first.
    pub fn newest(&self) -> Option<f64> {
        self.newest
    }

    /// The lag, seconds: how much earlier than the tick's end the seen time is, unless the newest pose is older than
    /// that.
    pub fn lag(&self) -> f64 {
        self.lag
    }

    /// True if no number is infinite or NaN.
    #[cfg(feature = "serde")]
    pub(super) fn is_finite(&self) -> bool {
        let numbers = [self.newest.unwrap_or(0.0), self.waited, self.lag, self.time];
        numbers.iter().chain(&self.intervals).all(|n| n.is_finite())
    }

    /// The lag that suits the last intervals.
    fn wanted_lag(&self) -> f64 {
        let known = (self.count as usize).min(INTERVALS);
        let mut last = self.intervals.iter().copied().take(known);
        let Some(first) = last.next() else {
            return 0.0;
        };
        // The second longest interval; the only one, if there are no others.
        let (mut shortest, mut longest, mut second) = (first, first, 0.0f64);
        for interval in last {
            shortest = shortest.min(interval);
            second = second.max(interval.min(longest));
            longest = longest.max(interval);
        }
        let long = second.max(shortest);
        long + ((long - shortest) / 2.0).min(long / 4.0)
    }
}

/// Rejects times that are not finite, or before the last one.
pub(super) fn check_time(what: &'static str, time: f64, last: Option<f64>) -> Result<(), RigError> {
    if !time.is_finite() || last.is_some_and(|last| !last.is_finite()) {
        return Err(RigError::NotFinite { what: what.into() });
    }
    match last {
        Some(last) if time < last => Err(RigError::TimeGoesBack { what, time, last }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests;
