//! Where the messages of a recording are in its bytes.

use std::fs::File;
use std::io::Read;
use std::ops::Range;
use std::path::Path;

use prost::Message;

use crate::RecordError;

/// The largest file that is read, bytes: a recording is read into memory. Twenty minutes of a battle have some 600 MB.
const LARGEST: u64 = 1 << 30;

/// Reads a file that is not too large.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, RecordError> {
    let failed = |source| RecordError::Io {
        what: format!("cannot read {}", path.display()),
        source,
    };
    let file = File::open(path).map_err(failed)?;
    let mut bytes = Vec::new();
    // One byte more than allowed shows that a file is too long, whatever length the file system reports.
    let read = file.take(LARGEST + 1).read_to_end(&mut bytes);
    let read = read.map_err(failed)? as u64;
    if read > LARGEST {
        return Err(RecordError::TooLarge {
            bytes: read,
            limit: LARGEST,
        });
    }
    Ok(bytes)
}

/// Decodes the message at a place.
pub(crate) fn decode<M: Message + Default>(
    bytes: &[u8],
    place: &Range<usize>,
    topic: &'static str,
) -> Result<M, RecordError> {
    M::decode(&bytes[place.clone()]).map_err(|error| RecordError::Message {
        at: place.start,
        topic,
        reason: error.to_string(),
    })
}

/// The places of consecutive ticks, and of what was saved after some of them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Places {
    first: u64,
    ticks: Vec<Range<usize>>,
    /// Ascending ticks.
    saved: Vec<(u64, Range<usize>)>,
}

impl Places {
    /// Adds the tick that follows the last one.
    pub(crate) fn add_tick(&mut self, tick: u64, place: Range<usize>) -> Result<(), RecordError> {
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
    pub(crate) fn add_saved(&mut self, tick: u64, place: Range<usize>) -> Result<(), RecordError> {
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
    pub(crate) fn tick(&self, tick: u64) -> Result<&Range<usize>, RecordError> {
        let index = tick.checked_sub(self.first).map(usize::try_from);
        let place = index.and_then(|index| self.ticks.get(index.ok()?));
        let ticks = self.first().zip(self.last());
        place.ok_or(RecordError::NoTick { asked: tick, ticks })
    }

    /// The places of the ticks from one on.
    pub(crate) fn from(&self, tick: u64) -> impl Iterator<Item = &Range<usize>> {
        let skipped = tick.saturating_sub(self.first);
        let skipped = usize::try_from(skipped).unwrap_or(usize::MAX);
        self.ticks.iter().skip(skipped)
    }

    /// The last tick at or before one after which something was saved, and the place of that.
    pub(crate) fn saved(&self, tick: u64) -> Result<(u64, &Range<usize>), RecordError> {
        self.tick(tick)?;
        let after = self.saved.partition_point(|(at, _)| *at <= tick);
        let nearest = after.checked_sub(1).map(|index| &self.saved[index]);
        let (at, place) = nearest.ok_or(RecordError::NoSnapshot(tick))?;
        Ok((*at, place))
    }
}
