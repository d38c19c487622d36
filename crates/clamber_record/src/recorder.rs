use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread::JoinHandle;

use clamber_climber::{ClimberInput, ClimberState, StepReport};
use clamber_surface::rig::{Palette, Skeleton};
use clamber_surface::surface::SkinnedSurface;

use crate::taken::Taken;
use crate::writing::Writing;
use crate::{RecordError, RecordingInfo};

/// How often what is recorded. Inputs, states and fingerprints are recorded every tick, whatever stands here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordOptions {
    /// Ticks from one message of transforms to the next; 0 for none. Default 4: 15 a second at 60 Hz. A
    /// creature of 45 joints takes 6 kB a message. Lower it for smooth limbs.
    pub transforms_every: u32,
    /// Ticks from one look at the skin to the next, points and touched triangles; 0 for none. Default 30: 2 a
    /// second at 60 Hz: the dearest part. Skins the whole creature and takes some 50 kB a look. Raise it for large creatures.
    /// Until a look is written it shares the surface's mesh, which the first edit meanwhile has to copy.
    pub skin_every: u32,
    /// Points of the skin at most. Default 2000.
    pub skin_points: usize,
    /// Ticks in a chunk. Default 60; 0 is taken for 1. A crash loses the chunk being gathered and those not yet
    /// written: up to three in all, one or two where the disk keeps up. Raise it for fewer, larger writes; each
    /// tick waits in memory with its palette.
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

/// Writes a recording, chunk by chunk, on a thread of its own.
///
/// A tick is copied, no more. Once a chunk's ticks are together, a thread skins, encodes and writes them, in
/// the order of the ticks, while the game goes on. If that takes longer than the next chunk's ticks do, the
/// game waits: nothing is left out.
///
/// A chunk is held in memory and written as a whole, so that what stands in the file can be read whenever
/// writing stops. Dropped without [`Recorder::finish`], it finishes the file and keeps quiet about errors.
pub struct Recorder<W: Write> {
    options: RecordOptions,
    last: Option<u64>,
    /// The ticks of the chunk that is being gathered are the first `gathered` of these; the others are kept for
    /// their memory.
    chunk: Vec<Taken>,
    gathered: usize,
    /// `None` once it has ended.
    thread: Option<WriterThread<W>>,
}

struct WriterThread<W> {
    chunks: SyncSender<Chunk>,
    /// Chunks that were written, for their memory.
    written: Receiver<Vec<Taken>>,
    handle: JoinHandle<Result<W, RecordError>>,
}

/// So many ticks from the front.
type Chunk = (Vec<Taken>, usize);

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

impl<W: Write + Send + 'static> Recorder<W> {
    /// Into anything that takes bytes. `info.version` is not written: the file says which version made it.
    ///
    /// # Errors
    /// [`RecordError::TickSeconds`], [`RecordError::Write`]; [`RecordError::Io`] if the system gives no thread.
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
                // There is nobody to take it back once the recorder waits for the end.
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
    /// Records a tick. The surface is only read; skin that the views ask for is not counted as touched.
    ///
    /// # Errors
    /// [`RecordError::Order`] unless ticks come one after another, [`RecordError::JointCount`] for a palette
    /// that does not fit the surface: such a tick is not recorded, the next may be. [`RecordError::Write`] or
    /// another one if an earlier chunk could not be written, [`RecordError::Ended`] ever after.
    ///
    /// # Panics
    /// As the writer did, if it did.
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

    /// Records what the scene needs to go on from the tick recorded last, beside the climber's state, in
    /// words of its own. To be read back by [`Recording::snapshot`](crate::Recording::snapshot).
    ///
    /// # Errors
    /// [`RecordError::NoTick`] before the first tick, [`RecordError::Ended`] after writing failed.
    pub fn snapshot(&mut self, scene: &str) -> Result<(), RecordError> {
        if self.thread.is_none() {
            return Err(RecordError::Ended);
        }
        // What was handed over was so for the sake of a tick that came after.
        let last = self.chunk[..self.gathered].last_mut();
        let tick = last.ok_or(RecordError::NoTick {
            asked: 0,
            ticks: None,
        })?;
        tick.snapshots.push(scene.to_owned());
        Ok(())
    }

    /// Writes what is left, and the index; gives back where it was written to.
    ///
    /// # Errors
    /// [`RecordError::Write`], [`RecordError::Io`]; [`RecordError::Ended`] if a tick told of the failure.
    ///
    /// # Panics
    /// As the writer did, if it did.
    pub fn finish(mut self) -> Result<W, RecordError> {
        self.hand_over()?;
        self.end()
    }

    /// Gives the ticks that were gathered to the thread.
    fn hand_over(&mut self) -> Result<(), RecordError> {
        let thread = self.thread.as_ref().ok_or(RecordError::Ended)?;
        let next = thread.written.try_recv().unwrap_or_default();
        let chunk = core::mem::replace(&mut self.chunk, next);
        let count = core::mem::take(&mut self.gathered);
        if thread.chunks.send((chunk, count)).is_ok() {
            return Ok(());
        }
        // The thread takes no more: it has ended on an error.
        self.end().and(Err(RecordError::Ended))
    }

    /// Waits for the thread, and panics as it did.
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
            // A thread that takes no more has its reason, which nobody asks for now.
            let chunk = core::mem::take(&mut self.chunk);
            let _ = chunks.send((chunk, self.gathered));
            drop(chunks);
            let _ = handle.join();
        }
    }
}
