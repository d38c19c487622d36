//! The places of a recording's messages in its file.

use std::ops::RangeInclusive;

use crate::RecordError;
use crate::source::Place;

/// The places of ticks, and of the states that were saved after some of them.
///
/// Tick numbers are consecutive except at gaps, where the recorder left ticks out. The first tick after a gap must have
/// a saved state before another tick is added.
#[derive(Clone, Debug, Default)]
pub(crate) struct Places {
    /// Runs of ticks without gaps: the number of the first tick, and its index in `ticks`.
    runs: Vec<(u64, usize)>,
    ticks: Vec<Place>,
    /// Ticks with a saved state, ascending, and the places of the states.
    saved: Vec<(u64, Place)>,
}

impl Places {
    /// Adds a tick. Its number must be one more than the last one's, or larger after a gap.
    pub(crate) fn add_tick(&mut self, tick: u64, place: Place) -> Result<(), RecordError> {
        let last = self.last();
        let follows = last.is_some_and(|last| last.checked_add(1) == Some(tick));
        if self.lacks_saved() || (!follows && last >= Some(tick)) {
            return Err(self.order(tick));
        }
        if !follows {
            self.runs.push((tick, self.ticks.len()));
        }
        self.ticks.push(place);
        Ok(())
    }

    /// True if the last run begins after a gap and has no saved state.
    fn lacks_saved(&self) -> bool {
        let saved = self.saved.last().map(|(saved, _)| saved);
        self.runs.len() > 1 && saved < self.runs.last().map(|(first, _)| first)
    }

    /// Adds a state that was saved after the last tick.
    pub(crate) fn add_saved(&mut self, tick: u64, place: Place) -> Result<(), RecordError> {
        if self.last() != Some(tick) {
            return Err(self.order(tick));
        }
        // If a tick has several saved states, the last one counts.
        match self.saved.last_mut().filter(|(last, _)| *last == tick) {
            Some(last) => last.1 = place,
            None => self.saved.push((tick, place)),
        }
        Ok(())
    }

    fn order(&self, found: u64) -> RecordError {
        let last = self.last().unwrap_or_default();
        RecordError::Order { last, found }
    }

    pub(crate) fn len(&self) -> usize {
        self.ticks.len()
    }

    pub(crate) fn first(&self) -> Option<u64> {
        self.runs.first().map(|(first, _)| *first)
    }

    pub(crate) fn last(&self) -> Option<u64> {
        let (first, index) = self.runs.last()?;
        Some(first + ((self.ticks.len() - index) as u64 - 1))
    }

    /// The ranges of recorded ticks. There is a gap between each two of them.
    pub(crate) fn runs(&self) -> impl Iterator<Item = RangeInclusive<u64>> + '_ {
        let ends = self.runs.iter().skip(1).map(|(_, index)| *index);
        let ends = ends.chain([self.ticks.len()]);
        self.runs.iter().zip(ends).map(|((first, index), end)| {
            let last = first + ((end - index) as u64 - 1);
            *first..=last
        })
    }

    /// Index of the first tick that is not before `tick`; the number of ticks if all are before it.
    fn index_from(&self, tick: u64) -> usize {
        let after = self.runs.partition_point(|(first, _)| *first <= tick);
        let end = self.runs.get(after).map_or(self.ticks.len(), |run| run.1);
        let Some((first, index)) = after.checked_sub(1).map(|run| self.runs[run]) else {
            return 0;
        };
        let offset = usize::try_from(tick - first).unwrap_or(usize::MAX);
        index.saturating_add(offset).min(end)
    }

    /// The place of a tick.
    pub(crate) fn tick(&self, tick: u64) -> Result<&Place, RecordError> {
        let index = self.index_from(tick);
        // The run that contains `index`. If `tick` is in a gap, `index` is the first tick after the gap.
        let run = self.runs.partition_point(|(_, first)| *first <= index);
        let number = run.checked_sub(1).map(|run| self.runs[run]);
        let number = number.map(|(first, at)| first + (index - at) as u64);
        let is_there = number == Some(tick);
        let place = self.ticks.get(index);
        let ticks = self.first().zip(self.last());
        let none = RecordError::NoTick { asked: tick, ticks };
        place.filter(|_| is_there).ok_or(none)
    }

    /// The places of the ticks from `tick` on.
    pub(crate) fn from(&self, tick: u64) -> impl Iterator<Item = &Place> {
        self.ticks.iter().skip(self.index_from(tick))
    }

    /// The last tick at or before `tick` that has a saved state, and the place of that state.
    pub(crate) fn saved(&self, tick: u64) -> Result<(u64, &Place), RecordError> {
        self.tick(tick)?;
        let after = self.saved.partition_point(|(at, _)| *at <= tick);
        let nearest = after.checked_sub(1).map(|index| &self.saved[index]);
        let (at, place) = nearest.ok_or(RecordError::NoSnapshot(tick))?;
        Ok((*at, place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_with_gaps_are_found_by_their_numbers() {
        let place = |at: u32| Place {
            chunk: at,
            from: 0,
            to: 0,
        };
        let mut places = Places::default();
        let range = |places: &Places| (places.first(), places.last(), places.len());
        assert_eq!(range(&places), (None, None, 0));
        for tick in [5, 6, 7] {
            places.add_tick(tick, place(tick as u32)).unwrap();
        }
        // A lower number and a repeated one are refused.
        assert!(places.add_tick(7, place(0)).is_err() && places.add_tick(3, place(0)).is_err());
        places.add_tick(20, place(20)).unwrap();
        // After a gap, a second tick is refused until the first one has a saved state.
        assert!(places.add_tick(21, place(21)).is_err());
        assert!(places.add_tick(40, place(40)).is_err());
        for at in [118, 119, 120] {
            places.add_saved(20, place(at)).unwrap();
        }
        assert_eq!(places.saved.len(), 1);
        places.add_tick(21, place(21)).unwrap();
        let runs: Vec<_> = places.runs().collect();
        assert_eq!(runs, [5..=7, 20..=21]);
        assert_eq!(range(&places), (Some(5), Some(21), 5));
        for tick in [5, 6, 7, 20, 21] {
            assert_eq!(places.tick(tick).unwrap(), &place(tick as u32));
        }
        for tick in [0, 4, 8, 19, 22, u64::MAX] {
            assert!(places.tick(tick).is_err(), "{tick}");
        }
        let from = |tick: u64| places.from(tick).map(|one| one.chunk).collect::<Vec<_>>();
        assert_eq!(from(0), [5, 6, 7, 20, 21]);
        assert_eq!(from(7), [7, 20, 21]);
        assert_eq!(from(8), [20, 21]);
        assert_eq!((from(21), from(22)), (vec![21], vec![]));
        // The largest tick number.
        let mut last = Places::default();
        last.add_tick(u64::MAX, place(1)).unwrap();
        assert_eq!(last.last(), Some(u64::MAX));
        assert!(last.add_tick(0, place(2)).is_err() && last.tick(u64::MAX).is_ok());
        assert!(places.saved(7).is_err());
        assert_eq!(places.saved(21).unwrap(), (20, &place(120)));
    }
}
