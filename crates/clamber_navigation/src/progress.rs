//! How far long work has got.

use std::ops::ControlFlow;

use crate::NavigationError;

/// What a build does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stage {
    /// Looks for room for the climber's ball.
    Seats,
    /// Looks how far hands have to reach.
    Arms,
    /// Plays the clips.
    Clips,
    /// Plays jumps from one part to another.
    Jumps,
}

/// How far a build has got.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Progress {
    /// What it does.
    pub stage: Stage,
    /// How many steps of this stage it has done.
    pub done: usize,
    /// How many there are.
    pub of: usize,
}

/// After so many steps a build tells how far it has got.
const TELLS: usize = 256;

/// Tells the caller how far a build has got, and asks whether to go on.
pub(crate) struct Tell<'a>(pub(crate) &'a mut dyn FnMut(Progress) -> ControlFlow<()>);

impl Tell<'_> {
    /// One step of many: tells only now and then.
    pub(crate) fn at(
        &mut self,
        stage: Stage,
        done: usize,
        of: usize,
    ) -> Result<(), NavigationError> {
        if done.is_multiple_of(TELLS) {
            return self.now(stage, done, of);
        }
        Ok(())
    }

    /// A long step.
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
