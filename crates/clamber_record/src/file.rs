//! Walks the records of an MCAP file from the front, so that a file can be read up to a crash or damage. The walk needs
//! neither footer nor summary.
//!
//! The walk holds one record in memory at a time, and keeps only the places of ticks and saved states. It checks the
//! length of a record before it reads the record. It accepts a chunk only if the chunk's checksum is right or missing.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;
use std::sync::PoisonError;

use mcap::MAGIC;
use mcap::records::{Record, op};
use prost::Message;

use crate::messages::{ArenaSnapshot, Snapshot};
use crate::output::GAP;
use crate::places::Places;
use crate::source::{Bytes, CHUNK_HEADER, ChunkPlace, LARGEST, Place, Source, data_of, parse};
use crate::{
    ArenaInfo, Ending, RecordError, RecordedArenaTick, RecordedTick, RecordingInfo, topics,
};

/// Bytes of a record before its body: one for its kind and eight for its length, as MCAP defines them.
const PREFIX: usize = 9;

/// Names of the metadata records that are read. Others are skipped.
const NAMES: [&str; 4] = [
    ArenaInfo::METADATA,
    RecordingInfo::METADATA,
    RecordingInfo::SETTINGS,
    GAP,
];

/// The largest metadata record that is read, bytes (16 MiB). It bounds the memory that a damaged length can claim.
/// `Output::new` refuses to write a larger one.
pub(crate) const METADATA: u64 = 1 << 24;

/// The contents of a recorder's MCAP file.
#[derive(Debug)]
pub(crate) struct Contents {
    /// Metadata records by name. If several have the same name, the first one counts.
    pub(crate) metadata: BTreeMap<String, BTreeMap<String, String>>,
    /// Places of a climber's ticks and snapshots.
    pub(crate) climber: Places,
    /// Places of an arena's ticks and saved states.
    pub(crate) arena: Places,
    /// How the file ends.
    pub(crate) ending: Ending,
    pub(crate) source: Source,
}

/// Kinds of messages that are read back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Tick,
    Snapshot,
    Arena,
    ArenaSnapshot,
}

/// Why the walk stopped.
enum Stop {
    Early,
    Damaged(u64, String),
    Failed(std::io::Error),
}

impl From<std::io::Error> for Stop {
    fn from(error: std::io::Error) -> Self {
        Self::Failed(error)
    }
}

/// Opens a file and walks its records.
pub(crate) fn open(path: &Path) -> Result<Contents, RecordError> {
    let bytes = Bytes::open(path)?;
    read(bytes).map_err(|error| match error {
        RecordError::Io { source, .. } => RecordError::Io {
            what: format!("cannot read {}", path.display()),
            source,
        },
        other => other,
    })
}

/// Walks the records in the bytes of a file.
pub(crate) fn read(bytes: Bytes) -> Result<Contents, RecordError> {
    let mut found = Found::default();
    let walked = match &bytes {
        Bytes::Memory(bytes) => walk(&bytes[..], &mut found),
        Bytes::File(file) => {
            let file = file.lock().unwrap_or_else(PoisonError::into_inner);
            walk(std::io::BufReader::new(&*file), &mut found)
        }
    };
    if !found.is_mcap {
        return match walked {
            Err(Stop::Failed(source)) => Err(failed(source)),
            _ => Err(RecordError::NotMcap),
        };
    }
    let ending = match walked {
        Ok(()) => Ending::Whole,
        Err(Stop::Early) => Ending::Early,
        Err(Stop::Damaged(at, reason)) => Ending::Damaged { at, reason },
        Err(Stop::Failed(source)) => return Err(failed(source)),
    };
    Ok(Contents {
        metadata: found.metadata,
        climber: found.climber,
        arena: found.arena,
        ending,
        source: Source::new(bytes, found.chunks),
    })
}

fn failed(source: std::io::Error) -> RecordError {
    RecordError::Io {
        what: "the recording cannot be read".to_owned(),
        source,
    }
}

/// Results of the walk so far.
#[derive(Default)]
struct Found {
    is_mcap: bool,
    metadata: BTreeMap<String, BTreeMap<String, String>>,
    topics: BTreeMap<u16, Kind>,
    chunks: Vec<ChunkPlace>,
    climber: Places,
    arena: Places,
}

/// Reads a file from front to end, and keeps a checksum of everything that was read.
struct Reader<R> {
    inner: R,
    at: u64,
    sum: crc32fast::Hasher,
}

impl<R: Read> Reader<R> {
    /// Reads `count` bytes into `into`; [`Stop::Early`] if the file has fewer left.
    fn take(&mut self, count: u64, into: &mut Vec<u8>) -> Result<(), Stop> {
        into.clear();
        let read = self.inner.by_ref().take(count).read_to_end(into)? as u64;
        self.at += read;
        self.sum.update(into);
        if read == count {
            Ok(())
        } else {
            Err(Stop::Early)
        }
    }

    /// Skips `count` bytes.
    fn skip(&mut self, mut count: u64, buffer: &mut Vec<u8>) -> Result<(), Stop> {
        /// Bytes that are skipped at a time. It bounds the size of the buffer.
        const PIECE: u64 = 1 << 16;
        while count > 0 {
            let piece = count.min(PIECE);
            self.take(piece, buffer)?;
            count -= piece;
        }
        Ok(())
    }
}

fn walk(file: impl Read, found: &mut Found) -> Result<(), Stop> {
    let mut reader = Reader {
        inner: file,
        at: 0,
        sum: crc32fast::Hasher::new(),
    };
    let mut buffer = Vec::new();
    reader.take(MAGIC.len() as u64, &mut buffer)?;
    found.is_mcap = buffer == MAGIC;
    if !found.is_mcap {
        return Err(Stop::Early);
    }
    loop {
        let (at, before) = (reader.at, reader.sum.clone());
        reader.take(PREFIX as u64, &mut buffer)?;
        let opcode = buffer[0];
        let length = buffer[1..].try_into().map_or(0, u64::from_le_bytes);
        let body = reader.at;
        let damaged = |reason: &str| Stop::Damaged(at, reason.to_owned());
        match opcode {
            op::METADATA => {
                if length > METADATA {
                    return Err(damaged("metadata of more than 16 MiB"));
                }
                reader.take(length, &mut buffer)?;
                let Some(Record::Metadata(metadata)) = parse(opcode, &buffer) else {
                    return Err(damaged("metadata that cannot be read"));
                };
                // Other programs may add any number of metadata records, so only known names are kept.
                if NAMES.contains(&metadata.name.as_str()) {
                    let known = found.metadata.entry(metadata.name);
                    known.or_insert(metadata.metadata);
                }
            }
            op::CHUNK => {
                if length > LARGEST {
                    return Err(damaged("a chunk of more than 512 MiB"));
                }
                reader.take(length, &mut buffer)?;
                let place = ChunkPlace { at: body, length };
                found.chunk(place, &buffer)?;
            }
            op::DATA_END => {
                if length > METADATA {
                    return Err(damaged("a broken data end record"));
                }
                reader.take(length, &mut buffer)?;
                let Some(Record::DataEnd(end)) = parse(opcode, &buffer) else {
                    return Err(damaged("a broken data end record"));
                };
                // Zero means that there is no checksum.
                if ![0, before.finalize()].contains(&end.data_section_crc) {
                    let reason =
                        "the checksum of all data is wrong: metadata or an index has changed";
                    return Err(damaged(reason));
                }
                return end_of(&mut reader);
            }
            // Message indices, and records that other programs add.
            op::HEADER | op::MESSAGE_INDEX | op::ATTACHMENT | 0x80.. => {
                reader.skip(length, &mut buffer)?;
            }
            other => {
                return Err(damaged(&format!(
                    "a record of kind {other:#04x} out of place"
                )));
            }
        }
    }
}

/// Reads the rest of the file after the data. It skips the summary and checks the magic bytes at the end.
fn end_of<R: Read>(reader: &mut Reader<R>) -> Result<(), Stop> {
    let mut last: Vec<u8> = Vec::new();
    let mut piece = vec![0; 1 << 16];
    loop {
        let count = match reader.inner.read(&mut piece) {
            Ok(0) => break,
            Ok(count) => count,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => continue,
            Err(error) => return Err(error.into()),
        };
        last.extend_from_slice(&piece[..count]);
        let kept = last.len().saturating_sub(MAGIC.len());
        last.drain(..kept);
    }
    if last == MAGIC {
        Ok(())
    } else {
        Err(Stop::Early)
    }
}

/// The kind and the range of the body of the record at `at`; `None` if the record reaches beyond the end.
fn record(bytes: &[u8], at: usize) -> Option<(u8, core::ops::Range<usize>)> {
    let start = at
        .checked_add(PREFIX)
        .filter(|start| *start <= bytes.len())?;
    let length = bytes.get(at + 1..start)?.try_into().ok()?;
    let length = usize::try_from(u64::from_le_bytes(length)).ok()?;
    let stop = start
        .checked_add(length)
        .filter(|stop| *stop <= bytes.len())?;
    Some((bytes[at], start..stop))
}

impl Found {
    fn chunk(&mut self, place: ChunkPlace, body: &[u8]) -> Result<(), Stop> {
        let damaged = |reason: &str| Stop::Damaged(place.at, reason.to_owned());
        let data = data_of(body).map_err(damaged)?;
        let index = u32::try_from(self.chunks.len());
        let chunk = index.map_err(|_| damaged("more chunks than are read"))?;
        self.chunks.push(place);
        let mut at = 0;
        while at < data.len() {
            let Some((opcode, body)) = record(&data, at) else {
                return Err(damaged("a record that reaches beyond its chunk"));
            };
            match (opcode, parse_inner(opcode, &data[body.clone()])) {
                (_, Some(Record::Channel(channel))) => {
                    let kind = match channel.topic.as_str() {
                        topics::TICK => Some(Kind::Tick),
                        topics::SNAPSHOT => Some(Kind::Snapshot),
                        topics::ARENA => Some(Kind::Arena),
                        topics::ARENA_SNAPSHOT => Some(Kind::ArenaSnapshot),
                        _ => None,
                    };
                    if let Some(kind) = kind {
                        self.topics.insert(channel.id, kind);
                    }
                }
                (
                    _,
                    Some(Record::Message {
                        header,
                        data: message,
                    }),
                ) => {
                    let from = body.end - message.len();
                    // The bounds fit in 32 bits, because a chunk has at most `LARGEST` bytes.
                    let within = Place {
                        chunk,
                        from: from as u32,
                        to: body.end as u32,
                    };
                    if let Some(kind) = self.topics.get(&header.channel_id).copied() {
                        let at = place.at + CHUNK_HEADER + u64::from(within.from);
                        self.message((kind, within), &message, at)
                            .map_err(|error| Stop::Damaged(at, error.to_string()))?;
                    }
                }
                (op::CHANNEL | op::MESSAGE, _) => {
                    return Err(damaged("a chunk with a record that cannot be read"));
                }
                _ => {}
            }
            at = body.end;
        }
        Ok(())
    }

    /// Decodes a message, to check it, and stores its place. `at` is the message's offset in the file, for errors.
    fn message(
        &mut self,
        (kind, place): (Kind, Place),
        message: &[u8],
        at: u64,
    ) -> Result<(), RecordError> {
        let broken =
            |topic: &'static str, reason: String| RecordError::Message { at, topic, reason };
        match kind {
            Kind::Tick => {
                let tick = RecordedTick::decode(message);
                let tick = tick.map_err(|reason| broken(topics::TICK, reason))?;
                self.climber.add_tick(tick.tick, place)
            }
            Kind::Snapshot => {
                let saved = Snapshot::decode(message);
                let saved = saved.map_err(|e| broken(topics::SNAPSHOT, e.to_string()))?;
                self.climber.add_saved(saved.tick, place)
            }
            Kind::Arena => {
                let tick = RecordedArenaTick::decode(message);
                let tick = tick.map_err(|reason| broken(topics::ARENA, reason))?;
                self.arena.add_tick(tick.tick, place)
            }
            Kind::ArenaSnapshot => {
                let saved = ArenaSnapshot::decode(message);
                let saved = saved.map_err(|e| broken(topics::ARENA_SNAPSHOT, e.to_string()))?;
                self.arena.add_saved(saved.tick, place)
            }
        }
    }
}

/// Parses only the kinds of records that are needed: mcap's parser of the other kinds is not made for arbitrary bytes.
fn parse_inner(opcode: u8, body: &[u8]) -> Option<Record<'_>> {
    matches!(opcode, op::CHANNEL | op::MESSAGE)
        .then(|| parse(opcode, body))
        .flatten()
}
