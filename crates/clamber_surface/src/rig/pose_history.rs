use std::collections::VecDeque;

use super::pose_clock::check_time;
use super::{PoseMotion, RigError};

/// The most poses that are kept. More are needed only if poses come and no tick asks for them.
const MOST: usize = 128;

/// Poses with their times, the oldest first, as far back as ticks look. `P` is a pose of any kind.
///
/// [`PoseTrack`](super::PoseTrack) is one for poses of joints. A steady tick allocates nothing if the caller copies
/// poses into a [`PoseHistory::buffer`].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(deserialize = "P: serde::Deserialize<'de>"))
)]
pub struct PoseHistory<P> {
    samples: VecDeque<Sample<P>>,
    /// Kept to reuse their memory.
    #[cfg_attr(feature = "serde", serde(skip))]
    spare: Vec<P>,
}

#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Sample<P> {
    /// Time at which the creature reached this pose, seconds.
    from: f64,
    /// Time until which the creature stayed in this pose, seconds.
    until: f64,
    /// The motion from the pose before to this one.
    motion: PoseMotion,
    pose: P,
}

/// A time among the poses of a [`PoseHistory`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    /// Share of the way from the first pose to the second, 0 to 1.
    pub fraction: f64,
    /// [`PoseMotion::Teleported`] if the creature was teleported since the last time that was asked for.
    pub motion: PoseMotion,
}

impl<P> PoseHistory<P> {
    /// A history without poses.
    pub fn new() -> Self {
        Self {
            samples: VecDeque::new(),
            spare: Vec::new(),
        }
    }

    /// Adds a pose, and the creature's motion from the last pose to it. If the creature was teleported, the two poses
    /// are not blended. A pose of the same time as the last one replaces it.
    ///
    /// # Errors
    /// [`RigError::NotFinite`] for a time that is infinite or NaN, [`RigError::TimeGoesBack`] for one before the last
    /// pose. The history is unchanged then.
    pub fn record(&mut self, time: f64, pose: P, motion: PoseMotion) -> Result<(), RigError> {
        let last = self.samples.back_mut();
        check_time(
            "the pose's time",
            time,
            last.as_ref().map(|last| last.until),
        )?;
        if let Some(last) = last
            && last.from == time
        {
            let old = std::mem::replace(&mut last.pose, pose);
            if motion == PoseMotion::Teleported {
                last.motion = motion;
            }
            self.spare.push(old);
            return Ok(());
        }
        if self.samples.len() == MOST {
            self.drop_first();
        }
        self.samples.push_back(Sample {
            from: time,
            until: time,
            motion,
            pose,
        });
        Ok(())
    }

    /// Records that the creature has stayed in the last pose until this time. `same` is that pose, or the first one.
    ///
    /// # Errors
    /// As [`PoseHistory::record`].
    pub fn stay(&mut self, time: f64, same: P) -> Result<(), RigError> {
        let Some(last) = self.samples.back_mut() else {
            return self.record(time, same, PoseMotion::Moved);
        };
        check_time("the pose's time", time, Some(last.until))?;
        last.until = time;
        self.spare.push(same);
        Ok(())
    }

    /// Forgets all poses, and starts anew with one, whose time may be earlier.
    ///
    /// # Errors
    /// [`RigError::NotFinite`] for a time that is infinite or NaN. The history is unchanged then.
    pub fn restart(&mut self, time: f64, pose: P) -> Result<(), RigError> {
        check_time("the pose's time", time, None)?;
        while !self.samples.is_empty() {
            self.drop_first();
        }
        self.record(time, pose, PoseMotion::Moved)
    }

    /// The last pose, and the time until which the creature stayed in it.
    pub fn last(&self) -> Option<(&P, f64)> {
        let last = self.samples.back()?;
        Some((&last.pose, last.until))
    }

    /// Number of poses that are kept: 1 if the creature stands still.
    pub fn len(&self) -> usize {
        self.samples.len()
    }

    /// True if no pose has been recorded.
    pub fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }

    /// Finds a time, and forgets the poses before it: later calls must not ask for earlier times. Before the first pose
    /// and after the last one, that pose stays.
    pub fn advance(&mut self, time: f64) -> Between {
        let mut motion = PoseMotion::Moved;
        while let Some(next) = self.samples.get(1)
            && next.from <= time
        {
            motion = motion.and(next.motion);
            self.drop_first();
        }
        let stays = Between {
            fraction: 0.0,
            motion,
        };
        let (Some(first), Some(next)) = (self.samples.front(), self.samples.get(1)) else {
            return stays;
        };
        if time <= first.until {
            return stays;
        }
        Between {
            fraction: match next.motion {
                PoseMotion::Moved => (time - first.until) / (next.from - first.until),
                // After the last pose before a teleport, the creature is where the teleport took it.
                PoseMotion::Teleported => 1.0,
            },
            motion: motion.and(next.motion),
        }
    }

    /// The two poses to blend at the time that [`PoseHistory::advance`] has found, or the one that counts alone; `None`
    /// before the first pose.
    pub fn poses(&self, at: Between) -> Option<(&P, Option<&P>)> {
        let pose = |index: usize| self.samples.get(index).map(|sample| &sample.pose);
        let first = pose(0)?;
        Some(match pose(1) {
            Some(next) if at.fraction >= 1.0 => (next, None),
            Some(next) if at.fraction > 0.0 => (first, Some(next)),
            _ => (first, None),
        })
    }

    /// Rejects times that are not finite, or not in order.
    #[cfg(feature = "serde")]
    pub(super) fn check_times(&self) -> Result<(), RigError> {
        let mut last = None;
        for time in self.samples.iter().flat_map(|s| [s.from, s.until]) {
            check_time("the stored pose's time", time, last)?;
            last = Some(time);
        }
        Ok(())
    }

    /// The poses that are kept, the oldest first.
    #[cfg(feature = "serde")]
    pub(super) fn iter(&self) -> impl Iterator<Item = &P> {
        self.samples.iter().map(|sample| &sample.pose)
    }

    fn drop_first(&mut self) {
        let dropped = self.samples.pop_front();
        self.spare.extend(dropped.map(|sample| sample.pose));
    }
}

impl<P: Default> PoseHistory<P> {
    /// A pose for [`PoseHistory::record`] and [`PoseHistory::stay`], to write over: one that is no longer needed, whose
    /// memory is reused, or a new one.
    pub fn buffer(&mut self) -> P {
        self.spare.pop().unwrap_or_default()
    }
}

impl<P> Default for PoseHistory<P> {
    fn default() -> Self {
        Self::new()
    }
}

/// Poses and their times are compared, memory that is kept to be reused is not.
impl<P: PartialEq> PartialEq for PoseHistory<P> {
    fn eq(&self, other: &Self) -> bool {
        self.samples == other.samples
    }
}

#[cfg(test)]
mod tests;
