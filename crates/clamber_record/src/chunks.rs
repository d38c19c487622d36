//! Gathers ticks in chunks, and writes them on a thread of its own while the game goes on.

use std::sync::mpsc::{
    Receiver, Sender, SyncSender, TryRecvError, TrySendError, channel, sync_channel,
};
use std::thread::JoinHandle;
use std::time::Duration;

use crate::RecordError;

/// Encodes ticks and writes them.
pub(crate) trait WriteTicks<T, W>: Send + 'static {
    /// Writes a chunk of ticks.
    fn chunk(&mut self, ticks: &mut [T]) -> Result<(), RecordError>;

    /// Writes the index and gives back the output.
    fn finish(self) -> Result<W, RecordError>;
}

/// Copies of ticks on their way to the file.
pub(crate) struct Chunks<T, W> {
    /// Ticks in a chunk.
    size: usize,
    last: Option<u64>,
    /// The first `gathered` of these are the ticks of the chunk that is being gathered. The others are kept for
    /// their memory.
    chunk: Vec<T>,
    gathered: usize,
    /// `None` once writing has ended.
    thread: Option<WriterThread<T, W>>,
}

struct WriterThread<T, W> {
    chunks: SyncSender<Chunk<T>>,
    /// Chunks that were written come back, so that their memory is reused.
    written: Receiver<Vec<T>>,
    handle: JoinHandle<Result<W, RecordError>>,
}

/// Ticks, and how many of them from the front belong to the chunk.
type Chunk<T> = (Vec<T>, usize);

impl<T: Send + 'static, W: Send + 'static> Chunks<T, W> {
    /// Starts the thread.
    pub(crate) fn start(
        mut writing: impl WriteTicks<T, W>,
        chunk_ticks: u32,
    ) -> Result<Self, RecordError> {
        // One chunk is gathered, some wait, one is written.
        let (to_thread, chunks) = sync_channel::<Chunk<T>>(WAITING);
        let (back, written): (Sender<Vec<T>>, _) = channel();
        let work = move || {
            while let Some((mut chunk, count)) = next(&chunks) {
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
            size: chunk_ticks.max(1) as usize,
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

/// Most chunks that wait to be written before the game waits for them.
const WAITING: usize = 3;

/// How long the thread sleeps before it looks for the next chunk: first, and at most. Handing a chunk over does not
/// wake it, since that takes longer than all else that the game's thread does for a chunk.
const SLEEP: [Duration; 2] = [Duration::from_micros(250), Duration::from_millis(50)];

/// The next chunk; `None` when no more will come.
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

impl<T, W> WriterThread<T, W> {
    /// Passes a chunk to the thread; false if it has ended with an error. Waits only if too many others wait.
    fn pass(&self, chunk: Chunk<T>) -> bool {
        match self.chunks.try_send(chunk) {
            Ok(()) => true,
            Err(TrySendError::Disconnected(_)) => false,
            Err(TrySendError::Full(chunk)) => {
                self.handle.thread().unpark();
                self.chunks.send(chunk).is_ok()
            }
        }
    }

    /// Waits until all chunks are written and the thread has ended.
    fn join(self) -> std::thread::Result<Result<W, RecordError>> {
        drop(self.chunks);
        self.handle.thread().unpark();
        self.handle.join()
    }
}

impl<T, W> Chunks<T, W> {
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

    /// True if a tick that is pushed now is the first one of its chunk.
    pub(crate) fn begins(&self) -> bool {
        self.gathered == 0 || self.gathered >= self.size
    }

    /// Adds a tick that was checked. `take` copies it: over one that is there already, or to a new one that it returns.
    pub(crate) fn push(
        &mut self,
        tick: u64,
        take: impl FnOnce(Option<&mut T>) -> Option<T>,
    ) -> Result<(), RecordError> {
        if self.gathered >= self.size {
            self.hand_over()?;
        }
        let new = take(self.chunk.get_mut(self.gathered));
        self.chunk.extend(new);
        self.gathered += 1;
        self.last = Some(tick);
        Ok(())
    }

    /// The tick added last.
    pub(crate) fn last(&mut self) -> Result<&mut T, RecordError> {
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

    /// Writes what is left.
    pub(crate) fn finish(&mut self) -> Result<W, RecordError> {
        self.hand_over()?;
        self.end()
    }

    /// Passes the gathered ticks to the thread.
    fn hand_over(&mut self) -> Result<(), RecordError> {
        let thread = self.thread.as_ref().ok_or(RecordError::Ended)?;
        let next = thread.written.try_recv().unwrap_or_default();
        let chunk = core::mem::replace(&mut self.chunk, next);
        let count = core::mem::take(&mut self.gathered);
        if thread.pass((chunk, count)) {
            return Ok(());
        }
        // The thread takes no more chunks: it has ended with an error.
        self.end().and(Err(RecordError::Ended))
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

impl<T, W> Drop for Chunks<T, W> {
    fn drop(&mut self) {
        if let Some(thread) = self.thread.take() {
            // Errors are ignored: a drop cannot return them.
            let chunk = core::mem::take(&mut self.chunk);
            thread.pass((chunk, self.gathered));
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Stores the ticks that it is given, slower than the test makes them.
    struct Slow(Vec<u64>);

    impl WriteTicks<u64, Vec<u64>> for Slow {
        fn chunk(&mut self, ticks: &mut [u64]) -> Result<(), RecordError> {
            std::thread::sleep(Duration::from_millis(2));
            self.0.extend(ticks.iter());
            Ok(())
        }

        fn finish(self) -> Result<Vec<u64>, RecordError> {
            Ok(self.0)
        }
    }

    #[test]
    fn a_game_that_is_faster_than_the_thread_loses_no_tick() {
        for (ticks, pause) in [(0, 0), (1, 0), (61, 0), (10, 3)] {
            let mut chunks = Chunks::start(Slow(Vec::new()), 3).unwrap();
            for tick in 0..ticks {
                let take = |known: Option<&mut u64>| match known {
                    Some(known) => {
                        *known = tick;
                        None
                    }
                    None => Some(tick),
                };
                chunks.push(tick, take).unwrap();
                std::thread::sleep(Duration::from_millis(pause));
            }
            let written = chunks.finish().unwrap();
            assert_eq!(written, (0..ticks).collect::<Vec<_>>());
        }
    }
}
