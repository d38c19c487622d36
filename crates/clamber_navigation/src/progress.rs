//! Progress of a build.

use std::ops::ControlFlow;

use crate::NavigationError;

/// The stages of a build of a graph, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stage {
    /// Finds seats: places with room for the climber's ball.
    Seats,
    /// Measures how far hands have to reach.
    Arms,
    /// Plays the creature's clips, and measures how they move each patch.
    Clips,
    /// Plays jumps from one part of the creature to another.
    Jumps,
}

/// How far the build of a graph has come: its stage, how many steps of that stage are done, and how many there are. The
/// build passes it to the caller's function again and again. In each stage the steps are counted anew.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Progress {
    /// The stage that the build of the graph is in.
    pub stage: Stage,
    /// Number of steps that the build has done in `stage`. It begins at 0 again in each stage.
    pub done: usize,
    /// Number of all steps of the build in `stage`: those that are done and those that are left.
    pub of: usize,
}

/// A build reports its progress once in this many steps, so that the caller's function costs little. It can be
/// cancelled only then.
const STEPS_PER_REPORT: usize = 256;

/// Calls the caller's progress function, and cancels the build if it says so.
pub(crate) struct Tell<'a>(pub(crate) &'a mut dyn FnMut(Progress) -> ControlFlow<()>);

impl Tell<'_> {
    /// Reports one short step of many: only every [`STEPS_PER_REPORT`] steps.
    pub(crate) fn at(
        &mut self,
        stage: Stage,
        done: usize,
        of: usize,
    ) -> Result<(), NavigationError> {
        if done.is_multiple_of(STEPS_PER_REPORT) {
            return self.now(stage, done, of);
        }
        Ok(())
    }

    /// Reports one long step.
    pub(crate) fn now(
        &mut self,
        stage: Stage,
        done: usize,
        of: usize,
    ) -> Result<(), NavigationError> {
        if (self.0)(Progress { stage, done, of }).is_break() {
            return Err(NavigationError::Cancelled);
        }
        Ok(())
    }
}
