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

use crate::kind::Entries;
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
    pub(crate) metadata: BTreeMap<String, Entries>,
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

/// Why the walk stopped before the end of the file.
enum Stop {
    At(Ending),
    Error(RecordError),
}

impl From<std::io::Error> for Stop {
    fn from(source: std::io::Error) -> Self {
        Self::Error(RecordError::io("the recording cannot be read")(source))
    }
}

impl Stop {
    fn damaged(at: u64, reason: &str) -> Self {
        let reason = reason.to_owned();
        Self::At(Ending::Damaged { at, reason })
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
    let ending = match walked {
        Ok(()) => Ending::Whole,
        Err(Stop::At(ending)) => ending,
        Err(Stop::Error(error)) => return Err(error),
    };
    Ok(Contents {
        metadata: found.metadata,
        places: found.places,
        ending,
        source: Source::new(bytes, found.chunks),
    })
}

/// Results of the walk so far.
#[derive(Default)]
struct Found {
    metadata: BTreeMap<String, Entries>,
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
    /// Reads `count` bytes into `into`; [`Ending::Early`] if the file has fewer left.
    fn take(&mut self, count: u64, into: &mut Vec<u8>) -> Result<(), Stop> {
        into.clear();
        let read = self.inner.by_ref().take(count).read_to_end(into)? as u64;
        self.at += read;
        self.sum.update(into);
        if read == count {
            Ok(())
        } else {
            Err(Stop::At(Ending::Early))
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
    let begun = reader.take(MAGIC.len() as u64, &mut buffer);
    if let Err(Stop::Error(error)) = begun {
        return Err(Stop::Error(error));
    }
    if buffer != MAGIC {
        return Err(Stop::Error(RecordError::NotMcap));
    }
    loop {
        let (at, before) = (reader.at, reader.sum.clone());
        reader.take(PREFIX as u64, &mut buffer)?;
        let opcode = buffer[0];
        let length = buffer[1..].try_into().map_or(0, u64::from_le_bytes);
        let body = reader.at;
        let damaged = |reason: &str| Stop::damaged(at, reason);
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
    while reader.inner.by_ref().take(1 << 16).read_to_end(&mut last)? > 0 {
        let kept = last.len().saturating_sub(MAGIC.len());
        last.drain(..kept);
    }
    if last == MAGIC {
        Ok(())
    } else {
        Err(Stop::At(Ending::Early))
    }
}

/// The kind and the range of the body of the record at `at`; `None` if the record reaches beyond the end.
fn record(bytes: &[u8], at: usize) -> Option<(u8, core::ops::Range<usize>)> {
    let (prefix, rest) = bytes.get(at..)?.split_first_chunk::<PREFIX>()?;
    let [opcode, length @ ..] = *prefix;
    let length = usize::try_from(u64::from_le_bytes(length)).ok()?;
    let start = at + PREFIX;
    (length <= rest.len()).then(|| (opcode, start..start + length))
}

impl Found {
    fn chunk(&mut self, place: ChunkPlace, body: &[u8]) -> Result<(), Stop> {
        let damaged = |reason: &str| Stop::damaged(place.at, reason);
        let data = data_of(body).map_err(damaged)?;
        let index = u32::try_from(self.chunks.len());
        let chunk = index.map_err(|_| damaged("more chunks than are read"))?;
        self.chunks.push(place);
        let mut at = 0;
        while at < data.len() {
            let Some((opcode, body)) = record(&data, at) else {
                return Err(damaged("a record that reaches beyond its chunk"));
            };
            at = body.end;
            // Only the kinds that are needed are parsed: mcap's parser of the others is not made for arbitrary bytes.
            if !matches!(opcode, op::CHANNEL | op::MESSAGE) {
                continue;
            }
            match parse(opcode, &data[body]) {
                Some(Record::Channel(channel)) => {
                    let mut topics = TOPICS.into_iter().flatten();
                    if let Some(topic) = topics.find(|topic| topic.name == channel.topic) {
                        self.topics.insert(channel.id, topic);
                    }
                }
                Some(Record::Message {
                    header,
                    data: message,
                }) => {
                    let Some(topic) = self.topics.get(&header.channel_id).copied() else {
                        continue;
                    };
                    // The bounds fit in 32 bits, because a chunk has at most `LARGEST` bytes.
                    let within = Place {
                        chunk,
                        from: (at - message.len()) as u32,
                        to: at as u32,
                    };
                    let offset = place.at + CHUNK_HEADER + u64::from(within.from);
                    let number = (topic.number)(&message).map_err(|reason| RecordError::Message {
                        at: offset,
                        topic: topic.name,
                        reason,
                    });
                    let places = &mut self.places[topic.kind];
                    let added = number.and_then(|number| match topic.is_saved {
                        true => places.add_saved(number, within),
                        false => places.add_tick(number, within),
                    });
                    added.map_err(|error| Stop::damaged(offset, &error.to_string()))?;
                }
                _ => return Err(damaged("a chunk with a record that cannot be read")),
            }
        }
        Ok(())
    }
}
