//! Walks the records of an MCAP file from the front. So a file can be read up to where a crash or damage ends
//! it, and neither footer nor summary is needed.
//!
//! Lengths are checked against the bytes that are left before anything is read. A chunk counts only if its
//! checksum is right. The records are walked in one pass.

use std::collections::BTreeMap;
use std::ops::Range;

use mcap::records::{Record, op};
use mcap::{MAGIC, parse_record};

use crate::{Ending, RecordError, topics};

/// Bytes of a record before its body: its kind and its length.
const PREFIX: usize = 9;

/// Bytes of the header of a chunk that is not compressed.
const CHUNK_HEADER: usize = 40;

/// The contents of an MCAP file that recorders write.
#[derive(Debug, Default)]
pub(crate) struct Contents {
    /// Metadata records by name; the first of those with the same name.
    pub(crate) metadata: BTreeMap<String, BTreeMap<String, String>>,
    /// The kind and the bytes of each message, in order.
    pub(crate) messages: Vec<(Kind, Range<usize>)>,
    /// How the file ends.
    pub(crate) ending: Ending,
}

/// Messages that are read back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Tick,
    Snapshot,
    Arena,
    ArenaSnapshot,
}

/// Why the walk stopped.
enum Stop {
    Early,
    Damaged(usize, String),
}

/// Walks a file.
pub(crate) fn read(bytes: &[u8]) -> Result<Contents, RecordError> {
    if !bytes.starts_with(MAGIC) {
        return Err(RecordError::NotMcap);
    }
    let mut contents = Contents::default();
    contents.ending = match walk(bytes, &mut contents) {
        Ok(()) => Ending::Whole,
        Err(Stop::Early) => Ending::Early,
        Err(Stop::Damaged(at, reason)) => Ending::Damaged { at, reason },
    };
    Ok(contents)
}

fn walk(bytes: &[u8], contents: &mut Contents) -> Result<(), Stop> {
    let mut topics = BTreeMap::new();
    let mut at = MAGIC.len();
    loop {
        let (opcode, body) = record(bytes, at, bytes.len()).ok_or(Stop::Early)?;
        let damaged = |reason: String| Stop::Damaged(at, reason);
        match opcode {
            op::METADATA => {
                let parsed = parse_record(opcode, &bytes[body.clone()]);
                let Ok(Record::Metadata(metadata)) = parsed else {
                    return Err(damaged("metadata that cannot be read".to_owned()));
                };
                let known = contents.metadata.entry(metadata.name);
                known.or_insert(metadata.metadata);
            }
            op::CHUNK => walk_chunk(bytes, body.clone(), &mut topics, contents)?,
            op::DATA_END => {
                check_data(bytes, at, body.clone())?;
                let whole = bytes[body.end..].ends_with(MAGIC);
                return if whole { Ok(()) } else { Err(Stop::Early) };
            }
            // Message indices, and records that other programs add.
            op::HEADER | op::MESSAGE_INDEX | op::ATTACHMENT | 0x80.. => {}
            other => {
                return Err(damaged(format!(
                    "a record of kind {other:#04x} out of place"
                )));
            }
        }
        at = body.end;
    }
}

/// The kind and the body of the record at `at`; `None` if it reaches beyond `end`.
fn record(bytes: &[u8], at: usize, end: usize) -> Option<(u8, Range<usize>)> {
    let start = at.checked_add(PREFIX).filter(|start| *start <= end)?;
    let length = bytes.get(at + 1..start)?.try_into().ok()?;
    let length = usize::try_from(u64::from_le_bytes(length)).ok()?;
    let stop = start.checked_add(length).filter(|stop| *stop <= end)?;
    Some((bytes[at], start..stop))
}

fn walk_chunk(
    bytes: &[u8],
    chunk: Range<usize>,
    topics: &mut BTreeMap<u16, Kind>,
    contents: &mut Contents,
) -> Result<(), Stop> {
    let damaged = |reason: &str| Stop::Damaged(chunk.start, reason.to_owned());
    let parsed = parse_record(op::CHUNK, &bytes[chunk.clone()]);
    let Ok(Record::Chunk { header, data }) = parsed else {
        return Err(damaged("a chunk without a header"));
    };
    if !header.compression.is_empty() {
        return Err(damaged("a compressed chunk; recorders write none"));
    }
    let sizes = (header.uncompressed_size, chunk.len());
    // The data must end where the chunk ends, since its place is computed from the chunk's end.
    if sizes != (data.len() as u64, CHUNK_HEADER + data.len()) {
        return Err(damaged("a chunk whose size is not as its header says"));
    }
    let data = chunk.start + CHUNK_HEADER..chunk.end;
    if crc32fast::hash(&bytes[data.clone()]) != header.uncompressed_crc {
        return Err(damaged("a chunk whose checksum is wrong"));
    }
    let mut at = data.start;
    while at < data.end {
        let Some((opcode, body)) = record(bytes, at, data.end) else {
            return Err(damaged("a record that reaches beyond its chunk"));
        };
        match (opcode, parse_inner(opcode, &bytes[body.clone()])) {
            (_, Some(Record::Channel(channel))) => {
                let kind = match channel.topic.as_str() {
                    topics::TICK => Some(Kind::Tick),
                    topics::SNAPSHOT => Some(Kind::Snapshot),
                    topics::ARENA => Some(Kind::Arena),
                    topics::ARENA_SNAPSHOT => Some(Kind::ArenaSnapshot),
                    _ => None,
                };
                if let Some(kind) = kind {
                    topics.insert(channel.id, kind);
                }
            }
            (_, Some(Record::Message { header, data })) => {
                if let Some(kind) = topics.get(&header.channel_id) {
                    let message = body.end - data.len()..body.end;
                    contents.messages.push((*kind, message));
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

/// Parses only the kinds that are needed: the parser of the others is not made for arbitrary bytes.
fn parse_inner(opcode: u8, body: &[u8]) -> Option<Record<'_>> {
    if matches!(opcode, op::CHANNEL | op::MESSAGE) {
        parse_record(opcode, body).ok()
    } else {
        None
    }
}

/// Compares the checksum of everything before the record that ends the data with the checksum in that record.
fn check_data(bytes: &[u8], at: usize, body: Range<usize>) -> Result<(), Stop> {
    let Ok(Record::DataEnd(end)) = parse_record(op::DATA_END, &bytes[body]) else {
        return Err(Stop::Damaged(at, "a broken data end record".to_owned()));
    };
    if end.data_section_crc == crc32fast::hash(&bytes[..at]) {
        Ok(())
    } else {
        let reason = "the checksum of all data is wrong: metadata or an index has changed";
        Err(Stop::Damaged(at, reason.to_owned()))
    }
}
