use std::convert::Infallible;
use std::fmt::Display;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, sync_channel};

use clamber_climber::{ClimberInput, ClimberState, Knockback, StepReport};
use clamber_colossus::{Creature, CreatureEvent};
use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::rig::{Palette, Skeleton};
use clamber_surface::surface::SkinnedSurface;
use foxglove::messages::Log;

use super::tick::ClimberEncoder;
use super::{ClimberTick, RecordingInfo};
use crate::chunks::Taken;
use crate::names::{name_of, part_name};
use crate::recorder::create;
use crate::views::{CREATURE, FigureJoints, TakenFigure, brain, brain_lines, line};
use crate::{OfClimber, RecordError, RecordOptions, RecorderOf};

/// The data of one tick for [`Recorder::tick`], as it is at the end of the tick.
#[derive(Clone, Copy, Debug)]
pub struct TickView<'a> {
    /// Number of the tick: any number for the first tick, then one more than the number of the tick before.
    pub tick: u64,
    /// The climber's input in this tick.
    pub input: &'a ClimberInput,
    /// [`StepRules::knockback`](clamber_climber::StepRules::knockback) of the climber's step in this tick.
    pub knockback: Option<Knockback>,
    /// The climber's state after its step.
    pub state: &'a ClimberState,
    /// The report of the climber's step.
    pub report: &'a StepReport,
    /// The creature's surface.
    pub surface: &'a SkinnedSurface,
    /// The palette that posed the surface.
    pub palette: &'a Palette,
    /// A hash of the rest of the scene, for a replay to compare; 0 if there is nothing else.
    pub scene_fingerprint: u64,
}

/// A figure for [`Recorder::figure`], as it is drawn at the end of a tick, such as the climber's body.
#[derive(Clone, Copy, Debug)]
pub struct FigureView<'a> {
    /// Name of the figure, for example `"hero"`. The frames of its joints are called `hero/hips` and so on. The names
    /// `creature`, `climber`, `world` and `z_up` are taken.
    pub name: &'a str,
    /// Its skeleton: the same in every call with this name.
    pub skeleton: &'a Skeleton,
    /// The palette that poses it.
    pub palette: &'a Palette,
    /// Transform of the figure from model space to world space.
    pub world_from_model: Similarity,
}

/// Writes a recording of one climber and its creature, as [`RecorderOf`] describes.
pub type Recorder<W> = RecorderOf<OfClimber, W>;

/// Data that a climber's recorder keeps from tick to tick.
#[derive(Debug)]
pub struct ClimberMemory {
    /// Name of the creature, for the log.
    creature: String,
    /// Names of the creature's joints, for the log.
    joints: Vec<String>,
    /// Frames of the creature's joints.
    frames: Arc<FigureJoints>,
    /// The figures that were recorded.
    figures: Vec<Arc<FigureJoints>>,
    /// Memory of palettes that were written.
    palettes: Receiver<Vec<Affine>>,
}

/// Largest number of palettes whose memory is kept.
const MOST_PALETTES: u32 = 256;

impl Recorder<BufWriter<File>> {
    /// A recorder that writes to a new file. An existing file at that path is overwritten.
    ///
    /// # Errors
    /// [`RecordError::Io`] if the file cannot be created, and as [`Recorder::new`].
    pub fn create(
        path: impl AsRef<Path>,
        info: &RecordingInfo,
        skeleton: &Skeleton,
        options: RecordOptions,
    ) -> Result<Self, RecordError> {
        Self::new(create(path.as_ref())?, info, skeleton, options)
    }
}

impl<W: Write + Send + 'static> Recorder<W> {
    /// A recorder that writes to `out`, which it owns.
    ///
    /// `info.version` is ignored: the file gets [`RecordingInfo::VERSION`].
    ///
    /// # Errors
    /// [`RecordError::TickSeconds`] if `info.tick_seconds` is not positive or not finite, [`RecordError::Write`] if
    /// `out` fails, [`RecordError::Io`] if the thread cannot be started.
    pub fn new(
        out: W,
        info: &RecordingInfo,
        skeleton: &Skeleton,
        options: RecordOptions,
    ) -> Result<Self, RecordError> {
        // As many palettes as a chunk has, within reason: the game's thread needs no more at once.
        let (written, palettes) =
            sync_channel(options.chunk_ticks.clamp(1, MOST_PALETTES) as usize);
        let (mut encoder, output) = ClimberEncoder::begin(out, info, options.skin_points, written)?;
        let joints = skeleton.joints().iter().map(|joint| joint.name.clone());
        let memory = ClimberMemory {
            creature: info.creature.clone(),
            joints: joints.collect(),
            frames: Arc::new(FigureJoints::new(CREATURE, skeleton)),
            figures: Vec::new(),
            palettes,
        };
        Self::start(output, memory, options, move |data, output| {
            encoder.tick(data, output)
        })
    }
}

impl<W: Write> Recorder<W> {
    /// Records a tick.
    ///
    /// The surface is only read: recording does not change [`SkinnedSurface::diagnostics`].
    ///
    /// # Errors
    /// [`RecordError::Order`] unless the tick's number is one more than the last one's, and
    /// [`RecordError::JointCount`] for a palette that does not fit the surface. Such a tick is not recorded, but
    /// recording can go on. [`RecordError::Write`] or another error if an earlier chunk could not be written, and
    /// [`RecordError::Ended`] at every call after that.
    ///
    /// # Panics
    /// If `out` panicked while an earlier chunk was written: that panic is resumed here.
    pub fn tick(&mut self, view: &TickView<'_>) -> Result<(), RecordError> {
        self.chunks.check(view.tick)?;
        let mesh = view.surface.mesh().joint_count();
        let palette = view.palette.matrices().len();
        if mesh != palette {
            return Err(RecordError::JointCount { mesh, palette });
        }
        let memory = self.memory.palettes.try_recv().unwrap_or_default();
        let data = ClimberTick::new(view, &self.options, &self.memory.frames, memory);
        let is_due = data.creature.is_some();
        let mut taken = Taken::new(view.tick, data, is_due);
        taken.lines = self.lines(view);
        self.chunks.push(taken)
    }

    /// The log lines of the climber's events.
    fn lines(&self, view: &TickView<'_>) -> Vec<Log> {
        let (creature, joints) = (&self.memory.creature, &self.memory.joints);
        let attached = view.state.support.map(|support| support.attachment);
        let named = |obstacle| {
            let name = name_of(&self.names, obstacle);
            match attached {
                Some(at) if at.obstacle == obstacle && name == *creature => {
                    let mesh = view.surface.mesh();
                    let joint = at.material.triangle().and_then(|one| mesh.joint_of(one));
                    let joint = joint.and_then(|joint| joints.get(joint.index()));
                    let joint = joint.filter(|name| !name.is_empty());
                    part_name(creature, joint.map(String::as_str))
                }
                _ => name,
            }
        };
        let events = view.report.events.iter();
        events.map(|event| line("climber", event, named)).collect()
    }

    /// Records the joints of a figure at the tick recorded last, for people to look at: a replay does not compare them.
    /// Nothing is recorded in ticks in which no transforms are due ([`RecordOptions::transforms_every`]).
    ///
    /// # Errors
    /// [`RecordError::FigureJoints`] if the palette, the skeleton and the skeleton of this name's first call differ in
    /// their number of joints; [`RecordError::NoTick`] before the first tick; [`RecordError::Ended`] after writing
    /// failed. Nothing is recorded then.
    pub fn figure(&mut self, view: &FigureView<'_>) -> Result<(), RecordError> {
        let is_due = self.chunks.last()?.is_due;
        let figures = &mut self.memory.figures;
        let known = figures.iter().find(|known| known.figure == view.name);
        let (skeleton, palette) = (view.skeleton.joints().len(), view.palette.matrices().len());
        if palette != skeleton || known.is_some_and(|known| known.joints.len() != skeleton) {
            return Err(RecordError::FigureJoints {
                figure: view.name.to_owned(),
                skeleton,
                palette,
            });
        }
        if !is_due {
            return Ok(());
        }
        let joints = known.cloned().unwrap_or_else(|| {
            let joints = Arc::new(FigureJoints::new(view.name, view.skeleton));
            figures.push(Arc::clone(&joints));
            joints
        });
        let figure = TakenFigure::new(joints, view.palette, view.world_from_model);
        self.chunks.last()?.data.figures.push(figure);
        Ok(())
    }

    /// Records the brain of the creature at the tick recorded last, for people to look at. State, moods and senses are
    /// recorded at every change of state, and whenever transforms are due ([`RecordOptions::transforms_every`]). Events
    /// and blows go to the log. A replay does not compare them.
    ///
    /// # Errors
    /// [`RecordError::NoTick`] before the first tick; [`RecordError::Ended`] after writing failed.
    pub fn brain(&mut self, creature: &Creature) -> Result<(), RecordError> {
        let taken = self.chunks.last()?;
        let events = &creature.report().events;
        let entered = |event: &CreatureEvent| matches!(event, CreatureEvent::Entered { .. });
        let is_due = taken.is_due || events.iter().any(entered);
        taken.data.brain = is_due.then(|| brain(creature));
        let lines = brain_lines(creature, &self.memory.creature);
        taken.lines.extend(lines);
        Ok(())
    }

    /// Records a snapshot of the scene after the tick recorded last.
    ///
    /// `scene` is a text, in the caller's own format, from which the scene can resume after that tick. It can leave out
    /// the climber's state, since every tick has it. [`Recording::snapshot`](crate::Recording::snapshot) reads both
    /// back.
    ///
    /// # Errors
    /// [`RecordError::NoTick`] before the first tick, [`RecordError::Ended`] after writing failed.
    pub fn snapshot(&mut self, scene: &str) -> Result<(), RecordError> {
        let scene = scene.to_owned();
        self.snapshot_with(move || Ok::<_, Infallible>(scene))
    }

    /// Records a snapshot as [`Recorder::snapshot`] does, but the recorder's thread calls `scene` to make the text,
    /// while the game runs. So `scene` has to own a copy of the data that it writes.
    ///
    /// If `scene` fails, the recording ends before its tick, as if the file could not be written: a later
    /// [`Recorder::tick`], or [`Recorder::finish`], returns [`RecordError::Encode`] with the reason. If `scene` panics,
    /// that panic is resumed there.
    ///
    /// # Errors
    /// As [`Recorder::snapshot`].
    pub fn snapshot_with<E: Display>(
        &mut self,
        scene: impl FnOnce() -> Result<String, E> + Send + 'static,
    ) -> Result<(), RecordError> {
        let text = move || {
            let text = scene().map_err(|error| error.to_string());
            text.map(String::into_bytes)
        };
        self.chunks.last()?.saved.push(Box::new(text));
        Ok(())
    }
}
