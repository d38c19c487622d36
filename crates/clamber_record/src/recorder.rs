use std::convert::Infallible;
use std::fmt::Display;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::Arc;

use clamber_climber::{ClimberInput, ClimberState, StepReport};
use clamber_colossus::Creature;
use clamber_surface::geometry::Similarity;
use clamber_surface::rig::{Palette, Skeleton};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::ObstacleId;

use crate::chunks::{Chunks, TakenTick};
use crate::names::ObstacleNames;
use crate::taken::{Taken, TakenSnapshot};
use crate::views::{FigureJoints, SceneryNames, SceneryView, TakenBrain, TakenFigure};
use crate::writing::Writing;
use crate::{OfClimber, RecordError, RecordingInfo, RecordingKind};

/// Options of a recorder: how often views for people are recorded, and how large chunks are.
///
/// Inputs, states, fingerprints and events are recorded every tick, with any options.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordOptions {
    /// Ticks between two messages of transforms (of the creature and of figures) and of brains; 0 for none. Default 4:
    /// 15 messages a second at 60 Hz. A message takes 6 kB for a creature of 45 joints. Lower it for smooth motion of
    /// limbs.
    pub transforms_every: u32,
    /// Ticks between two views of the skin and of the climber's body and support; 0 for none. Default 4, like the
    /// transforms: a skin that is recorded less often lags behind the joints. Each view skins the whole creature and
    /// takes about 12 kB. Raise both for large creatures.
    ///
    /// Until a view is written, it shares the mesh with the surface. The first edit in that time has to copy the mesh.
    pub skin_every: u32,
    /// Ticks between two views of the triangles that queries touched; 0 for none. Default 60: once a second at 60 Hz.
    /// These triangles are recorded only in ticks with a view of the skin, and shown until the next one. They are the
    /// most expensive part: a view takes about 50 kB.
    pub touched_every: u32,
    /// Largest number of points in a view of the skin. Default 1000; 0 means 1.
    pub skin_points: usize,
    /// Ticks in a chunk. Default 60; 0 means 1. A crash loses the chunk that is being gathered and the chunks that are
    /// not yet written: up to ten in all, one or two if the disk keeps up. Raise it for fewer, larger writes. Each tick
    /// stays in memory with its palette until its chunk is written.
    pub chunk_ticks: u32,
    /// Whether the game waits if the disk is slower than the game for some seconds. False, the default: the game is not
    /// held up. Ticks are left out, from the beginning of a chunk to the next tick from which a replay can start;
    /// [`RecorderOf::dropped`] counts them, and the log reports them. True: the game waits and no tick is lost, for
    /// programs that do not play in real time.
    ///
    /// Ticks are left out only once two ticks have a snapshot of the scene. Until then the game waits, because without
    /// a snapshot no replay could continue after a gap. An arena's recorder makes the snapshots itself.
    pub waits: bool,
}

impl RecordOptions {
    /// The default options, but the game waits for a slow disk, so that no tick is lost.
    pub fn waiting() -> Self {
        Self {
            waits: true,
            ..Self::default()
        }
    }
}

impl Default for RecordOptions {
    fn default() -> Self {
        Self {
            transforms_every: 4,
            skin_every: 4,
            touched_every: 60,
            skin_points: 1000,
            chunk_ticks: 60,
            waits: false,
        }
    }
}

/// The data of one tick for [`Recorder::tick`], as it is at the end of the tick.
#[derive(Clone, Copy, Debug)]
pub struct TickView<'a> {
    /// Number of the tick: any number for the first tick, then one more than the number of the tick before.
    pub tick: u64,
    /// The climber's input in this tick.
    pub input: &'a ClimberInput,
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
    /// Name of the figure, for example `"hero"`. The frames of its joints are called `hero/hips` and so on. Choose a
    /// name that no joint of the creature has.
    pub name: &'a str,
    /// Its skeleton: the same in every call with this name.
    pub skeleton: &'a Skeleton,
    /// The palette that poses it.
    pub palette: &'a Palette,
    /// Transform of the figure from model space to world space.
    pub world_from_model: Similarity,
}

/// Writes a recording, chunk by chunk, on a thread of its own.
///
/// `tick` only copies the tick. When a chunk is complete, the thread skins, encodes and writes its ticks in order,
/// while the game runs. If the thread falls behind by some seconds, either ticks are left out, counted and logged, or
/// the game waits: see [`RecordOptions::waits`].
///
/// A chunk is held in memory and written as a whole, so the file is readable up to the last written chunk
/// whenever writing stops. A recorder that is dropped without [`RecorderOf::finish`] finishes the file too, but
/// ignores errors.
///
/// [`Recorder`] records one climber, [`ArenaRecorder`](crate::ArenaRecorder) an arena.
pub struct RecorderOf<K: RecordingKind, W: Write> {
    pub(crate) options: RecordOptions,
    pub(crate) names: ObstacleNames,
    pub(crate) scenery: SceneryNames,
    pub(crate) memory: K::Memory,
    pub(crate) chunks: Chunks<K::Taken, W>,
}

/// Writes a recording of one climber and its creature, as [`RecorderOf`] describes.
pub type Recorder<W> = RecorderOf<OfClimber, W>;

/// Data that a climber's recorder keeps from tick to tick: the figures that were recorded.
#[derive(Debug, Default)]
pub struct ClimberMemory {
    figures: Vec<Arc<FigureJoints>>,
}

impl<K: RecordingKind, W: Write> RecorderOf<K, W> {
    /// Names an obstacle in the log from the next tick on. In a recording of one climber, give the creature the name in
    /// [`RecordingInfo::creature`]: then the log also names the part of the creature that the climber is on. In a
    /// recording of an arena, creatures and fighters already have the names in [`ArenaInfo`](crate::ArenaInfo).
    pub fn name(&mut self, obstacle: ObstacleId, name: &str) {
        let names = Arc::make_mut(&mut self.names);
        names.retain(|(id, _)| *id != obstacle);
        names.push((obstacle, name.to_owned()));
    }

    /// True if transforms are due in the tick recorded last: see [`RecordOptions::transforms_every`]. In other ticks,
    /// figures and meshes that were recorded before need not be prepared.
    ///
    /// # Errors
    /// [`RecordError::NoTick`] before the first tick; [`RecordError::Ended`] after writing failed.
    pub fn is_due(&mut self) -> Result<bool, RecordError> {
        Ok(self.chunks.last()?.is_due())
    }

    /// Records a mesh at the tick recorded last, for people to look at, such as the ground or a rock. The first call
    /// with a name records the mesh's shape and place, and later calls record its place if transforms are due
    /// ([`RecordOptions::transforms_every`]). Call it once for a mesh that stands still.
    ///
    /// # Errors
    /// [`RecordError::NoTick`] before the first tick; [`RecordError::Ended`] after writing failed.
    pub fn scenery(&mut self, view: &SceneryView<'_>) -> Result<(), RecordError> {
        let last = self.chunks.last()?;
        let taken = self.scenery.take(view, last.is_due());
        last.scenery().extend(taken);
        Ok(())
    }

    /// Number of ticks left out so far because the disk was too slow: see [`RecordOptions::waits`]. A gap ends at a
    /// tick with a snapshot or a saved state.
    pub fn dropped(&self) -> u64 {
        self.chunks.dropped()
    }

    /// Writes the remaining ticks and the index, and returns `out`.
    ///
    /// # Errors
    /// [`RecordError::Write`] or another error if a chunk or the index could not be written; [`RecordError::Ended`] if
    /// an earlier call has returned that error already.
    ///
    /// # Panics
    /// If `out` panicked: that panic is resumed here.
    pub fn finish(mut self) -> Result<W, RecordError> {
        self.chunks.finish()
    }
}

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

/// Creates a file. An existing file at that path is overwritten.
pub(crate) fn create(path: &Path) -> Result<BufWriter<File>, RecordError> {
    let file = File::create(path).map_err(|source| RecordError::Io {
        what: format!("cannot create {}", path.display()),
        source,
    })?;
    Ok(BufWriter::new(file))
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
        let writing = Writing::new(out, info, skeleton, options.skin_points)?;
        Ok(Self {
            options,
            names: ObstacleNames::default(),
            scenery: SceneryNames::default(),
            memory: ClimberMemory::default(),
            chunks: Chunks::start(writing, (options.chunk_ticks, options.waits))?,
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
        let (mesh, palette) = (
            view.surface.mesh().joint_count(),
            view.palette.matrices().len(),
        );
        if mesh != palette {
            return Err(RecordError::JointCount { mesh, palette });
        }
        let (options, names) = (&self.options, &self.names);
        self.chunks.push(view.tick, |taken| match taken {
            Some(taken) => {
                taken.take(view, options, names);
                None
            }
            None => Some(Taken::new(view, options, names)),
        })
    }

    /// Records the joints of a figure at the tick recorded last, for people to look at: a replay does not compare them.
    /// Nothing is recorded in ticks in which no transforms are due ([`RecordOptions::transforms_every`]).
    /// # Errors
    /// [`RecordError::FigureJoints`] if the palette, the skeleton and the skeleton of this name's first call differ in
    /// their number of joints; [`RecordError::NoTick`] before the first tick; [`RecordError::Ended`] after writing
    /// failed. Nothing is recorded then.
    pub fn figure(&mut self, view: &FigureView<'_>) -> Result<(), RecordError> {
        let is_due = self.chunks.last()?.transforms_due;
        let figures = &mut self.memory.figures;
        let known = figures.iter().find(|known| known.figure == view.name);
        let (skeleton, palette) = (view.skeleton.joints().len(), view.palette.matrices().len());
        if palette != skeleton || known.is_some_and(|known| known.len() != skeleton) {
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
        self.chunks.last()?.figures.push(figure);
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
        taken.brain = Some(TakenBrain::new(creature, taken.transforms_due));
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
        let text = move || scene().map_err(|error| error.to_string());
        let taken = TakenSnapshot(Box::new(text));
        self.chunks.last()?.snapshots.push(taken);
        Ok(())
    }
}
