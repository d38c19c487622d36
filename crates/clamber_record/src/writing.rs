use std::io::Write;

use clamber_surface::rig::Skeleton;
use clamber_surface::skin::skin_into;
use clamber_surface::surface::matrices_fingerprint;
use foxglove::messages::{FrameTransforms, Log, PointCloud, SceneUpdate};
use glam::Vec3;

use crate::chunks::WriteTicks;
use crate::messages::{Brain, Snapshot, Tick, Touched};
use crate::output::{Channel, Output};
use crate::taken::{Taken, TakenSkin, TakenSnapshot};
use crate::views::{Frames, Scene, Sceneries, Skin, gap_line, line};
use crate::{RecordError, RecordingInfo, topics};

/// The channel of each topic.
struct Channels {
    tick: Channel,
    snapshot: Channel,
    transforms: Channel,
    figure: Channel,
    brain: Channel,
    scene: Channel,
    scenery: Channel,
    skin: Channel,
    touched: Channel,
    log: Channel,
}

/// Encodes ticks and writes them.
pub(crate) struct Writing<W: Write> {
    output: Output<W>,
    channels: Channels,
    frames: Frames,
    skin: Skin,
    scene: Scene,
    scenery: Sceneries,
    /// Name of the creature, for the log.
    creature: String,
    /// Names of the creature's joints, for the log.
    joints: Vec<String>,
    /// Posed positions of the vertices, kept so that their memory is reused.
    positions: Vec<Vec3>,
}

impl<W: Write> Writing<W> {
    pub(crate) fn new(
        out: W,
        info: &RecordingInfo,
        skeleton: &Skeleton,
        skin_points: usize,
    ) -> Result<Self, RecordError> {
        let metadata = [
            (RecordingInfo::METADATA, info.to_metadata()),
            (RecordingInfo::SETTINGS, info.settings.clone()),
        ];
        let mut output = Output::new(out, info.tick_seconds, metadata)?;
        let channels = Channels {
            tick: output.channel::<Tick>(topics::TICK)?,
            snapshot: output.channel::<Snapshot>(topics::SNAPSHOT)?,
            transforms: output.channel::<FrameTransforms>(topics::TRANSFORMS)?,
            figure: output.channel::<FrameTransforms>(topics::FIGURE)?,
            brain: output.channel::<Brain>(topics::BRAIN)?,
            scene: output.channel::<SceneUpdate>(topics::SCENE)?,
            scenery: output.channel::<SceneUpdate>(topics::SCENERY)?,
            skin: output.channel::<PointCloud>(topics::SKIN)?,
            touched: output.channel::<Touched>(topics::TOUCHED)?,
            log: output.channel::<Log>(topics::LOG)?,
        };
        let joints = skeleton.joints().iter().map(|joint| joint.name.clone());
        Ok(Self {
            output,
            channels,
            frames: Frames::new(skeleton),
            skin: Skin::new(skin_points),
            scene: Scene::new(&info.climber, info.tick_seconds),
            scenery: Sceneries::default(),
            creature: info.creature.clone(),
            joints: joints.collect(),
            positions: Vec::new(),
        })
    }

    /// Makes the snapshots of a tick by calling the game's functions for their texts.
    fn snapshots(taken: &mut Taken) -> Result<Vec<Snapshot>, RecordError> {
        let tick = taken.tick;
        let texts = taken.snapshots.drain(..);
        let snapshots = texts.map(|TakenSnapshot(scene)| match scene() {
            Ok(scene) => Ok(Snapshot { tick, scene }),
            Err(reason) => Err(RecordError::Encode {
                topic: topics::SNAPSHOT,
                reason,
            }),
        });
        snapshots.collect()
    }

    fn tick(&mut self, taken: &mut Taken, snapshots: &[Snapshot]) -> Result<(), RecordError> {
        let message = Tick {
            tick: taken.tick,
            input: (&taken.input).into(),
            state: (&taken.state).into(),
            report: taken.report,
            state_fingerprint: taken.state.fingerprint(),
            palette_fingerprint: matrices_fingerprint(&taken.matrices),
            scene_fingerprint: taken.scene_fingerprint,
        };
        let now = self.output.begin(taken.tick);
        if let Some(line) = gap_line(now, taken.gap) {
            self.output.send(self.channels.log, now, &line)?;
        }
        let write = |buffer: &mut Vec<u8>| message.write(buffer);
        self.output.send_as(self.channels.tick, now, write)?;
        for event in &taken.events {
            let named = |obstacle| taken.name_of(obstacle, &self.creature, &self.joints);
            let line = line(now, "climber", event, named);
            self.output.send(self.channels.log, now, &line)?;
        }
        if taken.transforms_due {
            let frames = self.frames.update(now, taken);
            self.output.send(self.channels.transforms, now, frames)?;
        }
        for figure in taken.figures.drain(..) {
            let message = figure.message(now);
            self.output.send(self.channels.figure, now, &message)?;
        }
        if let Some(brain) = taken.brain.take() {
            for line in brain.log(now, &self.creature) {
                self.output.send(self.channels.log, now, &line)?;
            }
            if let Some(brain) = &brain.brain {
                self.output.send(self.channels.brain, now, brain)?;
            }
        }
        // The mesh is released as soon as possible: until then, an edit has to copy it.
        if let Some(skin) = taken.skin.take() {
            self.look(taken, &skin, now)?;
        }
        if let Some(frames) = self.scenery.frames(now, &taken.scenery) {
            self.output.send(self.channels.transforms, now, &frames)?;
        }
        if let Some(shapes) = self.scenery.shapes(now, taken.scenery.drain(..)) {
            self.output.send(self.channels.scenery, now, &shapes)?;
        }
        if let Some(line) = self.scenery.take_line(now) {
            self.output.send(self.channels.log, now, &line)?;
        }
        for snapshot in snapshots {
            self.output.send(self.channels.snapshot, now, snapshot)?;
        }
        Ok(())
    }

    /// Writes the views of the skin.
    fn look(&mut self, taken: &Taken, skin: &TakenSkin, now: u64) -> Result<(), RecordError> {
        let touched = Touched::from(skin.touched);
        self.output.send(self.channels.touched, now, &touched)?;
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
        self.output.send(self.channels.skin, now, &points)?;
        self.output.send(self.channels.scene, now, &scene)
    }
}

impl<W: Write + Send + 'static> WriteTicks<Taken, W> for Writing<W> {
    fn chunk(&mut self, ticks: &mut [Taken]) -> Result<(), RecordError> {
        for taken in ticks {
            let snapshots = match Self::snapshots(taken) {
                Ok(snapshots) => snapshots,
                Err(error) => {
                    // The ticks before this one are kept.
                    self.output.flush()?;
                    return Err(error);
                }
            };
            self.tick(taken, &snapshots)?;
            self.output.flush_if_large()?;
        }
        self.output.flush()
    }

    fn ends_in_gap(&mut self, ticks: u64) -> Result<(), RecordError> {
        let now = self.output.now();
        if let Some(line) = gap_line(now, ticks) {
            self.output.send(self.channels.log, now, &line)?;
        }
        self.output.ends_in_gap(ticks)
    }

    fn finish(self) -> Result<W, RecordError> {
        self.output.finish()
    }
}
