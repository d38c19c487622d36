use std::io;

use thiserror::Error;

/// An error from writing or reading a recording.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecordError {
    /// The file cannot be opened, read or written, or the writing thread cannot be started.
    #[error("{what}: {source}")]
    Io {
        /// The operation that failed, with the file's name if there is one.
        what: String,
        /// The system's error.
        source: io::Error,
    },
    /// The MCAP writer failed.
    #[error("the recording cannot be written: {}", reason(.0))]
    Write(#[from] mcap::McapError),
    /// A message cannot be encoded.
    #[error("a message on {topic} cannot be encoded: {reason}")]
    Encode {
        /// Topic of the message.
        topic: &'static str,
        /// Why it cannot be encoded.
        reason: String,
    },
    /// A tick's number is not one more than the number of the tick before.
    #[error("tick {found} cannot follow tick {last}: record every tick once, in order")]
    Order {
        /// The last tick that was recorded.
        last: u64,
        /// The tick that does not follow it.
        found: u64,
    },
    /// The palette and the surface's mesh differ in the number of joints.
    #[error(
        "the surface has {mesh} joints, but the palette has {palette}: pass the palette that posed it"
    )]
    JointCount {
        /// Number of joints of the surface's mesh.
        mesh: usize,
        /// Number of matrices of the palette.
        palette: usize,
    },
    /// A figure's skeleton and palette differ in the number of joints, or the skeleton has another number of joints
    /// than before.
    #[error(
        "figure {figure} has {skeleton} joints now and a palette of {palette}: pass the palette that posed it, and the \
         same skeleton each time"
    )]
    FigureJoints {
        /// Name of the figure.
        figure: String,
        /// Number of joints of the figure's skeleton.
        skeleton: usize,
        /// Number of matrices of the palette.
        palette: usize,
    },
    /// The number of inputs is not the number of fighters that were in the arena before the step.
    #[error("{found} inputs were given for {fighters} fighters: pass those of the last step")]
    Inputs {
        /// Number of fighters in the arena before the step.
        fighters: usize,
        /// Number of inputs given.
        found: usize,
    },
    /// Creatures or fighters were added to the arena since the last tick without an order, so a replay could not add
    /// them.
    #[error(
        "creatures or fighters were added to the arena without an order since the recorder saw it last: begin the recording \
         after that, or add them by orders"
    )]
    Joined,
    /// The arena is not the recorded one: the hash of its configuration differs.
    #[error(
        "this is another arena than the recorded one: its `ArenaConfig` differs (hash {found:016x}, recorded \
         {recorded:016x}); make it with the same one"
    )]
    OtherArena {
        /// Hash of the configuration of the recorded arena.
        recorded: u64,
        /// Hash of the configuration of this arena.
        found: u64,
    },
    /// The number of names does not fit the arena's creatures or fighters, or a name is used twice or reserved.
    #[error("{0}: give each creature and each fighter of the arena a name of its own")]
    Names(String),
    /// The arena, a state or an order cannot be saved or restored, or the arena cannot be stepped.
    #[error(transparent)]
    Arena(#[from] clamber_fight::ArenaError),
    /// The recording ended at an earlier error, which an earlier call returned.
    #[error("the recording has ended: an earlier part of it could not be written")]
    Ended,
    /// The duration of a tick is not positive or not finite.
    #[error("a tick must last a positive, finite number of seconds, found {0}")]
    TickSeconds(f64),
    /// The file does not begin with MCAP's magic bytes.
    #[error(
        "not an MCAP file: it does not begin with MCAP's magic bytes; open a file made by a recorder"
    )]
    NotMcap,
    /// The file has no readable metadata of a recording of this kind: it is another program's file, is cut or damaged
    /// there, or is a recording of the other kind.
    #[error("not a recording of clamber: {0}")]
    NotARecording(String),
    /// The contents of a message are wrong, although the checksum of its chunk is right.
    #[error("the message at byte {at} on {topic} cannot be read: {reason}; record the run again")]
    Message {
        /// Offset of the message in the file, bytes. In a compressed chunk, the offset is computed as if the chunk were
        /// not compressed.
        at: u64,
        /// Topic of the message.
        topic: &'static str,
        /// Why it cannot be read.
        reason: String,
    },
    /// The recording does not have this tick.
    #[error("no tick {asked}: the recording holds {}", held(*.ticks))]
    NoTick {
        /// The tick that was asked for.
        asked: u64,
        /// The first and the last tick of the recording; `None` if it has no ticks.
        ticks: Option<(u64, u64)>,
    },
    /// There is no snapshot at or before this tick.
    #[error("no snapshot at or before tick {0}: replay from the beginning")]
    NoSnapshot(u64),
}

impl RecordError {
    /// A function that adds to a system's error what failed.
    pub(crate) fn io(what: impl Into<String>) -> impl FnOnce(io::Error) -> Self {
        let what = what.into();
        move |source| Self::Io { what, source }
    }

    /// A message that cannot be encoded, and why.
    pub(crate) fn encode(topic: &'static str, reason: impl ToString) -> Self {
        let reason = reason.to_string();
        Self::Encode { topic, reason }
    }
}

/// The text of an MCAP error. mcap's own text for I/O errors leaves out the system's message.
fn reason(error: &mcap::McapError) -> String {
    match error {
        mcap::McapError::Io(source) => source.to_string(),
        other => other.to_string(),
    }
}

fn held(ticks: Option<(u64, u64)>) -> String {
    match ticks {
        Some((first, last)) => format!("ticks {first} to {last}"),
        None => "no ticks".to_owned(),
    }
}
