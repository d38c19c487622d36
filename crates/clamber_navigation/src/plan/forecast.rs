//! Forecasts of the clips that the creature plays.

use crate::ClimbGraph;
use crate::clips::{Moment, SLICE_SECONDS};
use crate::plan::search::slice_of;
use crate::plan::{slips, throws};

/// The clips that the creature is expected to play from the beginning of a plan on, one after the other. After the last
/// one they start over.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Forecast {
    /// The numbers of the clips' slices.
    slices: Vec<u32>,
}

/// The longest time for which one clip is added, seconds.
const LONGEST_CLIP_TIME: f64 = 3600.0;

/// The most slices of a forecast: four hours. It limits the memory and the length of searches.
const MOST_SLICES: usize = 28_800;

/// Number of slices that a climber which wants to get on looks ahead: a minute.
const SLICES_AHEAD: usize = 120;

/// Number of slices that getting on takes.
const GETS_ON: usize = 3;

impl Forecast {
    /// The forecast of a creature that keeps still all the time, in pose and place: it has no clips.
    pub fn still() -> Self {
        Self::default()
    }

    /// True if the forecast has no clips, so that the creature counts as still, in pose and place, all the time.
    pub fn is_still(&self) -> bool {
        self.slices.is_empty()
    }

    /// Appends a clip, looped. `from` is where in the clip it begins, in seconds of the file; beyond the clip's end it
    /// wraps round. `seconds` is for how long it plays, in seconds of the world; more than an hour counts as an hour.
    /// Both become whole half seconds of the world, the nearest, and at least one for `seconds`; the clip's length is
    /// rounded up to half seconds. What goes beyond four hours in all is dropped. A clip that the graph does not know,
    /// a negative `from` and `seconds` that are not positive change nothing. A forecast is valid only for its own
    /// graph: another graph reads other clips from it.
    #[must_use]
    pub fn then(mut self, graph: &ClimbGraph, clip: &str, from: f64, seconds: f64) -> Self {
        let in_slices =
            |seconds: f64| (seconds.min(LONGEST_CLIP_TIME) / SLICE_SECONDS).round() as usize;
        if let Some(clip) = graph.clips.find(clip)
            && (0.0..f64::INFINITY).contains(&from)
            && seconds > 0.0
        {
            // Clips pass at the graph's rate, so seconds of the file are scaled.
            let from = from / graph.config.clip_rate % graph.clips.seconds(clip);
            let first = (from / SLICE_SECONDS).round() as usize;
            let slices = first..first + in_slices(seconds).max(1);
            let slices = slices.filter_map(|slice| graph.clips.slice(clip, slice));
            let room = MOST_SLICES.saturating_sub(self.slices.len());
            self.slices
                .extend(slices.take(room).map(|slice| slice as u32));
        }
        self
    }

    /// True if a climber that stands or holds on at a patch for the next `seconds` feels no shake that costs stamina,
    /// is not thrown, and does not slip.
    pub(crate) fn is_calm_at(&self, graph: &ClimbGraph, patch: usize, seconds: f64) -> bool {
        let climber = &graph.config.climber;
        let slices = ((seconds / SLICE_SECONDS).ceil() as usize).clamp(1, self.len().max(1));
        let is_calm = |slice: usize| {
            let moment = self.at(graph, slice, patch);
            moment.excess == 0.0 && !throws(climber, &moment) && !slips(climber, &moment)
        };
        self.is_still() || (0..slices).all(is_calm)
    }

    /// The wait, from a time on, until a patch shakes no harder than `most` metres per second squared for as long as
    /// getting on takes, seconds. If the patch does not calm down, the length of the forecast, at most a minute.
    pub(crate) fn calms_after(
        &self,
        graph: &ClimbGraph,
        patch: usize,
        from: f64,
        most: f64,
    ) -> f64 {
        let longest = self.len().min(SLICES_AHEAD);
        let is_calm = |waits: &usize| {
            let from = from + *waits as f64 * SLICE_SECONDS;
            self.is_calm_from(graph, patch, from, most)
        };
        (0..longest).find(is_calm).unwrap_or(longest) as f64 * SLICE_SECONDS
    }

    /// True if from a time on a patch shakes no harder than `most` metres per second squared for as long as getting on
    /// takes.
    pub(crate) fn is_calm_from(
        &self,
        graph: &ClimbGraph,
        patch: usize,
        from: f64,
        most: f64,
    ) -> bool {
        let first = (from / SLICE_SECONDS) as usize;
        let mut while_on = first..first + GETS_ON;
        while_on.all(|slice| self.at(graph, slice, patch).shake <= most)
    }

    /// The period after which the forecast repeats, seconds.
    ///
    /// The period of a sequence is its length less its longest border (Knuth, Morris and Pratt 1977). It counts only if
    /// it divides the length, because the forecast starts over at its end.
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
        (if goes_round { period } else { slices.len() }) as f64 * SLICE_SECONDS
    }

    /// Number of slices after which the forecast starts over.
    pub(super) fn len(&self) -> usize {
        self.slices.len()
    }

    /// True if a jump that begins after some seconds is over before the clip that plays then, and lands in that clip
    /// whenever it begins. Always true on a creature that keeps still.
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

    /// True if a jump lands at some time of the forecast.
    pub(crate) fn ever_lands(&self, graph: &ClimbGraph, number: usize) -> bool {
        let mut slices = 0..self.slices.len().max(1);
        slices.any(|slice| self.lands(graph, number, slice as f64 * SLICE_SECONDS))
    }

    /// The shake and tilt at a patch in a slice of the forecast.
    pub(super) fn at(&self, graph: &ClimbGraph, slice: usize, patch: usize) -> Moment {
        if self.slices.is_empty() {
            return Moment {
                upright: graph.patches[patch].normal.dot(graph.config.climber.up()),
                ..Moment::default()
            };
        }
        // The remainder is computed only where it is needed, because divisions are slow.
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
