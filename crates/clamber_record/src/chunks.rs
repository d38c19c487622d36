//! Gathers ticks in chunks, and writes them on a thread of its own while the game runs.

use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, TrySendError, sync_channel};
use std::thread::JoinHandle;
use std::time::Duration;

use foxglove::messages::Log;

use crate::RecordError;
use crate::views::TakenScenery;

/// The copy of a tick that is made on the game's thread. The recorder's thread makes the recording from it later.
pub(crate) struct Taken<D> {
    pub(crate) tick: u64,
    /// Data of a recording of this kind.
    pub(crate) data: D,
    /// True if transforms are due in this tick.
    pub(crate) is_due: bool,
    /// Log lines, without their times.
    pub(crate) lines: Vec<Log>,
    /// Meshes that are new, or whose places are due.
    pub(crate) scenery: Vec<TakenScenery>,
    /// States after this tick, from which a replay can start.
    pub(crate) saved: Vec<MakeState>,
    /// Number of ticks left out before this one.
    pub(crate) gap: u64,
}

/// Function that makes the bytes of a saved state, or says why it cannot.
pub(crate) type MakeState = Box<dyn FnOnce() -> Result<Vec<u8>, String> + Send>;

impl<D> Taken<D> {
    pub(crate) fn new(tick: u64, data: D, is_due: bool) -> Self {
        Self {
            tick,
            data,
            is_due,
            lines: Vec::new(),
            scenery: Vec::new(),
            saved: Vec::new(),
            gap: 0,
        }
    }
}

/// Gathers copies of ticks in chunks and passes the chunks to the writing thread.
pub(crate) struct Chunks<D, W> {
    /// Number of ticks in a chunk.
    size: usize,
    last: Option<u64>,
    /// If true, the game waits for a slow disk; if false, ticks are left out instead.
    waits: bool,
    /// Number of ticks left out so far.
    dropped: u64,
    /// Number of ticks left out since the last chunk that was passed to the thread.
    gap: u64,
    /// Number of ticks so far with a saved state. Ticks are left out only once there are two.
    saved: usize,
    /// The ticks of the current chunk.
    chunk: Vec<Taken<D>>,
    /// New meshes of ticks that were left out. The next recorded tick gets them.
    meshes: Vec<TakenScenery>,
    /// `None` once writing has ended.
    thread: Option<WriterThread<D, W>>,
}

struct WriterThread<D, W> {
    chunks: SyncSender<Chunk<D>>,
    handle: JoinHandle<Result<W, RecordError>>,
}

/// The ticks of a chunk, and the number of ticks left out at the end of the recording.
pub(crate) type Chunk<D> = (Vec<Taken<D>>, u64);

impl<D: Send + 'static, W: Send + 'static> Chunks<D, W> {
    /// Starts the writing thread. `write` writes all chunks.
    pub(crate) fn start(
        (chunk_ticks, waits): (u32, bool),
        write: impl FnOnce(&mut dyn Iterator<Item = Chunk<D>>) -> Result<W, RecordError>
        + Send
        + 'static,
    ) -> Result<Self, RecordError> {
        // One chunk is being gathered, up to `WAITING` wait in the channel, one is being written.
        let (chunks, queue) = sync_channel::<Chunk<D>>(WAITING);
        let work = move || write(&mut std::iter::from_fn(|| next(&queue)));
        let named = std::thread::Builder::new().name("clamber_record".to_owned());
        let failed = RecordError::io("cannot start the thread that writes the recording");
        let handle = named.spawn(work).map_err(failed)?;
        Ok(Self {
            size: chunk_ticks.max(1) as usize,
            last: None,
            waits,
            dropped: 0,
            gap: 0,
            saved: 0,
            chunk: Vec::new(),
            meshes: Vec::new(),
            thread: Some(WriterThread { chunks, handle }),
        })
    }
}

/// Largest number of chunks that wait to be written. Beyond it the game waits, or the next chunk is left out. A larger
/// number bridges longer pauses of the disk, but a crash loses more.
const WAITING: usize = 8;

/// First and longest time that the thread sleeps before it looks for the next chunk; the time doubles in between. A
/// chunk that is passed on does not wake the thread, since waking it takes longer than all other work of the game's
/// thread for a chunk.
const SLEEP: [Duration; 2] = [Duration::from_micros(250), Duration::from_millis(50)];

/// Waits for the next chunk; `None` when no more will come.
fn next<T>(chunks: &Receiver<T>) -> Option<T> {
    let [mut sleep, longest] = SLEEP;
    loop {
        match chunks.try_recv() {
            Ok(chunk) => return Some(chunk),
            Err(TryRecvError::Disconnected) => return None,
            Err(TryRecvError::Empty) => std::thread::park_timeout(sleep),
        }
        sleep = (sleep * 2).min(longest);
    }
}

impl<D, W> WriterThread<D, W> {
    /// Passes a chunk to the thread. If the queue is full, waits for room or gives the chunk back, as `waits` says.
    fn pass(&self, chunk: Chunk<D>, waits: bool) -> Result<(), TrySendError<Chunk<D>>> {
        match self.chunks.try_send(chunk) {
            Err(TrySendError::Full(chunk)) => {
                self.handle.thread().unpark();
                if !waits {
                    return Err(TrySendError::Full(chunk));
                }
                Ok(self.chunks.send(chunk)?)
            }
            passed => passed,
        }
    }

    /// Waits until all chunks are written and the thread has ended.
    fn join(self) -> std::thread::Result<Result<W, RecordError>> {
        drop(self.chunks);
        self.handle.thread().unpark();
        self.handle.join()
    }
}

impl<D, W> Chunks<D, W> {
    /// Number of ticks left out so far because the disk was too slow.
    pub(crate) fn dropped(&self) -> u64 {
        self.dropped
    }

    /// Refuses a tick that does not follow the last one, and every tick once writing has failed.
    pub(crate) fn check(&self, tick: u64) -> Result<(), RecordError> {
        if self.thread.is_none() {
            return Err(RecordError::Ended);
        }
        match self.last {
            Some(last) if tick.checked_sub(1) != Some(last) => {
                Err(RecordError::Order { last, found: tick })
            }
            _ => Ok(()),
        }
    }

    /// True if a tick that is pushed now becomes the first one of its chunk.
    pub(crate) fn begins(&self) -> bool {
        self.chunk.is_empty() || self.chunk.len() >= self.size
    }

    /// Adds a tick that `check` has accepted.
    pub(crate) fn push(&mut self, taken: Taken<D>) -> Result<(), RecordError> {
        if self.chunk.len() >= self.size {
            self.hand_over()?;
        }
        self.last = Some(taken.tick);
        self.chunk.push(taken);
        Ok(())
    }

    /// The tick added last.
    pub(crate) fn last(&mut self) -> Result<&mut Taken<D>, RecordError> {
        if self.thread.is_none() {
            return Err(RecordError::Ended);
        }
        // A chunk is handed over only when another tick follows, so the last tick is still here.
        self.chunk.last_mut().ok_or(RecordError::NoTick {
            asked: 0,
            ticks: None,
        })
    }

    /// Writes the remaining ticks and ends the thread.
    pub(crate) fn finish(&mut self) -> Result<W, RecordError> {
        // The game is over, so it may wait for the disk: no tick is lost here.
        self.waits = true;
        self.hand_over()?;
        self.end()
    }

    /// Passes the gathered ticks to the thread, or leaves them out.
    fn hand_over(&mut self) -> Result<(), RecordError> {
        let waits = self.waits || self.saved < 2;
        if self.pass_on(waits) {
            Ok(())
        } else {
            self.end().and(Err(RecordError::Ended))
        }
    }

    /// Passes the gathered ticks to the thread, or leaves them out. False if the thread has ended.
    fn pass_on(&mut self, waits: bool) -> bool {
        let next = Vec::with_capacity(self.chunk.len());
        let mut ticks = core::mem::replace(&mut self.chunk, next);
        let is_saved = |tick: &Taken<D>| !tick.saved.is_empty();
        self.saved += ticks.iter().filter(|tick| is_saved(tick)).count();
        if self.gap > 0 {
            // A gap ends only at a tick from which a replay can start.
            let first = ticks.iter().position(is_saved);
            self.leave_out(ticks.drain(..first.unwrap_or(ticks.len())));
            match ticks.first_mut() {
                Some(first) => first.gap = self.gap,
                None if !waits => return true,
                None => {}
            }
        }
        if let Some(first) = ticks.first_mut() {
            first.scenery.splice(0..0, self.meshes.drain(..));
        }
        // An empty chunk tells the thread how many ticks are missing at the end.
        let lost = if ticks.is_empty() { self.gap } else { 0 };
        let Some(thread) = &self.thread else {
            return false;
        };
        match thread.pass((ticks, lost), waits) {
            Ok(()) => self.gap = 0,
            Err(TrySendError::Full((ticks, _))) => self.leave_out(ticks),
            Err(TrySendError::Disconnected(_)) => return false,
        }
        true
    }

    /// Leaves ticks out, and keeps their new meshes.
    fn leave_out(&mut self, ticks: impl IntoIterator<Item = Taken<D>>) {
        for tick in ticks {
            self.dropped += 1;
            self.gap += 1;
            // Only these have the shapes of new meshes.
            let new = tick.scenery.into_iter().filter(|mesh| mesh.shape.is_some());
            self.meshes.extend(new);
        }
    }

    /// Waits for the thread to end. If it panicked, resumes the panic.
    fn end(&mut self) -> Result<W, RecordError> {
        let thread = self.thread.take().ok_or(RecordError::Ended)?;
        match thread.join() {
            Ok(ended) => ended,
            Err(panic) => std::panic::resume_unwind(panic),
        }
    }
}

impl<D, W> Drop for Chunks<D, W> {
    fn drop(&mut self) {
        // Errors are ignored: a drop cannot return them.
        self.pass_on(true);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of written ticks, each with the number of ticks left out before it.
    type Ticks = Vec<(u64, u64)>;

    /// Starts a thread that sleeps this long at each chunk, and returns the ticks.
    fn start(options: (u32, bool), sleep: Duration) -> Chunks<(), Ticks> {
        let chunks = Chunks::<(), Ticks>::start(options, move |chunks| {
            let mut written = Vec::new();
            for (ticks, _) in chunks {
                std::thread::sleep(sleep);
                written.extend(ticks.iter().map(|tick| (tick.tick, tick.gap)));
            }
            Ok(written)
        });
        chunks.unwrap()
    }

    /// Adds a tick. It has a saved state if its number is a multiple of 5.
    fn play(chunks: &mut Chunks<(), Ticks>, number: u64) {
        let mut taken = Taken::new(number, (), false);
        if number.is_multiple_of(5) {
            taken.saved.push(Box::new(|| Ok(Vec::new())));
        }
        chunks.push(taken).unwrap();
    }

    #[test]
    fn a_game_that_waits_and_is_faster_than_the_thread_loses_no_tick() {
        for (ticks, pause) in [(0, 0), (1, 0), (61, 0), (10, 3)] {
            let mut chunks = start((3, true), Duration::from_millis(2));
            for tick in 0..ticks {
                play(&mut chunks, tick);
                std::thread::sleep(Duration::from_millis(pause));
            }
            assert_eq!(chunks.dropped(), 0);
            let written = chunks.finish().unwrap();
            let all: Ticks = (0..ticks).map(|tick| (tick, 0)).collect();
            assert_eq!(written, all);
        }
    }

    /// A game that does not wait is not held up. Ticks that are left out are counted and reported, and the first tick
    /// after a gap is a saved one.
    #[test]
    fn a_game_that_does_not_wait_loses_ticks_and_no_time() {
        // Saved ticks are 5 apart: each chunk of 5 begins with one, some chunks of 3 have none, and chunks of 7 have
        // them at changing places.
        for size in [5, 3, 7] {
            let mut chunks = start((size, false), Duration::from_millis(20));
            let mut waits = 0;
            for tick in 0..600 {
                let began = std::time::Instant::now();
                play(&mut chunks, tick);
                waits += u32::from(began.elapsed() >= Duration::from_millis(10));
                std::thread::sleep(Duration::from_micros(200));
            }
            let dropped = chunks.dropped();
            let written = chunks.finish().unwrap();
            // A game that waits would do so for most of its chunks. A busy machine may hold it up a few times.
            assert!(waits < 20, "{waits} waits");
            assert!(dropped > 100, "{dropped}");
            // `finish` may leave out a few more ticks: the ticks of the last chunk before its first saved tick.
            let lost = 600 - written.len() as u64;
            assert!(
                (dropped..dropped + 7).contains(&lost),
                "size {size}: {lost} of {dropped}"
            );
            let mut next = 0;
            for (tick, gap) in written {
                assert_eq!(tick, next + gap, "size {size}");
                assert!(gap == 0 || tick.is_multiple_of(5), "size {size}");
                next = tick + 1;
            }
        }
    }
}
