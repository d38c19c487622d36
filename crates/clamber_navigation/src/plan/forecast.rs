//! What the creature is expected to do.

use crate::ClimbGraph;
use crate::clips::{Moment, SLICE};
use crate::plan::search::slice_of;
use crate::plan::{slips, throws};

/// What the creature is expected to do from the beginning of a plan on: clips, one after the other, and all of them
/// again and again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Forecast {
    /// Numbers of slices of clips.
    slices: Vec<u32>,
}

/// A clip is expected for no longer than this, seconds.
const LONGEST: f64 = 3600.0;

/// All that is expected is no longer than this, slices: four hours.
const MOST: usize = 28_800;

/// Who means to get on looks so many slices ahead: a minute.
const AHEAD: usize = 120;

/// Getting on takes so many slices.
const GETS_ON: usize = 3;

impl Forecast {
    /// It keeps still.
    pub fn still() -> Self {
        Self::default()
    }

    /// True if it keeps still.
    pub fn is_still(&self) -> bool {
        self.slices.is_empty()
    }

    /// And then it plays a clip. `from` is where in the clip it begins, in seconds of the file; `seconds` is for how
    /// long it plays, in seconds of the world, an hour at most. Both are rounded to half seconds. The clip is looped,
    /// with its length rounded up to half seconds. A forecast ends after four hours. A clip that the graph does not
    /// know, a negative `from` and `seconds` that are not positive change nothing. A forecast is of use on its own
    /// graph only: another one takes it for something else.
    #[must_use]
    pub fn then(mut self, graph: &ClimbGraph, clip: &str, from: f64, seconds: f64) -> Self {
        let in_slices = |seconds: f64| (seconds.min(LONGEST) / SLICE).round() as usize;
        if let Some(clip) = graph.clips.find(clip)
            && (0.0..f64::INFINITY).contains(&from)
            && seconds > 0.0
        {
            // Times of the clip pass at its rate.
            let from = from / graph.clips.rate() % graph.clips.seconds(clip);
            let first = (from / SLICE).round() as usize;
            let slices = first..first + in_slices(seconds).max(1);
            let slices = slices.filter_map(|slice| graph.clips.slice(clip, slice));
            let room = MOST.saturating_sub(self.slices.len());
            self.slices
                .extend(slices.take(room).map(|slice| slice as u32));
        }
        self
    }

    /// True if a climber that stands on a patch in the next seconds, or holds on there, feels no shake that costs
    /// strength, is not thrown, and does not slip.
    pub(crate) fn is_calm_at(&self, graph: &ClimbGraph, patch: usize, seconds: f64) -> bool {
        let climber = &graph.config.climber;
        let slices = ((seconds / SLICE).ceil() as usize).clamp(1, self.len().max(1));
        let is_calm = |slice: usize| {
            let moment = self.at(graph, slice, patch);
            moment.excess == 0.0 && !throws(climber, &moment) && !slips(climber, &moment)
        };
        self.is_still() || (0..slices).all(is_calm)
    }

    /// After how many seconds from a time on a patch shakes no harder than `most` metres a second squared for as long
    /// as it takes to get on; the length of the forecast, a minute at most, if it does not until then.
    pub(crate) fn calms_after(
        &self,
        graph: &ClimbGraph,
        patch: usize,
        from: f64,
        most: f64,
    ) -> f64 {
        let longest = self.len().min(AHEAD);
        let is_calm = |waits: &usize| {
            let from = from + *waits as f64 * SLICE;
            self.is_calm_from(graph, patch, from, most)
        };
        (0..longest).find(is_calm).unwrap_or(longest) as f64 * SLICE
    }

    /// True if from a time on a patch shakes no harder than `most` metres a second squared for as long as it takes to
    /// get on.
    pub(crate) fn is_calm_from(
        &self,
        graph: &ClimbGraph,
        patch: usize,
        from: f64,
        most: f64,
    ) -> bool {
        let first = (from / SLICE) as usize;
        let mut while_on = first..first + GETS_ON;
        while_on.all(|slice| self.at(graph, slice, patch).shake <= most)
    }

    /// After how long all is expected again, seconds.
    ///
    /// The period of a text by its longest border (Knuth, Morris and Pratt 1977), where it divides the length: what is
    /// expected goes round.
    pub(crate) fn repeats_after(&self) -> f64 {
        let slices = &self.slices;
        let mut borders = vec![0; slices.len()];
        for at in 1..slices.len() {
            let mut border: usize = borders[at - 1];
            while border > 0 && slices[at] != slices[border] {
                border = borders[border - 1];
            }
            borders[at] = border + usize::from(slices[at] == slices[border]);
        }
        let period = slices.len() - borders.last().unwrap_or(&0);
        let goes_round = period > 0 && slices.len().is_multiple_of(period);
        (if goes_round { period } else { slices.len() }) as f64 * SLICE
    }

    /// Number of slices after which it begins again.
    pub(super) fn len(&self) -> usize {
        self.slices.len()
    }

    /// True if a jump that begins after some seconds is over before the clip is that plays then, and lands whenever it
    /// begins in that clip; always on a creature at rest.
    pub(crate) fn lands(&self, graph: &ClimbGraph, number: usize, seconds: f64) -> bool {
        let Some(leap) = graph.leaps.get(number) else {
            return false;
        };
        if self.is_still() {
            return true;
        }
        let at = |slice: usize| self.slices[slice % self.slices.len()] as usize;
        let (first, last) = (slice_of(seconds), slice_of(seconds + leap.seconds()));
        let clip = graph.clips.clip_of(at(first));
        graph.leaps.lands_in(number, clip)
            && (first..last).all(|slice| graph.clips.goes_on(at(slice), at(slice + 1)))
    }

    /// True if a jump lands at some time.
    pub(crate) fn ever_lands(&self, graph: &ClimbGraph, number: usize) -> bool {
        let mut slices = 0..self.slices.len().max(1);
        slices.any(|slice| self.lands(graph, number, slice as f64 * SLICE))
    }

    /// What happens at a patch after so many slices.
    pub(super) fn at(&self, graph: &ClimbGraph, slice: usize, patch: usize) -> Moment {
        if self.slices.is_empty() {
            return Moment {
                upright: graph.patches[patch].normal.dot(graph.config.climber.up()),
                ..Moment::default()
            };
        }
        // Divisions are slow.
        let slice = if slice < self.slices.len() {
            slice
        } else {
            slice % self.slices.len()
        };
        graph.clips.at(self.slices[slice] as usize, patch)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_forecast_repeats_after_its_shortest_period() {
        let cases: [(&[u32], f64); 6] = [
            (&[], 0.0),
            (&[3], 0.5),
            (&[3, 3, 3, 3], 0.5),
            (&[1, 2, 1, 2, 1, 2], 1.0),
            (&[1, 2, 1, 2, 1], 2.5),
            (&[1, 1, 2, 1, 1, 3], 3.0),
        ];
        for (slices, seconds) in cases {
            let forecast = Forecast {
                slices: slices.to_vec(),
            };
            assert_eq!(forecast.repeats_after(), seconds, "{slices:?}");
        }
    }
}
