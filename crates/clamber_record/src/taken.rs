use std::fmt;

use foxglove::messages::Log;

use crate::views::TakenScenery;

/// The copy of a tick that is made on the game's thread. The recorder's thread makes the recording from it later.
#[derive(Debug)]
pub(crate) struct Taken<D> {
    pub(crate) tick: u64,
    /// Data of a recording of this kind.
    pub(crate) data: D,
    /// True if transforms are due in this tick.
    pub(crate) is_due: bool,
    /// Log lines, without their times.
    pub(crate) lines: Vec<Log>,
    /// Meshes that are new, or whose places are due.
    pub(crate) scenery: Vec<TakenScenery>,
    /// States after this tick, from which a replay can start.
    pub(crate) saved: Vec<TakenState>,
    /// Number of ticks left out before this one.
    pub(crate) gap: u64,
}

/// Function that makes the bytes of a saved state, or says why it cannot.
pub(crate) struct TakenState(pub(crate) Box<dyn FnOnce() -> Result<Vec<u8>, String> + Send>);

impl fmt::Debug for TakenState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("TakenState")
    }
}

impl<D> Taken<D> {
    pub(crate) fn new(tick: u64, data: D, is_due: bool) -> Self {
        Self {
            tick,
            data,
            is_due,
            lines: Vec::new(),
            scenery: Vec::new(),
            saved: Vec::new(),
            gap: 0,
        }
    }

    /// True if a replay can start from this tick.
    pub(crate) fn is_saved(&self) -> bool {
        !self.saved.is_empty()
    }
}
