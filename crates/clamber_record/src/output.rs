//! The MCAP file of a recording: metadata, channels, messages.

use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clamber_surface::geometry::Affine;
use clamber_surface::mesh::ColliderMesh;
use clamber_surface::skin::skin_into;
use foxglove::Encode;
use foxglove::messages::{FrameTransform, FrameTransforms, Log, PointCloud, SceneUpdate};
use glam::Vec3;
use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{WriteOptions, Writer};

use crate::chunks::{Chunk, Taken};
use crate::file::METADATA;
use crate::kind::{Entries, Topics};
use crate::messages::Saved;
use crate::source::LARGEST;
use crate::views::{Sceneries, gap_line, skin, timestamp};
use crate::{RecordError, RecordingInfo, topics};

/// A channel: its number, and its topic for errors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Channel {
    id: u16,
    topic: &'static str,
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

/// The file of a recording, with the channels that both kinds have.
pub(crate) struct Output<W: Write> {
    /// `None` once the file is finished.
    writer: Option<McapWriter<W>>,
    is_open: Arc<AtomicBool>,
    tick_seconds: f64,
    sequence: u32,
    /// Time of the tick that was begun last, nanoseconds since tick 0.
    pub(crate) now: u64,
    /// Bytes in the current chunk, with [`MORE`] for each message.
    chunk: u64,
    /// The encoded messages of the current tick, kept so that their memory is reused.
    buffer: Vec<u8>,
    /// Channel and end in `buffer` of each message of the current tick.
    messages: Vec<(u16, usize)>,
    pub(crate) scene: Channel,
    transforms: Channel,
    scenery: Channel,
    saved: Channel,
    log: Channel,
    /// Largest number of points of a skin.
    skin_points: usize,
    /// Posed positions of a creature's vertices, kept so that their memory is reused.
    pub(crate) positions: Vec<Vec3>,
    meshes: Sceneries,
}

type McapWriter<W> = Writer<NoSeek<Gate<W>>>;

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
    /// Begins a file with its metadata: the records of the kind and of the caller's settings.
    pub(crate) fn new(
        out: W,
        tick_seconds: f64,
        (topics, own, settings): (&Topics, Entries, Entries),
        skin_points: usize,
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
        for (name, metadata) in [(topics.metadata, own), (RecordingInfo::SETTINGS, settings)] {
            let entries = metadata.iter();
            let sizes = entries.map(|(key, value)| key.len() + value.len() + TEXTS);
            if sizes.sum::<usize>() as u64 + MORE > METADATA {
                let reason = "names and settings are more than 16 MiB, which no reader takes";
                return Err(RecordError::encode("metadata", reason));
            }
            let name = name.to_owned();
            writer.write_metadata(&Metadata { name, metadata })?;
        }
        Ok(Self {
            scene: add_channel::<_, SceneUpdate>(&mut writer, topics::SCENE, None)?,
            transforms: add_channel::<_, FrameTransforms>(&mut writer, topics::TRANSFORMS, None)?,
            scenery: add_channel::<_, SceneUpdate>(&mut writer, topics::SCENERY, None)?,
            saved: add_channel::<_, Saved>(&mut writer, topics.saved, None)?,
            log: add_channel::<_, Log>(&mut writer, topics::LOG, None)?,
            writer: Some(writer),
            is_open,
            tick_seconds,
            sequence: 0,
            now: 0,
            chunk: 0,
            buffer: Vec::new(),
            messages: Vec::new(),
            skin_points,
            positions: Vec::new(),
            meshes: Sceneries::default(),
        })
    }

    /// Adds a channel for messages of a type, which is called `name`, or as its topic.
    pub(crate) fn channel<M: Encode>(
        &mut self,
        topic: &'static str,
        name: Option<&str>,
    ) -> Result<Channel, RecordError> {
        add_channel::<_, M>(self.writer()?, topic, name)
    }

    /// Writes chunks of ticks, ends the file and returns `out`. `encode` sends the messages of a tick's data. Log
    /// lines, meshes and saved states are sent here.
    pub(crate) fn write<D>(
        mut self,
        mut encode: impl FnMut(D, &mut Self) -> Result<(), RecordError>,
        chunks: &mut dyn Iterator<Item = Chunk<D>>,
    ) -> Result<W, RecordError> {
        for (ticks, lost) in chunks {
            for taken in ticks {
                if let Err(error) = self.tick(taken, &mut encode) {
                    // The ticks before this one are kept, and nothing of this one. The first error tells the cause.
                    let _ = self.flush();
                    return Err(error);
                }
                self.add_to_chunk()?;
                if self.chunk > LARGE {
                    self.flush()?;
                }
            }
            self.flush()?;
            // Readers learn from the metadata how many ticks are missing at the end.
            if let Some(line) = gap_line(lost) {
                self.log(line)?;
                self.add_to_chunk()?;
                let metadata = Entries::from([(GAP_TICKS.to_owned(), lost.to_string())]);
                let name = GAP.to_owned();
                self.writer()?
                    .write_metadata(&Metadata { name, metadata })?;
            }
        }
        let mut writer = self.writer.take().ok_or(RecordError::Ended)?;
        writer.finish()?;
        let mut out = writer.into_inner().into_inner().out;
        let failed = RecordError::io("cannot write the end of the recording");
        out.flush().map_err(failed)?;
        Ok(out)
    }

    /// Sends the messages of a tick.
    fn tick<D>(
        &mut self,
        taken: Taken<D>,
        encode: impl FnOnce(D, &mut Self) -> Result<(), RecordError>,
    ) -> Result<(), RecordError> {
        let tick = taken.tick;
        let states = taken.saved.into_iter().map(|make| {
            make().map(|state| Saved {
                tick,
                state: state.into(),
            })
        });
        let states = states.collect::<Result<Vec<Saved>, String>>();
        let states = states.map_err(|reason| RecordError::encode(self.saved.topic, reason))?;
        self.sequence = self.sequence.wrapping_add(1);
        self.now = (tick as f64 * self.tick_seconds * 1e9).round() as u64;
        encode(taken.data, self)?;
        for state in &states {
            self.send_exact(self.saved, state)?;
        }
        for line in gap_line(taken.gap).into_iter().chain(taken.lines) {
            self.log(line)?;
        }
        let frames = self.meshes.frames(self.now, &taken.scenery);
        if !frames.is_empty() {
            self.transforms(frames)?;
        }
        if let Some(shapes) = self.meshes.shapes(self.now, taken.scenery) {
            self.send(self.scenery, &shapes)?;
        }
        match self.meshes.line.take() {
            Some(line) => self.log(line),
            None => Ok(()),
        }
    }

    /// Sends a message that is not read back.
    pub(crate) fn send(
        &mut self,
        channel: Channel,
        message: &impl Encode,
    ) -> Result<(), RecordError> {
        self.send_as(channel, |buffer| message.encode(buffer))
    }

    /// Sends a message that is read back. prost encodes three times as fast as foxglove.
    pub(crate) fn send_exact(
        &mut self,
        channel: Channel,
        message: &impl prost::Message,
    ) -> Result<(), RecordError> {
        self.send_as(channel, |buffer| message.encode(buffer))
    }

    /// Sends a message that `encode` appends to a buffer. [`Output::add_to_chunk`] writes it.
    fn send_as<E: ToString>(
        &mut self,
        channel: Channel,
        encode: impl FnOnce(&mut Vec<u8>) -> Result<(), E>,
    ) -> Result<(), RecordError> {
        let start = self.buffer.len();
        encode(&mut self.buffer).map_err(|error| RecordError::encode(channel.topic, error))?;
        self.chunk += (self.buffer.len() - start) as u64 + MORE;
        if self.chunk > LARGEST - MORE {
            let reason = "a tick takes more than 512 MiB, which no reader takes";
            return Err(RecordError::encode(channel.topic, reason));
        }
        self.messages.push((channel.id, self.buffer.len()));
        Ok(())
    }

    /// Adds the messages that were sent to the current chunk: those of a whole tick, so that none is written in part.
    fn add_to_chunk(&mut self) -> Result<(), RecordError> {
        let writer = self.writer.as_mut().ok_or(RecordError::Ended)?;
        let mut start = 0;
        for (channel_id, end) in self.messages.drain(..) {
            let header = MessageHeader {
                channel_id,
                sequence: self.sequence,
                log_time: self.now,
                publish_time: self.now,
            };
            writer.write_to_known_channel(&header, &self.buffer[start..end])?;
            start = end;
        }
        self.buffer.clear();
        Ok(())
    }

    /// Sends a log line at the time of the tick that was begun last.
    pub(crate) fn log(&mut self, mut line: Log) -> Result<(), RecordError> {
        line.timestamp = Some(timestamp(self.now));
        self.send(self.log, &line)
    }

    pub(crate) fn transforms(&mut self, frames: Vec<FrameTransform>) -> Result<(), RecordError> {
        self.send(self.transforms, &FrameTransforms { transforms: frames })
    }

    /// Poses the vertices of a mesh into `positions`, and makes the view of the skin in a frame of this name and scale.
    pub(crate) fn skin(
        &mut self,
        frame: (&str, f64),
        (mesh, matrices): (&ColliderMesh, &[Affine]),
    ) -> Result<PointCloud, RecordError> {
        let posed = skin_into(mesh, matrices, &mut self.positions);
        posed.map_err(|error| RecordError::encode(topics::SKIN, error))?;
        let vertices = (mesh, &self.positions[..]);
        Ok(skin(self.now, frame, vertices, self.skin_points))
    }

    /// Ends the current chunk.
    fn flush(&mut self) -> Result<(), RecordError> {
        self.chunk = 0;
        Ok(self.writer()?.flush()?)
    }

    fn writer(&mut self) -> Result<&mut McapWriter<W>, RecordError> {
        self.writer.as_mut().ok_or(RecordError::Ended)
    }
}

/// Adds a channel for messages of a type, which is called `name`, or as its topic. Errors contain the topic.
fn add_channel<W: Write, M: Encode>(
    writer: &mut McapWriter<W>,
    topic: &'static str,
    name: Option<&str>,
) -> Result<Channel, RecordError> {
    let schema = M::get_schema();
    let schema = schema.ok_or_else(|| RecordError::encode(topic, "it has no schema"))?;
    let schema = writer.add_schema(&schema.name, &schema.encoding, &schema.data)?;
    let encoding = M::get_message_encoding();
    let name = name.unwrap_or(topic);
    let id = writer.add_channel(schema, name, &encoding, &Default::default())?;
    Ok(Channel { id, topic })
}
