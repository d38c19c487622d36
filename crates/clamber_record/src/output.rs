//! The MCAP file of a recording: metadata, channels, messages.

use std::collections::BTreeMap;
use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use foxglove::Encode;
use foxglove::messages::Log;
use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{WriteOptions, Writer};

use crate::file::METADATA;
use crate::source::LARGEST;
use crate::views::timestamp;
use crate::{RecordError, RecordingInfo};

/// A channel: its number, and its topic for errors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Channel {
    id: u16,
    topic: &'static str,
}

impl Channel {
    pub(crate) fn topic(&self) -> &'static str {
        self.topic
    }
}

/// A chunk ends after the tick in which it becomes larger than this, bytes (64 MiB). Readers hold a whole chunk in
/// memory, and refuse chunks of more than 512 MiB.
const LARGE: u64 = 64 << 20;

/// Name of the metadata record that says how many ticks were left out at the end.
pub(crate) const GAP: &str = "clamber gap";
/// Key of that number in the [`GAP`] record.
pub(crate) const GAP_TICKS: &str = "ticks";

/// Upper bound of the bytes that a message or a record takes besides its data.
const MORE: u64 = 1024;
/// Bytes that a metadata entry takes besides its key and value: their two lengths, four bytes each.
const TEXTS: usize = 8;

pub(crate) struct Output<W: Write> {
    /// `None` once the file is finished.
    writer: Option<Writer<NoSeek<Gate<W>>>>,
    is_open: Arc<AtomicBool>,
    tick_seconds: f64,
    sequence: u32,
    /// Time of the tick that was begun last, nanoseconds since tick 0.
    now: u64,
    /// Bytes in the current chunk, with [`MORE`] for each message.
    chunk: u64,
    /// Buffer of the encoded message, kept so that its memory is reused.
    buffer: Vec<u8>,
}

/// Passes bytes on while it is open. `Output` closes it when dropped: mcap's writer finishes its file on drop, so the
/// file of a recording that failed would look whole.
struct Gate<W> {
    out: W,
    is_open: Arc<AtomicBool>,
}

impl<W: Write> Write for Gate<W> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if self.is_open.load(Ordering::Relaxed) {
            self.out.write(bytes)
        } else {
            Err(std::io::Error::other("the recording has ended at an error"))
        }
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.out.flush()
    }
}

impl<W: Write> Drop for Output<W> {
    fn drop(&mut self) {
        self.is_open.store(false, Ordering::Relaxed);
    }
}

impl<W: Write> Output<W> {
    /// Begins a file with metadata records.
    pub(crate) fn new(
        out: W,
        tick_seconds: f64,
        metadata: [(&str, BTreeMap<String, String>); 2],
    ) -> Result<Self, RecordError> {
        if !(tick_seconds > 0.0 && tick_seconds.is_finite()) {
            return Err(RecordError::TickSeconds(tick_seconds));
        }
        // A chunk stays in memory until `flush` ends it, so that bytes in the file never have to be changed.
        let write = WriteOptions::new()
            .compression(None)
            .chunk_size(None)
            .disable_seeking(true)
            .profile("")
            .library(format!("clamber_record {}", RecordingInfo::VERSION));
        let is_open = Arc::new(AtomicBool::new(true));
        let gate = Gate {
            out,
            is_open: Arc::clone(&is_open),
        };
        let mut writer = write.create(NoSeek::new(gate))?;
        for (name, metadata) in metadata {
            let sizes = metadata
                .iter()
                .map(|(key, value)| key.len() + value.len() + TEXTS);
            if sizes.sum::<usize>() as u64 + MORE > METADATA {
                let reason = "names and settings are more than 16 MiB, which no reader takes";
                return Err(RecordError::encode("metadata", reason));
            }
            let name = name.to_owned();
            writer.write_metadata(&Metadata { name, metadata })?;
        }
        Ok(Self {
            writer: Some(writer),
            is_open,
            tick_seconds,
            sequence: 0,
            now: 0,
            chunk: 0,
            buffer: Vec::new(),
        })
    }

    /// Adds a channel for messages of a type.
    pub(crate) fn channel<M: Encode>(
        &mut self,
        topic: &'static str,
    ) -> Result<Channel, RecordError> {
        self.channel_named::<M>(topic, topic)
    }

    /// Adds a channel called `name`. `topic` appears in errors only.
    pub(crate) fn channel_named<M: Encode>(
        &mut self,
        topic: &'static str,
        name: &str,
    ) -> Result<Channel, RecordError> {
        let schema = M::get_schema();
        let schema = schema.ok_or_else(|| RecordError::encode(topic, "it has no schema"))?;
        let writer = self.writer()?;
        let schema = writer.add_schema(&schema.name, &schema.encoding, &schema.data)?;
        let encoding = M::get_message_encoding();
        let id = writer.add_channel(schema, name, &encoding, &Default::default())?;
        Ok(Channel { id, topic })
    }

    /// Begins a tick, and returns the time of its messages, nanoseconds since tick 0.
    pub(crate) fn begin(&mut self, tick: u64) -> u64 {
        self.sequence = self.sequence.wrapping_add(1);
        self.now = (tick as f64 * self.tick_seconds * 1e9).round() as u64;
        self.now
    }

    /// Sends a message that is not read back.
    pub(crate) fn send(
        &mut self,
        channel: Channel,
        message: &impl Encode,
    ) -> Result<(), RecordError> {
        self.send_as(channel, |buffer| {
            message.encode(buffer).map_err(|error| error.to_string())
        })
    }

    /// Sends a message that is read back. prost encodes three times as fast as foxglove.
    pub(crate) fn send_exact(
        &mut self,
        channel: Channel,
        message: &impl prost::Message,
    ) -> Result<(), RecordError> {
        self.send_as(channel, |buffer| {
            message.encode(buffer).map_err(|error| error.to_string())
        })
    }

    /// Sends a message that `encode` appends to a buffer.
    fn send_as(
        &mut self,
        channel: Channel,
        encode: impl FnOnce(&mut Vec<u8>) -> Result<(), String>,
    ) -> Result<(), RecordError> {
        self.buffer.clear();
        encode(&mut self.buffer).map_err(|reason| RecordError::encode(channel.topic, reason))?;
        self.chunk += self.buffer.len() as u64 + MORE;
        if self.chunk > LARGEST - MORE {
            let reason = "a tick takes more than 512 MiB, which no reader takes";
            return Err(RecordError::encode(channel.topic, reason));
        }
        let header = MessageHeader {
            channel_id: channel.id,
            sequence: self.sequence,
            log_time: self.now,
            publish_time: self.now,
        };
        let writer = self.writer.as_mut().ok_or(RecordError::Ended)?;
        Ok(writer.write_to_known_channel(&header, &self.buffer)?)
    }

    /// Sends a log line at the time of the tick that was begun last.
    pub(crate) fn log(&mut self, channel: Channel, mut line: Log) -> Result<(), RecordError> {
        line.timestamp = Some(timestamp(self.now));
        self.send(channel, &line)
    }

    /// Ends the current chunk.
    pub(crate) fn flush(&mut self) -> Result<(), RecordError> {
        self.chunk = 0;
        Ok(self.writer()?.flush()?)
    }

    /// Stores for readers how many ticks were left out at the end.
    pub(crate) fn ends_in_gap(&mut self, ticks: u64) -> Result<(), RecordError> {
        let metadata = BTreeMap::from([(GAP_TICKS.to_owned(), ticks.to_string())]);
        let name = GAP.to_owned();
        Ok(self
            .writer()?
            .write_metadata(&Metadata { name, metadata })?)
    }

    fn writer(&mut self) -> Result<&mut Writer<NoSeek<Gate<W>>>, RecordError> {
        self.writer.as_mut().ok_or(RecordError::Ended)
    }

    /// Ends the current chunk if it is larger than [`LARGE`], however few ticks it has.
    pub(crate) fn flush_if_large(&mut self) -> Result<(), RecordError> {
        if self.chunk > LARGE {
            self.flush()?;
        }
        Ok(())
    }

    /// Writes the index and returns the output.
    pub(crate) fn finish(mut self) -> Result<W, RecordError> {
        let mut writer = self.writer.take().ok_or(RecordError::Ended)?;
        writer.finish()?;
        let mut out = writer.into_inner().into_inner().out;
        let failed = RecordError::io("cannot write the end of the recording");
        out.flush().map_err(failed)?;
        Ok(out)
    }
}
