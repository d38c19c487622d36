use std::hint::black_box;

/// Bytes streamed between cold ticks, in place of the rest of a game: more than the caches hold.
const STREAM: usize = 64 << 20;

/// Whether a tick finds its data in the processor's caches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Caches {
    /// The caches hold the data of the tick before.
    Warm,
    /// The caches hold other data: see [`Stream`].
    Cold,
}

/// Memory to stream before a cold tick.
pub struct Stream(Vec<u64>);

impl Default for Stream {
    fn default() -> Self {
        Self(vec![1; STREAM / 8])
    }
}

impl Stream {
    /// Reads and writes all of the memory, which evicts other data from the caches.
    pub fn run(&mut self) {
        for number in &mut self.0 {
            *number = number.wrapping_mul(3);
        }
        black_box(&self.0);
    }
}
