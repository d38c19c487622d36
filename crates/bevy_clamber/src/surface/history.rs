//! The poses that the last frames drew.

use std::collections::VecDeque;
use std::time::Duration;

use clamber_surface::rig::RigError;

use super::rig::Locals;

/// The most poses that are kept. More are needed only if ticks stop while frames go on.
const MOST: usize = 128;

/// Poses as frames drew them, the oldest first, as far back as ticks look.
#[derive(Debug, Default)]
pub(crate) struct History {
    samples: VecDeque<Sample>,
    /// Kept to reuse their memory.
    spare: Vec<Locals>,
    /// Counts poses.
    poses: u64,
    /// The last pose while there is none.
    nothing: Locals,
}

#[derive(Debug)]
struct Sample {
    /// The first frame that drew it.
    from: Duration,
    /// The last frame that drew it.
    until: Duration,
    /// The creature was teleported here: nothing lies between this pose and the one before.
    is_cut: bool,
    locals: Locals,
}

/// A time between two frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Between {
    /// How far it is on the way from the first pose to the second, 0 to 1.
    fraction: f64,
    /// The creature was teleported since the time that was asked for before.
    pub(crate) is_cut: bool,
}

impl History {
    /// A buffer for the pose of the next frame.
    pub(crate) fn buffer(&mut self) -> Locals {
        self.spare.pop().unwrap_or_default()
    }

    /// A frame has drawn the last pose once more.
    pub(crate) fn stay(&mut self, time: Duration, same: Locals) {
        match self.samples.back_mut() {
            Some(last) => {
                last.until = time;
                self.spare.push(same);
            }
            None => self.record(time, same, false),
        }
    }

    /// Adds the pose of a frame.
    pub(crate) fn record(&mut self, time: Duration, locals: Locals, is_cut: bool) {
        self.poses += 1;
        if let Some(last) = self.samples.back_mut()
            && last.from == time
        {
            // While time stands still, only the last pose counts.
            let old = std::mem::replace(&mut last.locals, locals);
            last.is_cut |= is_cut;
            self.spare.push(old);
            return;
        }
        if self.samples.len() == MOST {
            self.drop_first();
        }
        self.samples.push_back(Sample {
            from: time,
            until: time,
            is_cut,
            locals,
        });
    }

    /// Starts anew with one pose.
    pub(crate) fn restart(&mut self, time: Duration, locals: Locals) {
        while !self.samples.is_empty() {
            self.drop_first();
        }
        self.record(time, locals, false);
    }

    /// The pose of the last frame; an empty one before the first.
    pub(crate) fn last(&self) -> &Locals {
        let last = self.samples.back();
        last.map_or(&self.nothing, |sample| &sample.locals)
    }

    /// Number of the last pose.
    pub(crate) fn poses(&self) -> u64 {
        self.poses
    }

    /// The pose of the last frame, and its time.
    pub(crate) fn last_timed(&self) -> Option<(&Locals, Duration)> {
        let sample = self.samples.back()?;
        Some((&sample.locals, sample.until))
    }

    /// True if all poses that are kept are the same.
    pub(crate) fn is_still(&self) -> bool {
        self.samples.len() == 1
    }

    /// Finds a time, and forgets what lies before it: later calls must not ask for earlier times.
    pub(crate) fn advance(&mut self, time: Duration) -> Between {
        let mut is_cut = false;
        while let Some(next) = self.samples.get(1)
            && next.from <= time
        {
            is_cut |= next.is_cut;
            self.drop_first();
        }
        let (Some(first), Some(next)) = (self.samples.front(), self.samples.get(1)) else {
            return Between {
                fraction: 0.0,
                is_cut,
            };
        };
        if time <= first.until {
            return Between {
                fraction: 0.0,
                is_cut,
            };
        }
        // After the last frame before a teleport, the creature is where the teleport took it.
        let way = (next.from - first.until).as_secs_f64();
        let gone = (time - first.until).as_secs_f64();
        Between {
            fraction: if next.is_cut { 1.0 } else { gone / way },
            is_cut: is_cut || next.is_cut,
        }
    }

    /// The joints' transforms at a time.
    pub(crate) fn joints(&self, at: Between, into: &mut Locals) -> Result<(), RigError> {
        self.blend(at, |from, to| match to {
            None => into.copy_joints(from),
            Some(to) => into.blend_joints(from, to, at.fraction),
        })
    }

    /// The transforms above the joints at a time.
    pub(crate) fn root(&self, at: Between, into: &mut Locals) -> Result<(), RigError> {
        self.blend(at, |from, to| match to {
            None => into.copy_root(from),
            Some(to) => into.blend_root(from, to, at.fraction),
        })
    }

    /// Calls `with` with the poses to be blended, or with the one that counts alone.
    fn blend(
        &self,
        at: Between,
        with: impl FnOnce(&Locals, Option<&Locals>) -> Result<(), RigError>,
    ) -> Result<(), RigError> {
        let sample = |index: usize| self.samples.get(index).map(|sample| &sample.locals);
        match (sample(0), sample(1)) {
            (Some(from), Some(to)) if at.fraction > 0.0 && at.fraction < 1.0 => {
                with(from, Some(to))
            }
            (Some(_), Some(to)) if at.fraction >= 1.0 => with(to, None),
            (Some(from), _) => with(from, None),
            (None, _) => Ok(()),
        }
    }

    fn drop_first(&mut self) {
        let dropped = self.samples.pop_front();
        self.spare.extend(dropped.map(|sample| sample.locals));
    }
}
