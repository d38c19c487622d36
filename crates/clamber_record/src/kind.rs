//! The kinds of recordings: one climber and its creature, or an arena.

use std::collections::BTreeMap;
use std::fmt;

use crate::arena::{ArenaInfo, ArenaMemory, RecordedArenaTick, TakenArena};
use crate::chunks::TakenTick;
use crate::recorder::ClimberMemory;
use crate::taken::Taken;
use crate::{RecordError, RecordedTick, RecordingInfo, topics};

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

    /// Name of the metadata record of this kind.
    #[doc(hidden)]
    const METADATA: &'static str;
    /// Advice in the error for a recording of this kind that was opened as the other kind.
    #[doc(hidden)]
    const READ_WITH: &'static str;
    /// Topic of the ticks.
    #[doc(hidden)]
    const TOPIC: &'static str;
    /// True for recordings of an arena.
    #[doc(hidden)]
    const IS_ARENA: bool;
    /// Copy of a tick on its way to the file.
    #[doc(hidden)]
    type Taken: TakenTick;
    /// Data that the recorder keeps from tick to tick.
    #[doc(hidden)]
    type Memory;

    #[doc(hidden)]
    fn info(
        metadata: &BTreeMap<String, String>,
        settings: BTreeMap<String, String>,
    ) -> Result<Self::Info, RecordError>;

    /// Decodes the message of a tick; `Err` says why it cannot be read.
    #[doc(hidden)]
    fn tick(message: &[u8]) -> Result<Self::Tick, String>;
}

/// Keeps other crates from implementing [`RecordingKind`].
pub trait Sealed {}

impl Sealed for OfClimber {}
impl Sealed for OfArena {}

impl RecordingKind for OfClimber {
    type Info = RecordingInfo;
    type Tick = RecordedTick;

    const METADATA: &'static str = RecordingInfo::METADATA;
    const READ_WITH: &'static str = "it is a recording of one climber; read it with Recording";
    const TOPIC: &'static str = topics::TICK;
    const IS_ARENA: bool = false;
    type Taken = Taken;
    type Memory = ClimberMemory;

    fn info(
        metadata: &BTreeMap<String, String>,
        settings: BTreeMap<String, String>,
    ) -> Result<RecordingInfo, RecordError> {
        RecordingInfo::from_metadata(metadata, settings)
    }

    fn tick(message: &[u8]) -> Result<RecordedTick, String> {
        RecordedTick::decode(message)
    }
}

impl RecordingKind for OfArena {
    type Info = ArenaInfo;
    type Tick = RecordedArenaTick;

    const METADATA: &'static str = ArenaInfo::METADATA;
    const READ_WITH: &'static str = "it is a recording of an arena; read it with ArenaRecording";
    const TOPIC: &'static str = topics::ARENA;
    const IS_ARENA: bool = true;
    type Taken = TakenArena;
    type Memory = ArenaMemory;

    fn info(
        metadata: &BTreeMap<String, String>,
        settings: BTreeMap<String, String>,
    ) -> Result<ArenaInfo, RecordError> {
        ArenaInfo::from_metadata(metadata, settings)
    }

    fn tick(message: &[u8]) -> Result<RecordedArenaTick, String> {
        RecordedArenaTick::decode(message)
    }
}
