//! What the creature is expected to do.

use crate::ClimbGraph;
use crate::clips::Moment;

/// What the creature is expected to do: clips, one after the other, and all of them again and again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Forecast {
    parts: Vec<Part>,
    seconds: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    clip: usize,
    from: f64,
    seconds: f64,
}

impl Forecast {
    /// It keeps still.
    pub fn still() -> Self {
        Self::default()
    }

    /// And then it plays a clip, from a time of it on and for so long, both in seconds. A clip that the graph does not know,
    /// and a time that is not positive, change nothing.
    #[must_use]
    pub fn then(mut self, graph: &ClimbGraph, clip: &str, from: f64, seconds: f64) -> Self {
        if let Some(clip) = graph.clips.find(clip)
            && from >= 0.0
            && seconds > 0.0
            && seconds.is_finite()
        {
            self.parts.push(Part {
                clip,
                from,
                seconds,
            });
            self.seconds += seconds;
        }
        self
    }

    /// What happens at a patch after so many seconds.
    pub(super) fn at(&self, graph: &ClimbGraph, seconds: f64, patch: usize) -> Moment {
        let mut left = if self.seconds > 0.0 {
            seconds.rem_euclid(self.seconds)
        } else {
            0.0
        };
        for part in &self.parts {
            if left < part.seconds {
                return graph.clips.at(part.clip, part.from + left, patch);
            }
            left -= part.seconds;
        }
        Moment {
            upright: graph.patches[patch].normal.dot(graph.config.climber.up()),
            ..Moment::default()
        }
    }
}
