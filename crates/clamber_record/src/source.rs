//! The bytes of a recording: in memory, or in a file from which one chunk is read at a time.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::ops::Deref;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use mcap::parse_record;
use mcap::records::{Record, op};

use crate::RecordError;

/// The largest chunk that is read, bytes (512 MiB), compressed and decompressed. It bounds the memory that a damaged
/// length can claim. A recorder's own chunk has a second of ticks by default: some megabytes.
pub(crate) const LARGEST: u64 = 1 << 29;

/// Bytes of a chunk's body before its data, if the chunk is not compressed. Offsets in compressed chunks are computed
/// with it, too.
pub(crate) const CHUNK_HEADER: u64 = 40;

/// A recording's bytes.
#[derive(Clone, Debug)]
pub(crate) struct Source(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    bytes: Bytes,
    chunks: Vec<ChunkPlace>,
    /// Index and data of the chunk that was read last.
    last: Mutex<Option<(u32, Arc<[u8]>)>>,
}

#[derive(Debug)]
pub(crate) enum Bytes {
    Memory(Vec<u8>),
    File(Mutex<File>),
}

/// The place of a chunk record's body in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ChunkPlace {
    pub(crate) at: u64,
    pub(crate) length: u64,
}

/// The place of a message: the index of its chunk, and a range of bytes in the chunk's decompressed data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    pub(crate) chunk: u32,
    pub(crate) from: u32,
    pub(crate) to: u32,
}

impl Bytes {
    pub(crate) fn open(path: &Path) -> Result<Self, RecordError> {
        let failed = RecordError::io(format!("cannot read {}", path.display()));
        Ok(Self::File(Mutex::new(File::open(path).map_err(failed)?)))
    }

    fn read(&self, place: ChunkPlace) -> std::io::Result<Vec<u8>> {
        let mut body = Vec::new();
        match self {
            Self::Memory(bytes) => {
                let at = usize::try_from(place.at).unwrap_or(usize::MAX);
                let rest = bytes.get(at..).unwrap_or_default();
                rest.take(place.length).read_to_end(&mut body)?;
            }
            Self::File(file) => {
                let mut file = file.lock().unwrap_or_else(PoisonError::into_inner);
                file.seek(SeekFrom::Start(place.at))?;
                (&mut *file).take(place.length).read_to_end(&mut body)?;
            }
        }
        Ok(body)
    }
}

impl Source {
    pub(crate) fn new(bytes: Bytes, chunks: Vec<ChunkPlace>) -> Self {
        Self(Arc::new(Inner {
            bytes,
            chunks,
            last: Mutex::new(None),
        }))
    }

    /// Passes the message at a place to `decode` and returns the result.
    pub(crate) fn read<T>(
        &self,
        place: &Place,
        topic: &'static str,
        decode: impl FnOnce(&[u8]) -> Result<T, String>,
    ) -> Result<T, RecordError> {
        let chunk = self.chunk(place.chunk)?;
        let message = chunk.get(place.from as usize..place.to as usize);
        let message = message.ok_or_else(|| "its chunk has changed".to_owned());
        message
            .and_then(decode)
            .map_err(|reason| RecordError::Message {
                at: self.offset(place),
                topic,
                reason,
            })
    }

    /// Offset of a message in the file, bytes, as if its chunk were not compressed.
    pub(crate) fn offset(&self, place: &Place) -> u64 {
        let chunk = self.0.chunks.get(place.chunk as usize);
        chunk.map_or(0, |chunk| chunk.at + CHUNK_HEADER + u64::from(place.from))
    }

    fn chunk(&self, index: u32) -> Result<Arc<[u8]>, RecordError> {
        let mut last = self.0.last.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((known, chunk)) = last.deref()
            && *known == index
        {
            return Ok(Arc::clone(chunk));
        }
        let changed = |source| RecordError::io("the recording cannot be read any more")(source);
        let place = self.0.chunks.get(index as usize).copied();
        let place = place.unwrap_or(ChunkPlace { at: 0, length: 0 });
        let body = self.0.bytes.read(place).map_err(changed)?;
        let data = data_of(&body).map_err(|reason| changed(std::io::Error::other(reason)))?;
        let data: Arc<[u8]> = data.into();
        *last = Some((index, Arc::clone(&data)));
        Ok(data)
    }
}

/// Parses a record; `None` if it cannot be read. mcap's parser allocates as much memory as the lengths of texts claim,
/// so the lengths are first compared with the bytes that are there.
pub(crate) fn parse(opcode: u8, body: &[u8]) -> Option<Record<'_>> {
    // Bytes before the first text, and the number of texts and maps.
    let (before, texts) = match opcode {
        op::METADATA => (0, 2),
        op::CHANNEL => (4, 3),
        op::CHUNK => (28, 1),
        _ => (0, 0),
    };
    let mut rest = body.get(before..)?;
    for index in 0..texts {
        let text = text_of(&mut rest)?;
        // The last entry of metadata and channels is a map of texts.
        if opcode != op::CHUNK && index + 1 == texts {
            let mut pairs = text;
            while !pairs.is_empty() {
                text_of(&mut pairs)?;
            }
        }
    }
    parse_record(opcode, body).ok()
}

/// Takes a text, which its length precedes, from the front of `bytes`.
fn text_of<'a>(bytes: &mut &'a [u8]) -> Option<&'a [u8]> {
    let (length, rest) = bytes.split_first_chunk::<4>()?;
    let length = usize::try_from(u32::from_le_bytes(*length)).ok()?;
    let (text, rest) = rest.split_at_checked(length)?;
    *bytes = rest;
    Some(text)
}

/// The data of a chunk record, decompressed and checked.
pub(crate) fn data_of(body: &[u8]) -> Result<Vec<u8>, &'static str> {
    let Some(Record::Chunk { header, data }) = parse(op::CHUNK, body) else {
        return Err("a chunk without a header");
    };
    if header.uncompressed_size > LARGEST {
        return Err("a chunk of more than 512 MiB");
    }
    let (size, compressed) = (header.uncompressed_size, &data[..]);
    // Reading up to one byte more than `size` shows whether the chunk is too long.
    let mut plain = Vec::new();
    let read = match header.compression.as_str() {
        "" => {
            plain.extend_from_slice(compressed);
            Ok(0)
        }
        "zstd" => match ruzstd::decoding::StreamingDecoder::new(compressed) {
            Ok(decoder) => decoder.take(size + 1).read_to_end(&mut plain),
            Err(_) => return Err("a chunk that zstd cannot decompress"),
        },
        "lz4" => lz4_flex::frame::FrameDecoder::new(compressed)
            .take(size + 1)
            .read_to_end(&mut plain),
        _ => return Err("a chunk with a compression that is neither zstd nor lz4"),
    };
    if read.is_err() {
        return Err("a chunk that cannot be decompressed");
    }
    if plain.len() as u64 != size {
        return Err("a chunk whose size is not as its header says");
    }
    // Zero means that there is no checksum.
    if ![0, crc32fast::hash(&plain)].contains(&header.uncompressed_crc) {
        return Err("a chunk whose checksum is wrong");
    }
    Ok(plain)
}
