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

use crate::messages::Saved;
use crate::output::GAP;
use crate::places::Places;
use crate::source::{Bytes, CHUNK_HEADER, ChunkPlace, LARGEST, Place, Source, data_of, parse};
use crate::{ArenaInfo, Ending, OfArena, OfClimber, RecordError, RecordingInfo, RecordingKind};

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
    /// Places of the ticks and saved states of a climber and of an arena: a recording has one of them.
    pub(crate) places: [Places; 2],
    /// How the file ends.
    pub(crate) ending: Ending,
    pub(crate) source: Source,
}

/// A topic whose messages are read back.
#[derive(Clone, Copy)]
struct Topic {
    name: &'static str,
    /// Index of the kind of recording that has it.
    kind: usize,
    /// True for saved states, false for ticks.
    is_saved: bool,
    /// Checks a message, and gives the number of its tick.
    number: fn(&[u8]) -> Result<u64, String>,
}

/// The topics of a kind of recording.
const fn topics<K: RecordingKind>() -> [Topic; 2] {
    let (name, kind) = (K::TOPICS.tick, K::TOPICS.index);
    [
        Topic {
            name,
            kind,
            is_saved: false,
            number: |message| K::tick(message).map(|(number, _)| number),
        },
        Topic {
            name: K::TOPICS.saved,
            kind,
            is_saved: true,
            number: |message| {
                let saved = Saved::decode(message).map_err(|error| error.to_string())?;
                if K::TOPICS.is_text && core::str::from_utf8(&saved.state).is_err() {
                    return Err("it is not a text".to_owned());
                }
                Ok(saved.tick)
            },
        },
    ]
}

/// The topics of both kinds.
const TOPICS: [[Topic; 2]; 2] = [topics::<OfClimber>(), topics::<OfArena>()];

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
        RecordError::Io { source, .. } => {
            RecordError::io(format!("cannot read {}", path.display()))(source)
        }
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
        places: found.places,
        ending,
        source: Source::new(bytes, found.chunks),
    })
}

fn failed(source: std::io::Error) -> RecordError {
    RecordError::io("the recording cannot be read")(source)
}

/// Results of the walk so far.
#[derive(Default)]
struct Found {
    is_mcap: bool,
    metadata: BTreeMap<String, BTreeMap<String, String>>,
    topics: BTreeMap<u16, Topic>,
    chunks: Vec<ChunkPlace>,
    places: [Places; 2],
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
                    let mut topics = TOPICS.into_iter().flatten();
                    if let Some(topic) = topics.find(|topic| topic.name == channel.topic) {
                        self.topics.insert(channel.id, topic);
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
                    if let Some(topic) = self.topics.get(&header.channel_id).copied() {
                        let at = place.at + CHUNK_HEADER + u64::from(within.from);
                        self.message((topic, within), &message, at)
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

    /// Checks a message, and stores its place. `at` is the message's offset in the file, for errors.
    fn message(
        &mut self,
        (topic, place): (Topic, Place),
        message: &[u8],
        at: u64,
    ) -> Result<(), RecordError> {
        let number = (topic.number)(message).map_err(|reason| RecordError::Message {
            at,
            topic: topic.name,
            reason,
        })?;
        let places = &mut self.places[topic.kind];
        if topic.is_saved {
            places.add_saved(number, place)
        } else {
            places.add_tick(number, place)
        }
    }
}

/// Parses only the kinds of records that are needed: mcap's parser of the other kinds is not made for arbitrary bytes.
fn parse_inner(opcode: u8, body: &[u8]) -> Option<Record<'_>> {
    matches!(opcode, op::CHANNEL | op::MESSAGE)
        .then(|| parse(opcode, body))
        .flatten()
}
