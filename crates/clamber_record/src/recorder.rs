use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread::JoinHandle;

use clamber_climber::{ClimberInput, ClimberState, StepReport};
use clamber_colossus::Creature;
use clamber_surface::geometry::Similarity;
use clamber_surface::rig::{Palette, Skeleton};
use clamber_surface::surface::SkinnedSurface;

use crate::taken::Taken;
use crate::views::{FigureJoints, TakenBrain, TakenFigure};
use crate::writing::Writing;
use crate::{RecordError, RecordingInfo};

/// How often views for people are recorded, and how large chunks are.
///
/// Inputs, states, fingerprints and events are recorded every tick, whatever the options.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordOptions {
    /// Ticks between two messages of transforms, of the creature and of figures, and of brains; 0 for none. Default 4: 15 messages a second at 60 Hz. A
    /// message takes 6 kB for a creature of 45 joints. Lower it for smooth motion of limbs.
    pub transforms_every: u32,
    /// Ticks between two views of the skin, with its points and the touched triangles; 0 for none. Default 30: 2
    /// views a second at 60 Hz. This is the most expensive part: each view skins the whole creature and takes some
    /// 50 kB. Raise it for large creatures.
    ///
    /// Until a view is written, it shares the surface's mesh. The first edit in that time has to copy the mesh.
    pub skin_every: u32,
    /// Largest number of points in a view of the skin. Default 2000; 0 means 1.
    pub skin_points: usize,
    /// Ticks in a chunk. Default 60; 0 means 1. A crash loses the chunk being gathered and those not yet written:
    /// up to three in all, one or two if the disk keeps up. Raise it for fewer, larger writes. Each tick of a chunk
    /// waits in memory with its palette.
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

/// What a game passes to [`Recorder::tick`]: the data of one tick, as it is at the end of the tick.
#[derive(Clone, Copy, Debug)]
pub struct TickView<'a> {
    /// Number of the tick: any for the first tick, then one more than the number of the tick before.
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
    /// A hash of the rest of the scene, for a replay to compare; 0 for nothing.
    pub scene_fingerprint: u64,
}

/// What a game passes to [`Recorder::figure`]: a figure as it is drawn at the end of a tick, such as the climber's body.
#[derive(Clone, Copy, Debug)]
pub struct FigureView<'a> {
    /// Name of the figure, for example `"hero"`. The frames of its joints are called `hero/hips` and so on. Choose a name
    /// that no joint of the creature has.
    pub name: &'a str,
    /// Its skeleton: the same at every call with this name.
    pub skeleton: &'a Skeleton,
    /// The palette that poses it.
    pub palette: &'a Palette,
    /// Where it is drawn.
    pub world_from_model: Similarity,
}

/// Writes a recording, chunk by chunk, on a thread of its own.
///
/// [`Recorder::tick`] only copies the tick. Once a chunk is complete, the thread skins, encodes and writes its
/// ticks, in their order, while the game goes on. If the thread falls behind, the game waits: no tick is left
/// out.
///
/// A chunk is held in memory and written as a whole, so the file is readable up to the last written chunk
/// whenever writing stops. A recorder that is dropped without [`Recorder::finish`] finishes the file too, but
/// ignores errors.
pub struct Recorder<W: Write> {
    options: RecordOptions,
    last: Option<u64>,
    /// The figures that were recorded.
    figures: Vec<Arc<FigureJoints>>,
    /// The first `gathered` of these are the ticks of the chunk that is being gathered. The others are kept for
    /// their memory.
    chunk: Vec<Taken>,
    gathered: usize,
    /// `None` once writing has ended.
    thread: Option<WriterThread<W>>,
}

struct WriterThread<W> {
    chunks: SyncSender<Chunk>,
    /// Chunks that were written come back, so that their memory is reused.
    written: Receiver<Vec<Taken>>,
    handle: JoinHandle<Result<W, RecordError>>,
}

/// Ticks, and how many of them from the front belong to the chunk.
type Chunk = (Vec<Taken>, usize);

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
        let path = path.as_ref();
        let file = File::create(path).map_err(|source| RecordError::Io {
            what: format!("cannot create {}", path.display()),
            source,
        })?;
        Self::new(BufWriter::new(file), info, skeleton, options)
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
        let mut writing = Writing::new(out, info, skeleton, options.skin_points)?;
        // One chunk is gathered, one waits, one is written.
        let (to_thread, chunks) = sync_channel::<Chunk>(1);
        let (back, written): (Sender<Vec<Taken>>, _) = channel();
        let work = move || {
            for (mut chunk, count) in chunks {
                writing.chunk(&mut chunk[..count])?;
                // Fails once the recorder waits for the end: then it takes no chunk back.
                let _ = back.send(chunk);
            }
            writing.finish()
        };
        let named = std::thread::Builder::new().name("clamber_record".to_owned());
        let handle = named.spawn(work).map_err(|source| RecordError::Io {
            what: "cannot start the thread that writes the recording".to_owned(),
            source,
        })?;
        Ok(Self {
            options,
            last: None,
            figures: Vec::new(),
            chunk: Vec::new(),
            gathered: 0,
            thread: Some(WriterThread {
                chunks: to_thread,
                written,
                handle,
            }),
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
        if self.thread.is_none() {
            return Err(RecordError::Ended);
        }
        if let Some(last) = self.last
            && view.tick.checked_sub(1) != Some(last)
        {
            let found = view.tick;
            return Err(RecordError::Order { last, found });
        }
        let (mesh, palette) = (
            view.surface.mesh().joint_count(),
            view.palette.matrices().len(),
        );
        if mesh != palette {
            return Err(RecordError::JointCount { mesh, palette });
        }
        if self.gathered >= self.options.chunk_ticks.max(1) as usize {
            self.hand_over()?;
        }
        match self.chunk.get_mut(self.gathered) {
            Some(taken) => taken.take(view, &self.options),
            None => self.chunk.push(Taken::new(view, &self.options)),
        }
        self.gathered += 1;
        self.last = Some(view.tick);
        Ok(())
    }

    /// Records the joints of a figure at the tick recorded last, for people to look at: a replay does not compare
    /// them. Nothing is recorded in ticks in which [`RecordOptions::transforms_every`] lets no transforms be due.
    ///
    /// # Errors
    /// [`RecordError::FigureJoints`] if the palette, the skeleton and the skeleton of this name's first call differ in
    /// their number of joints; [`RecordError::NoTick`] before the first tick; [`RecordError::Ended`] after writing
    /// failed. Nothing is recorded then.
    pub fn figure(&mut self, view: &FigureView<'_>) -> Result<(), RecordError> {
        let is_due = self.last_tick()?.transforms_due;
        let known = self.figures.iter().find(|known| known.figure == view.name);
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
            self.figures.push(Arc::clone(&joints));
            joints
        });
        let figure = TakenFigure::new(joints, view.palette, view.world_from_model);
        self.last_tick()?.figures.push(figure);
        Ok(())
    }

    /// Records the brain of the creature at the tick recorded last, for people to look at: its state, moods and senses,
    /// at every change of state and whenever [`RecordOptions::transforms_every`] lets transforms be due; its events and
    /// blows go to the log. A replay does not compare them.
    ///
    /// # Errors
    /// [`RecordError::NoTick`] before the first tick; [`RecordError::Ended`] after writing failed.
    pub fn brain(&mut self, creature: &Creature) -> Result<(), RecordError> {
        let taken = self.last_tick()?;
        taken.brain = Some(TakenBrain::new(creature, taken.transforms_due));
        Ok(())
    }

    /// Records a snapshot of the scene after the tick recorded last.
    ///
    /// `scene` is what the scene needs to resume from that tick, in a format of its own. It can leave out the climber's
    /// state, since every tick has it. [`Recording::snapshot`](crate::Recording::snapshot) reads both back.
    ///
    /// # Errors
    /// [`RecordError::NoTick`] before the first tick, [`RecordError::Ended`] after writing failed.
    pub fn snapshot(&mut self, scene: &str) -> Result<(), RecordError> {
        self.last_tick()?.snapshots.push(scene.to_owned());
        Ok(())
    }

    /// The tick recorded last.
    fn last_tick(&mut self) -> Result<&mut Taken, RecordError> {
        if self.thread.is_none() {
            return Err(RecordError::Ended);
        }
        // A chunk is handed over only when another tick follows, so the last tick is still here.
        let last = self.chunk[..self.gathered].last_mut();
        last.ok_or(RecordError::NoTick {
            asked: 0,
            ticks: None,
        })
    }

    /// Writes the remaining ticks and the index, and gives back `out`.
    ///
    /// # Errors
    /// [`RecordError::Write`] or another error if a chunk or the index could not be written;
    /// [`RecordError::Ended`] if [`Recorder::tick`] has returned that error already.
    ///
    /// # Panics
    /// If `out` panicked: that panic is resumed here.
    pub fn finish(mut self) -> Result<W, RecordError> {
        self.hand_over()?;
        self.end()
    }

    /// Passes the gathered ticks to the thread.
    fn hand_over(&mut self) -> Result<(), RecordError> {
        let thread = self.thread.as_ref().ok_or(RecordError::Ended)?;
        let next = thread.written.try_recv().unwrap_or_default();
        let chunk = core::mem::replace(&mut self.chunk, next);
        let count = core::mem::take(&mut self.gathered);
        if thread.chunks.send((chunk, count)).is_ok() {
            return Ok(());
        }
        // The thread takes no more chunks: it has ended with an error.
        self.end().and(Err(RecordError::Ended))
    }

    /// Waits for the thread to end. If it panicked, resumes the panic.
    fn end(&mut self) -> Result<W, RecordError> {
        let WriterThread { chunks, handle, .. } = self.thread.take().ok_or(RecordError::Ended)?;
        drop(chunks);
        match handle.join() {
            Ok(ended) => ended,
            Err(panic) => std::panic::resume_unwind(panic),
        }
    }
}

impl<W: Write> Drop for Recorder<W> {
    fn drop(&mut self) {
        if let Some(WriterThread { chunks, handle, .. }) = self.thread.take() {
            // Errors are ignored: a drop cannot return them.
            let chunk = core::mem::take(&mut self.chunk);
            let _ = chunks.send((chunk, self.gathered));
            drop(chunks);
            let _ = handle.join();
        }
    }
}
