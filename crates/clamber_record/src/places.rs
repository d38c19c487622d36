//! Where the messages of a recording are.

use crate::RecordError;
use crate::source::Place;

/// The places of consecutive ticks, and of what was saved after some of them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Places {
    first: u64,
    ticks: Vec<Place>,
    /// Ascending ticks.
    saved: Vec<(u64, Place)>,
}

impl Places {
    /// Adds the tick that follows the last one.
    pub(crate) fn add_tick(&mut self, tick: u64, place: Place) -> Result<(), RecordError> {
        if self.ticks.is_empty() {
            self.first = tick;
        }
        if self.first.checked_add(self.ticks.len() as u64) != Some(tick) {
            return Err(self.order(tick));
        }
        self.ticks.push(place);
        Ok(())
    }

    /// Adds what was saved after the last tick.
    pub(crate) fn add_saved(&mut self, tick: u64, place: Place) -> Result<(), RecordError> {
        if self.last() != Some(tick) {
            return Err(self.order(tick));
        }
        self.saved.push((tick, place));
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
        (!self.ticks.is_empty()).then_some(self.first)
    }

    pub(crate) fn last(&self) -> Option<u64> {
        Some(self.first()? + (self.ticks.len() as u64 - 1))
    }

    /// The place of a tick.
    pub(crate) fn tick(&self, tick: u64) -> Result<&Place, RecordError> {
        let index = tick.checked_sub(self.first).map(usize::try_from);
        let place = index.and_then(|index| self.ticks.get(index.ok()?));
        let ticks = self.first().zip(self.last());
        place.ok_or(RecordError::NoTick { asked: tick, ticks })
    }

    /// The places of the ticks from one on.
    pub(crate) fn from(&self, tick: u64) -> impl Iterator<Item = &Place> {
        let skipped = tick.saturating_sub(self.first);
        let skipped = usize::try_from(skipped).unwrap_or(usize::MAX);
        self.ticks.iter().skip(skipped)
    }

    /// The last tick at or before one after which something was saved, and the place of that.
    pub(crate) fn saved(&self, tick: u64) -> Result<(u64, &Place), RecordError> {
        self.tick(tick)?;
        let after = self.saved.partition_point(|(at, _)| *at <= tick);
        let nearest = after.checked_sub(1).map(|index| &self.saved[index]);
        let (at, place) = nearest.ok_or(RecordError::NoSnapshot(tick))?;
        Ok((*at, place))
    }
}
