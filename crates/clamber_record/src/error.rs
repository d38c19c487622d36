use std::io;

use thiserror::Error;

/// Why a recording could not be written or read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecordError {
    /// The file cannot be opened, read or written.
    #[error("{what}: {source}")]
    Io {
        /// What was tried, with the file's name.
        what: String,
        /// What the system says.
        source: io::Error,
    },
    /// The MCAP writer refused.
    #[error("the recording cannot be written: {}", reason(.0))]
    Write(#[from] mcap::McapError),
    /// A message cannot be encoded.
    #[error("a message on {topic} cannot be encoded: {reason}")]
    Encode {
        /// Its topic.
        topic: &'static str,
        /// Why.
        reason: String,
    },
    /// A tick does not follow the one before it.
    #[error("tick {found} cannot follow tick {last}: record every tick once, in order")]
    Order {
        /// The last one recorded.
        last: u64,
        /// The one handed over.
        found: u64,
    },
    /// The palette is not one of the surface's creature.
    #[error(
        "the surface has {mesh} joints, but the palette {palette}: hand over the palette that posed it"
    )]
    JointCount {
        /// Joints of the surface's mesh.
        mesh: usize,
        /// Matrices of the palette.
        palette: usize,
    },
    /// Writing has ended earlier, by an error that was told then.
    #[error("the recording has ended: an earlier part of it could not be written")]
    Ended,
    /// The seconds of a tick are not positive or not finite.
    #[error("a tick must last a positive number of seconds, found {0}")]
    TickSeconds(f64),
    /// The file does not begin as MCAP files do.
    #[error(
        "no MCAP file: it does not begin with MCAP's magic bytes; name a file made by a recorder"
    )]
    NotMcap,
    /// The file is larger than a reader takes into memory.
    #[error("{bytes} bytes are more than the {limit} that are read at once; record shorter runs")]
    TooLarge {
        /// Its size.
        bytes: u64,
        /// The largest that is read.
        limit: u64,
    },
    /// An MCAP file without what a recorder writes first: another program's, or cut or damaged before that.
    #[error("no recording of clamber's: {0}")]
    NotARecording(String),
    /// A message does not hold what it should, although its chunk is whole.
    #[error("the message at byte {at} on {topic} cannot be read: {reason}; record the run anew")]
    Message {
        /// Where it stands in the file.
        at: usize,
        /// Its topic.
        topic: &'static str,
        /// Why.
        reason: String,
    },
    /// There is no such tick.
    #[error("no tick {asked}: the recording holds {}", held(*.ticks))]
    NoTick {
        /// The tick asked for.
        asked: u64,
        /// The first and the last that there are.
        ticks: Option<(u64, u64)>,
    },
    /// No snapshot stands at or before a tick.
    #[error("no snapshot at or before tick {0}: replay from the beginning")]
    NoSnapshot(u64),
}

/// mcap's own text for errors of the system leaves out what the system says.
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
