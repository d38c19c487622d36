//! The kinds of recordings: one climber and its creature, or an arena.

use std::collections::BTreeMap;
use std::fmt;

use crate::RecordError;

/// The entries of a metadata record.
pub(crate) type Entries = BTreeMap<String, String>;

/// Marks a recording of one climber and its creature, in a scene that the game steps itself.
#[derive(Clone, Copy, Debug)]
pub enum OfClimber {}

/// Marks a recording of a whole arena of `clamber_fight`.
#[derive(Clone, Copy, Debug)]
pub enum OfArena {}

/// The kind of a recording: [`OfClimber`] or [`OfArena`]. Other crates cannot add kinds.
pub trait RecordingKind: Sealed {
    /// Metadata of the whole recording.
    type Info: Clone + fmt::Debug;
    /// Data of one recorded tick.
    type Tick;

    /// Copy of a tick's data on its way to the file.
    #[doc(hidden)]
    type Taken: Send + 'static;
    /// Data that the recorder keeps from tick to tick.
    #[doc(hidden)]
    type Memory;
    /// Names in the file.
    #[doc(hidden)]
    const TOPICS: Topics;

    /// Reads the metadata.
    #[doc(hidden)]
    fn info(metadata: &Entries, settings: Entries) -> Result<Self::Info, RecordError>;

    /// Decodes the message of a tick, and returns it with its number; `Err` says why it cannot be read.
    #[doc(hidden)]
    fn tick(message: &[u8]) -> Result<(u64, Self::Tick), String>;
}

/// The names by which the file of a recording tells its kind, and the topics that are read back.
#[derive(Clone, Copy, Debug)]
pub struct Topics {
    /// Name of the metadata record.
    pub(crate) metadata: &'static str,
    /// Advice in the error for a recording of this kind that was opened as the other kind.
    pub(crate) read_with: &'static str,
    /// Index of the kind: 0 for a climber, 1 for an arena.
    pub(crate) index: usize,
    /// Topic of the ticks.
    pub(crate) tick: &'static str,
    /// Topic of the saved states.
    pub(crate) saved: &'static str,
    /// True if the saved states are texts.
    pub(crate) is_text: bool,
}

/// Keeps other crates from implementing [`RecordingKind`].
pub trait Sealed {}

impl Sealed for OfClimber {}
impl Sealed for OfArena {}
