use std::io::Write;

use clamber_surface::rig::Skeleton;
use clamber_surface::skin::skin_into;
use clamber_surface::surface::matrices_fingerprint;
use foxglove::Encode;
use foxglove::messages::{FrameTransforms, Log, PointCloud, SceneUpdate};
use glam::Vec3;
use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{WriteOptions, Writer};

use crate::messages::{Brain, Snapshot, Tick, Touched};
use crate::taken::{Taken, TakenSkin};
use crate::views::{Frames, Scene, Skin, line};
use crate::{RecordError, RecordingInfo, topics};

/// The channel of each topic.
struct Channels {
    tick: u16,
    snapshot: u16,
    transforms: u16,
    figure: u16,
    brain: u16,
    scene: u16,
    skin: u16,
    touched: u16,
    log: u16,
}

/// Encodes ticks and writes them.
pub(crate) struct Writing<W: Write> {
    writer: Writer<NoSeek<W>>,
    channels: Channels,
    tick_seconds: f64,
    sequence: u32,
    frames: Frames,
    skin: Skin,
    scene: Scene,
    /// Both kept for their memory.
    positions: Vec<Vec3>,
    buffer: Vec<u8>,
}

impl<W: Write> Writing<W> {
    pub(crate) fn new(
        out: W,
        info: &RecordingInfo,
        skeleton: &Skeleton,
        skin_points: usize,
    ) -> Result<Self, RecordError> {
        let tick_seconds = info.tick_seconds;
        if !(tick_seconds > 0.0 && tick_seconds.is_finite()) {
            return Err(RecordError::TickSeconds(tick_seconds));
        }
        // A chunk stays in memory until `flush` ends it, so that nothing is patched in the file.
        let write = WriteOptions::new()
            .compression(None)
            .chunk_size(None)
            .disable_seeking(true)
            .profile("")
            .library(format!("clamber_record {}", RecordingInfo::VERSION));
        let mut writer = write.create(NoSeek::new(out))?;
        for (name, metadata) in [
            (RecordingInfo::METADATA, info.to_metadata()),
            (RecordingInfo::SETTINGS, info.settings.clone()),
        ] {
            let name = name.to_owned();
            writer.write_metadata(&Metadata { name, metadata })?;
        }
        let channels = Channels {
            tick: channel::<Tick, W>(&mut writer, topics::TICK)?,
            snapshot: channel::<Snapshot, W>(&mut writer, topics::SNAPSHOT)?,
            transforms: channel::<FrameTransforms, W>(&mut writer, topics::TRANSFORMS)?,
            figure: channel::<FrameTransforms, W>(&mut writer, topics::FIGURE)?,
            brain: channel::<Brain, W>(&mut writer, topics::BRAIN)?,
            scene: channel::<SceneUpdate, W>(&mut writer, topics::SCENE)?,
            skin: channel::<PointCloud, W>(&mut writer, topics::SKIN)?,
            touched: channel::<Touched, W>(&mut writer, topics::TOUCHED)?,
            log: channel::<Log, W>(&mut writer, topics::LOG)?,
        };
        Ok(Self {
            writer,
            channels,
            tick_seconds,
            sequence: 0,
            frames: Frames::new(skeleton),
            skin: Skin::new(skin_points),
            scene: Scene::new(&info.climber),
            positions: Vec::new(),
            buffer: Vec::new(),
        })
    }

    /// Writes a chunk of ticks.
    pub(crate) fn chunk(&mut self, ticks: &mut [Taken]) -> Result<(), RecordError> {
        for taken in ticks {
            self.tick(taken)?;
        }
        Ok(self.writer.flush()?)
    }

    /// Writes the index and gives back the output.
    pub(crate) fn finish(mut self) -> Result<W, RecordError> {
        self.writer.finish()?;
        let mut out = self.writer.into_inner().into_inner();
        out.flush().map_err(|source| RecordError::Io {
            what: "cannot write the end of the recording".to_owned(),
            source,
        })?;
        Ok(out)
    }

    fn tick(&mut self, taken: &mut Taken) -> Result<(), RecordError> {
        self.sequence = self.sequence.wrapping_add(1);
        let message = Tick {
            tick: taken.tick,
            input: (&taken.input).into(),
            state: (&taken.state).into(),
            report: taken.report,
            state_fingerprint: taken.state.fingerprint(),
            palette_fingerprint: matrices_fingerprint(&taken.matrices),
            scene_fingerprint: taken.scene_fingerprint,
        };
        let now = self.nanoseconds(taken.tick);
        self.buffer.clear();
        let written = message.write(&mut self.buffer);
        written.map_err(|reason| RecordError::Encode {
            topic: topics::TICK,
            reason,
        })?;
        self.write(self.channels.tick, now)?;
        for event in &taken.events {
            self.send(self.channels.log, topics::LOG, now, &line(now, event))?;
        }
        if taken.transforms_due {
            let frames = self.frames.update(now, taken);
            encode(&mut self.buffer, topics::TRANSFORMS, frames)?;
            self.write(self.channels.transforms, now)?;
        }
        for figure in taken.figures.drain(..) {
            let message = figure.message(now);
            self.send(self.channels.figure, topics::FIGURE, now, &message)?;
        }
        if let Some(brain) = taken.brain.take() {
            for line in brain.log(now) {
                self.send(self.channels.log, topics::LOG, now, &line)?;
            }
            if let Some(brain) = &brain.brain {
                self.send(self.channels.brain, topics::BRAIN, now, brain)?;
            }
        }
        // The mesh is released as soon as possible: until then an edit has to copy it.
        if let Some(skin) = taken.skin.take() {
            self.look(taken, &skin, now)?;
        }
        for scene in taken.snapshots.drain(..) {
            let tick = taken.tick;
            let message = Snapshot { tick, scene };
            self.send(self.channels.snapshot, topics::SNAPSHOT, now, &message)?;
        }
        Ok(())
    }

    /// Writes the views of the skin.
    fn look(&mut self, taken: &Taken, skin: &TakenSkin, now: u64) -> Result<(), RecordError> {
        let touched = Touched::from(skin.touched);
        self.send(self.channels.touched, topics::TOUCHED, now, &touched)?;
        let mut positions = core::mem::take(&mut self.positions);
        let (mesh, matrices) = (&skin.mesh, &taken.matrices);
        skin_into(mesh, matrices, &mut positions).map_err(|error| RecordError::Encode {
            topic: topics::SKIN,
            reason: error.to_string(),
        })?;
        let points = self
            .skin
            .message(now, mesh, &positions, taken.world_from_model.scale);
        let scene = self.scene.message(now, taken, skin, &positions);
        self.positions = positions;
        self.send(self.channels.skin, topics::SKIN, now, &points)?;
        self.send(self.channels.scene, topics::SCENE, now, &scene)
    }

    fn send(
        &mut self,
        channel: u16,
        topic: &'static str,
        now: u64,
        message: &impl Encode,
    ) -> Result<(), RecordError> {
        encode(&mut self.buffer, topic, message)?;
        self.write(channel, now)
    }

    /// Writes the buffer as a message.
    fn write(&mut self, channel_id: u16, now: u64) -> Result<(), RecordError> {
        let header = MessageHeader {
            channel_id,
            sequence: self.sequence,
            log_time: now,
            publish_time: now,
        };
        Ok(self.writer.write_to_known_channel(&header, &self.buffer)?)
    }

    /// The time of a tick since tick 0.
    fn nanoseconds(&self, tick: u64) -> u64 {
        (tick as f64 * self.tick_seconds * 1e9).round() as u64
    }
}

fn encode(
    buffer: &mut Vec<u8>,
    topic: &'static str,
    message: &impl Encode,
) -> Result<(), RecordError> {
    buffer.clear();
    message.encode(buffer).map_err(|error| RecordError::Encode {
        topic,
        reason: error.to_string(),
    })
}

/// Adds a channel for messages of a type.
fn channel<M: Encode, W: Write>(
    writer: &mut Writer<NoSeek<W>>,
    topic: &'static str,
) -> Result<u16, RecordError> {
    let schema = M::get_schema().ok_or_else(|| RecordError::Encode {
        topic,
        reason: "it has no schema".to_owned(),
    })?;
    let schema = writer.add_schema(&schema.name, &schema.encoding, &schema.data)?;
    let encoding = M::get_message_encoding();
    Ok(writer.add_channel(schema, topic, &encoding, &Default::default())?)
}
