//! What a recording is of: one climber and its creature, or an arena.

use std::collections::BTreeMap;
use std::fmt;

use crate::arena::{ArenaInfo, ArenaMemory, RecordedArenaTick, TakenArena};
use crate::chunks::TakenTick;
use crate::recorder::ClimberMemory;
use crate::taken::Taken;
use crate::{RecordError, RecordedTick, RecordingInfo, topics};

/// A recording of one climber and its creature, in a scene that the game steps by itself.
#[derive(Clone, Copy, Debug)]
pub enum OfClimber {}

/// A recording of an arena of `clamber_fight`, which the recorder sees whole.
#[derive(Clone, Copy, Debug)]
pub enum OfArena {}

/// What a recording is of: [`OfClimber`] or [`OfArena`], and nothing else.
pub trait RecordingKind: Sealed {
    /// What is known of the whole.
    type Info: Clone + fmt::Debug;
    /// What is recorded in a tick.
    type Tick;

    /// The name of its metadata.
    #[doc(hidden)]
    const METADATA: &'static str;
    /// What to do with a recording of this kind.
    #[doc(hidden)]
    const READ_WITH: &'static str;
    /// Where its ticks are.
    #[doc(hidden)]
    const TOPIC: &'static str;
    /// True of an arena.
    #[doc(hidden)]
    const IS_ARENA: bool;
    /// A tick as it is copied.
    #[doc(hidden)]
    type Taken: TakenTick;
    /// What its recorder remembers.
    #[doc(hidden)]
    type Memory;

    #[doc(hidden)]
    fn info(
        metadata: &BTreeMap<String, String>,
        settings: BTreeMap<String, String>,
    ) -> Result<Self::Info, RecordError>;

    /// What a message says, or what is wrong with it.
    #[doc(hidden)]
    fn tick(message: &[u8]) -> Result<Self::Tick, String>;
}

/// Only this crate knows kinds.
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
