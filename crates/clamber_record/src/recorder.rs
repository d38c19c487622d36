use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use clamber_world::ObstacleId;

use crate::chunks::Chunks;
use crate::names::ObstacleNames;
use crate::output::Output;
use crate::views::{SceneryNames, SceneryView};
use crate::{RecordError, RecordingKind};

/// Options of a recorder: how often views for people are recorded, and how large chunks are.
///
/// Everything that a replay needs, and events, are recorded every tick, with any options.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordOptions {
    /// Ticks between two messages of transforms (of the creature and of figures) and of brains; 0 for none. Default 4:
    /// 15 messages a second at 60 Hz. A message takes 6 kB for a creature of 45 joints. Lower it for smooth motion of
    /// limbs.
    ///
    /// In an arena, bodies, arrows and the creatures' attacks are recorded in these ticks, too.
    pub transforms_every: u32,
    /// Ticks between two views of the skin and of the climber's body and support; 0 for none. Default 4, like the
    /// transforms: a skin that is recorded less often lags behind the joints. Each view skins the whole creature and
    /// takes about 12 kB. Raise both for large creatures.
    ///
    /// Until a view is written, it shares the mesh with the surface. The first edit in that time has to copy the mesh.
    ///
    /// In an arena, this concerns the skins of the creatures only. They are recorded in those of these ticks in which
    /// transforms are due, too: with 4 and `transforms_every` 6, in every twelfth tick, and with `transforms_every` 0
    /// never.
    pub skin_every: u32,
    /// Ticks between two views of the triangles that queries touched; 0 for none. Default 60: once a second at 60 Hz.
    /// These triangles are recorded only in ticks with a view of the skin, and shown until the next one. They are the
    /// most expensive part: a view takes about 50 kB.
    ///
    /// An arena's recorder ignores this number: it does not record these triangles.
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

    /// True if messages that are written every so many ticks are due in a tick.
    pub(crate) fn is_due(&self, every: u32, tick: u64) -> bool {
        every > 0 && tick.is_multiple_of(u64::from(every))
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

/// Writes a recording, chunk by chunk, on a thread of its own.
///
/// `tick` copies the tick and makes the log lines of its events, on the game's thread. An arena's recorder also hashes
/// the arena there in each tick, and saves its state at the beginning of each chunk. When a chunk is complete, the
/// recorder's thread skins, encodes and writes its ticks in order, while the game runs. If that thread falls behind by
/// some seconds, either ticks are left out, counted and logged, or the game waits: see [`RecordOptions::waits`].
///
/// A chunk is held in memory and written as a whole, so the file is readable up to the last written chunk whenever
/// writing stops. A recorder that is dropped without [`RecorderOf::finish`] finishes the file too, but ignores errors.
///
/// [`Recorder`](crate::Recorder) records one climber, [`ArenaRecorder`](crate::ArenaRecorder) an arena.
pub struct RecorderOf<K: RecordingKind, W: Write> {
    pub(crate) options: RecordOptions,
    pub(crate) names: ObstacleNames,
    pub(crate) scenery: SceneryNames,
    pub(crate) memory: K::Memory,
    pub(crate) chunks: Chunks<K::Taken, W>,
}

impl<K: RecordingKind, W: Write + Send + 'static> RecorderOf<K, W> {
    /// Starts the thread that writes. `encode` sends the messages of a tick.
    pub(crate) fn start(
        output: Output<W>,
        memory: K::Memory,
        options: RecordOptions,
        encode: impl FnMut(K::Taken, &mut Output<W>) -> Result<(), RecordError> + Send + 'static,
    ) -> Result<Self, RecordError> {
        let chunks = (options.chunk_ticks, options.waits);
        Ok(Self {
            options,
            names: ObstacleNames::new(),
            scenery: SceneryNames::default(),
            memory,
            chunks: Chunks::start(chunks, move |chunks| output.write(encode, chunks))?,
        })
    }
}

impl<K: RecordingKind, W: Write> RecorderOf<K, W> {
    /// Names an obstacle in the log from the next tick on. In a recording of one climber, give the creature the name in
    /// [`RecordingInfo::creature`](crate::RecordingInfo::creature): then the log also names the part of the creature
    /// that the climber is on. In a recording of an arena, creatures and fighters already have the names in
    /// [`ArenaInfo`](crate::ArenaInfo).
    pub fn name(&mut self, obstacle: ObstacleId, name: &str) {
        self.names.insert(obstacle, name.to_owned());
    }

    /// True if transforms are due in the tick recorded last: see [`RecordOptions::transforms_every`]. In other ticks,
    /// figures and meshes that were recorded before need not be prepared.
    ///
    /// # Errors
    /// [`RecordError::NoTick`] before the first tick; [`RecordError::Ended`] after writing failed.
    pub fn is_due(&mut self) -> Result<bool, RecordError> {
        Ok(self.chunks.last()?.is_due)
    }

    /// Records a mesh at the tick recorded last, for people to look at, such as the ground or a rock. The first call
    /// with a name records the mesh's shape and place, and later calls record its place if transforms are due
    /// ([`RecordOptions::transforms_every`]). Call it once for a mesh that stands still.
    ///
    /// # Errors
    /// [`RecordError::NoTick`] before the first tick; [`RecordError::Ended`] after writing failed.
    pub fn scenery(&mut self, view: &SceneryView<'_>) -> Result<(), RecordError> {
        let last = self.chunks.last()?;
        let taken = self.scenery.take(view, last.is_due);
        last.scenery.extend(taken);
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

/// Creates a file. An existing file at that path is overwritten.
pub(crate) fn create(path: &Path) -> Result<BufWriter<File>, RecordError> {
    let failed = RecordError::io(format!("cannot create {}", path.display()));
    Ok(BufWriter::new(File::create(path).map_err(failed)?))
}
