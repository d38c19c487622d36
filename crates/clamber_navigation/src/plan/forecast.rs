//! What the creature is expected to do.

use crate::ClimbGraph;
use crate::clips::{Moment, SLICE};

/// What the creature is expected to do from the beginning of a plan on: clips, one after the other, and all of them
/// again and again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Forecast {
    /// Numbers of slices of clips.
    slices: Vec<u32>,
}

/// A clip is expected for no longer than this, seconds.
const LONGEST: f64 = 3600.0;

impl Forecast {
    /// It keeps still.
    pub fn still() -> Self {
        Self::default()
    }

    /// True if it keeps still.
    pub fn is_still(&self) -> bool {
        self.slices.is_empty()
    }

    /// And then it plays a clip, from a time of it on and for so long, both in seconds and rounded to halves of one; an
    /// hour at most. The clip is looped, with its length rounded up to half seconds. A clip that the graph does not
    /// know, and a time that is not positive, change nothing. A forecast is of use on its own graph only: another one
    /// takes it for something else.
    #[must_use]
    pub fn then(mut self, graph: &ClimbGraph, clip: &str, from: f64, seconds: f64) -> Self {
        let in_slices = |seconds: f64| (seconds.min(LONGEST) / SLICE).round() as usize;
        if let Some(clip) = graph.clips.find(clip)
            && (0.0..f64::INFINITY).contains(&from)
            && seconds > 0.0
        {
            let from = from % graph.clips.seconds(clip);
            let first = in_slices(from);
            let slices = first..first + in_slices(seconds).max(1);
            let slices = slices.filter_map(|slice| graph.clips.slice(clip, slice));
            self.slices.extend(slices.map(|slice| slice as u32));
        }
        self
    }

    /// Number of slices after which it begins again.
    pub(super) fn len(&self) -> usize {
        self.slices.len()
    }

    /// What happens at a patch after so many slices.
    pub(super) fn at(&self, graph: &ClimbGraph, slice: usize, patch: usize) -> Moment {
        if self.slices.is_empty() {
            return Moment {
                upright: graph.patches[patch].normal.dot(graph.config.climber.up()),
                ..Moment::default()
            };
        }
        let slice = self.slices[slice % self.slices.len()];
        graph.clips.at(slice as usize, patch)
    }
}
