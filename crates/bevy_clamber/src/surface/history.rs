//! The poses that the last frames drew.

use clamber_surface::rig::{Between, PoseHistory, PoseMotion, RigError};

use super::rig::Locals;

/// Poses as frames drew them, as far back as ticks look. Times are in seconds.
#[derive(Debug, Default)]
pub(crate) struct History {
    drawn: PoseHistory<Locals>,
    /// Counts poses.
    poses: u64,
    /// Stands for the last pose while there is no pose.
    nothing: Locals,
}

impl History {
    /// A buffer for the pose of the next frame.
    pub(crate) fn buffer(&mut self) -> Locals {
        self.drawn.buffer()
    }

    /// A frame has drawn the last pose once more.
    pub(crate) fn stay(&mut self, time: f64, same: Locals) {
        if self.drawn.is_empty() || self.is_before(time) {
            self.restart(time, same);
        } else {
            // Times of frames are finite.
            self.drawn.stay(time, same).ok();
        }
    }

    /// Adds the pose of a frame.
    pub(crate) fn record(&mut self, time: f64, locals: Locals, motion: PoseMotion) {
        if self.is_before(time) {
            self.restart(time, locals);
        } else {
            self.poses += 1;
            self.drawn.record(time, locals, motion).ok();
        }
    }

    /// Starts anew with one pose.
    pub(crate) fn restart(&mut self, time: f64, locals: Locals) {
        self.poses += 1;
        self.drawn.restart(time, locals).ok();
    }

    /// The pose of the last frame; an empty one before the first.
    pub(crate) fn last(&self) -> &Locals {
        let last = self.drawn.last();
        last.map_or(&self.nothing, |(locals, _)| locals)
    }

    /// Number of the last pose.
    pub(crate) fn poses(&self) -> u64 {
        self.poses
    }

    /// The pose of the last frame, and its time.
    pub(crate) fn last_timed(&self) -> Option<(&Locals, f64)> {
        self.drawn.last()
    }

    /// True if all poses that are kept are the same.
    pub(crate) fn is_still(&self) -> bool {
        self.drawn.len() == 1
    }

    /// Finds a time, and forgets what lies before it: later calls must not ask for earlier times.
    pub(crate) fn advance(&mut self, time: f64) -> Between {
        self.drawn.advance(time)
    }

    /// The joints' transforms at a time.
    pub(crate) fn joints(&self, at: Between, into: &mut Locals) -> Result<(), RigError> {
        match self.drawn.poses(at) {
            None => Ok(()),
            Some((from, None)) => into.copy_joints(from),
            Some((from, Some(to))) => into.blend_joints(from, to, at.fraction),
        }
    }

    /// The transforms above the joints at a time.
    pub(crate) fn root(&self, at: Between, into: &mut Locals) -> Result<(), RigError> {
        match self.drawn.poses(at) {
            None => Ok(()),
            Some((from, None)) => into.copy_root(from),
            Some((from, Some(to))) => into.blend_root(from, to, at.fraction),
        }
    }

    /// True if the clock was set back since the last frame.
    fn is_before(&self, time: f64) -> bool {
        self.drawn.last().is_some_and(|(_, last)| time < last)
    }
}
