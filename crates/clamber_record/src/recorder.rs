use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use clamber_climber::{ClimberInput, ClimberState, StepReport};
use clamber_surface::rig::{Palette, Skeleton};
use clamber_surface::surface::SkinnedSurface;
use foxglove::Encode;
use foxglove::messages::{FrameTransforms, Log, PointCloud, SceneUpdate};
use glam::Vec3;
use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{WriteOptions, Writer};

use crate::messages::{Push, Snapshot, Tick, Touched};
use crate::views::{Frames, Scene, Skin, line};
use crate::{RecordError, RecordingInfo, palette_fingerprint, topics};

/// How often what is recorded. Inputs, states and fingerprints are recorded every tick, whatever stands here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordOptions {
    /// Ticks from one message of transforms to the next; 0 for none. Default 4: 15 a second at 60 Hz. A
    /// creature of 45 joints takes 6 kB a message. Lower it for smooth limbs.
    pub transforms_every: u32,
    /// Ticks from one look at the skin to the next, points and touched triangles; 0 for none. Default 30: 2 a
    /// second at 60 Hz: the dearest part. Skins the whole creature and takes some 50 kB a look. Raise it for large creatures.
    pub skin_every: u32,
    /// Points of the skin at most. Default 2000.
    pub skin_points: usize,
    /// Ticks in a chunk. Default 60. A crash loses at most so many.
    pub chunk_ticks: u32,
}

impl Default for RecordOptions {
    fn default() -> Self {
        Self {
            transforms_every: 4,
            skin_every: 30,
            skin_points: 2000,
            chunk_ticks: 60,
        }
    }
}

/// One tick, as it stands at its end.
#[derive(Clone, Copy, Debug)]
pub struct TickView<'a> {
    /// Its number: one more than that of the tick before.
    pub tick: u64,
    /// What the climber was asked for.
    pub input: &'a ClimberInput,
    /// What it became.
    pub state: &'a ClimberState,
    /// What happened on the way.
    pub report: &'a StepReport,
    /// The creature.
    pub surface: &'a SkinnedSurface,
    /// What it was posed by.
    pub palette: &'a Palette,
    /// Of whatever else of the scene a replay is to compare; 0 for nothing.
    pub scene_fingerprint: u64,
}

/// Where messages go.
struct Channels {
    tick: u16,
    snapshot: u16,
    transforms: u16,
    scene: u16,
    skin: u16,
    touched: u16,
    log: u16,
}

/// Writes a recording, chunk by chunk.
///
/// A chunk is held in memory and written as a whole, so that what stands in the file can be read whenever
/// writing stops. Dropped without [`Recorder::finish`], it finishes the file and keeps quiet about errors.
pub struct Recorder<W: Write> {
    writer: Writer<NoSeek<W>>,
    channels: Channels,
    options: RecordOptions,
    tick_seconds: f64,
    last: Option<u64>,
    in_chunk: u32,
    sequence: u32,
    frames: Frames,
    skin: Skin,
    scene: Scene,
    /// Both kept for their memory.
    positions: Vec<Vec3>,
    buffer: Vec<u8>,
}

impl Recorder<BufWriter<File>> {
    /// Into a new file; one of that name is overwritten.
    ///
    /// # Errors
    /// [`RecordError::Io`] if it cannot be made, and as [`Recorder::new`].
    pub fn create(
        path: impl AsRef<Path>,
        info: &RecordingInfo,
        skeleton: &Skeleton,
        options: RecordOptions,
    ) -> Result<Self, RecordError> {
        let path = path.as_ref();
        let file = File::create(path).map_err(|source| RecordError::Io {
            what: format!("cannot create {}", path.display()),
            source,
        })?;
        Self::new(BufWriter::new(file), info, skeleton, options)
    }
}

impl<W: Write> Recorder<W> {
    /// Into anything that takes bytes. `info.version` is not written: the file says which version made it.
    ///
    /// # Errors
    /// [`RecordError::TickSeconds`], [`RecordError::Write`].
    pub fn new(
        out: W,
        info: &RecordingInfo,
        skeleton: &Skeleton,
        options: RecordOptions,
    ) -> Result<Self, RecordError> {
        let tick_seconds = info.tick_seconds;
        if !(tick_seconds > 0.0 && tick_seconds.is_finite()) {
            return Err(RecordError::TickSeconds(tick_seconds));
        }
        // Chunks end where `flush` says, in memory until then: nothing is patched in the file.
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
            scene: channel::<SceneUpdate, W>(&mut writer, topics::SCENE)?,
            skin: channel::<PointCloud, W>(&mut writer, topics::SKIN)?,
            touched: channel::<Touched, W>(&mut writer, topics::TOUCHED)?,
            log: channel::<Log, W>(&mut writer, topics::LOG)?,
        };
        Ok(Self {
            writer,
            channels,
            options,
            tick_seconds,
            last: None,
            in_chunk: 0,
            sequence: 0,
            frames: Frames::new(skeleton),
            skin: Skin::new(options.skin_points),
            scene: Scene::new(info.climber.radius),
            positions: Vec::new(),
            buffer: Vec::new(),
        })
    }

    /// Records a tick. The surface is only read; skin that the views ask for is not counted as touched.
    ///
    /// # Errors
    /// [`RecordError::Order`] unless ticks come one after another, [`RecordError::Write`].
    pub fn tick(&mut self, view: &TickView<'_>) -> Result<(), RecordError> {
        if let Some(last) = self.last
            && view.tick.checked_sub(1) != Some(last)
        {
            let found = view.tick;
            return Err(RecordError::Order { last, found });
        }
        if self.options.chunk_ticks > 0 && self.in_chunk >= self.options.chunk_ticks {
            self.writer.flush()?;
            self.in_chunk = 0;
        }
        self.last = Some(view.tick);
        self.in_chunk += 1;
        self.sequence = self.sequence.wrapping_add(1);
        let push_out = &view.report.push_out;
        let message = Tick {
            tick: view.tick,
            input: view.input.into(),
            state: view.state.into(),
            push_out: Push {
                displacement: push_out.displacement.into(),
                contacts: u32::try_from(push_out.contacts).unwrap_or(u32::MAX),
                deepest: push_out.deepest,
            },
            state_fingerprint: view.state.fingerprint(),
            palette_fingerprint: palette_fingerprint(view.palette),
            scene_fingerprint: view.scene_fingerprint,
        };
        let now = self.nanoseconds(view.tick);
        self.buffer.clear();
        let written = message.write(&mut self.buffer);
        written.map_err(|reason| RecordError::Encode {
            topic: topics::TICK,
            reason,
        })?;
        self.write(self.channels.tick, now)?;
        for event in &view.report.events {
            self.send(self.channels.log, topics::LOG, now, &line(now, event))?;
        }
        self.look(view, now)
    }

    /// Records what the scene needs to go on from the tick recorded last, beside the climber's state, in
    /// words of its own. To be read back by [`Recording::snapshot`](crate::Recording::snapshot).
    ///
    /// # Errors
    /// [`RecordError::NoTick`] before the first tick, [`RecordError::Write`].
    pub fn snapshot(&mut self, scene: &str) -> Result<(), RecordError> {
        let tick = self.last.ok_or(RecordError::NoTick {
            asked: 0,
            ticks: None,
        })?;
        let scene = scene.to_owned();
        let now = self.nanoseconds(tick);
        let message = Snapshot { tick, scene };
        self.send(self.channels.snapshot, topics::SNAPSHOT, now, &message)
    }

    /// Writes what is left, and the index; gives back where it was written to.
    ///
    /// # Errors
    /// [`RecordError::Write`].
    pub fn finish(mut self) -> Result<W, RecordError> {
        self.writer.finish()?;
        let mut out = self.writer.into_inner().into_inner();
        out.flush().map_err(|source| RecordError::Io {
            what: "cannot write the end of the recording".to_owned(),
            source,
        })?;
        Ok(out)
    }

    /// What people look at, in the ticks where it is due.
    fn look(&mut self, view: &TickView<'_>, now: u64) -> Result<(), RecordError> {
        let due = |every: u32| every > 0 && view.tick.is_multiple_of(u64::from(every));
        if due(self.options.transforms_every) {
            let world_from_model = view.surface.world_from_model();
            let frames = self
                .frames
                .update(now, view.state, world_from_model, view.palette);
            encode(&mut self.buffer, topics::TRANSFORMS, frames)?;
            self.write(self.channels.transforms, now)?;
        }
        if due(self.options.skin_every) {
            let touched = Touched::from(view.surface.diagnostics());
            self.send(self.channels.touched, topics::TOUCHED, now, &touched)?;
            let mut positions = core::mem::take(&mut self.positions);
            view.surface.skin_all(&mut positions);
            let mesh = view.surface.mesh();
            let scale = view.surface.world_from_model().scale;
            let skin = self.skin.message(now, mesh, &positions, scale);
            let scene = self
                .scene
                .message(now, view.state, view.surface, &positions);
            self.positions = positions;
            self.send(self.channels.skin, topics::SKIN, now, &skin)?;
            self.send(self.channels.scene, topics::SCENE, now, &scene)?;
        }
        Ok(())
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

    /// Writes what stands in the buffer.
    fn write(&mut self, channel_id: u16, now: u64) -> Result<(), RecordError> {
        let header = MessageHeader {
            channel_id,
            sequence: self.sequence,
            log_time: now,
            publish_time: now,
        };
        Ok(self.writer.write_to_known_channel(&header, &self.buffer)?)
    }

    /// Since tick 0.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::messages::{Input, Vector};
    use clamber_climber::{Climber, ClimberConfig};
    use glam::DVec3;
    use prost::Message;

    #[test]
    fn every_bit_of_a_number_survives_a_negative_zero_and_the_smallest_too() {
        let state = ClimberState {
            velocity: DVec3::new(-0.0, f64::from_bits(1), -f64::MAX),
            ..*Climber::new(ClimberConfig::default(), DVec3::ZERO)
                .unwrap()
                .state()
        };
        for walk in [
            DVec3::new(-0.0, 0.0, 1.0),
            DVec3::new(0.0, -0.0, -f64::MIN_POSITIVE),
            DVec3::ZERO,
        ] {
            for state in [
                state,
                ClimberState {
                    velocity: DVec3::ZERO,
                    ..state
                },
            ] {
                let push_out = Push::default();
                let message = Tick {
                    input: Input {
                        walk: walk.into(),
                        jump: true,
                    },
                    state: (&state).into(),
                    push_out,
                    ..Tick::default()
                };
                let mut buffer = Vec::new();
                message.write(&mut buffer).unwrap();
                let read = Tick::decode(&buffer[..]).unwrap();
                let bits = |v: Vector| [v.x, v.y, v.z].map(f64::to_bits);
                assert_eq!(bits(read.input.walk), bits(message.input.walk), "{walk}");
                let restored = read.state.to_climber().unwrap();
                assert_eq!(restored.fingerprint(), state.fingerprint(), "{state:?}");
            }
        }
    }
}
