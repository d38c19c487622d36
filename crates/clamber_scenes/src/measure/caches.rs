use std::hint::black_box;

/// Streamed between cold ticks, as the rest of a game would: more than the caches hold.
const STREAM: usize = 64 << 20;

/// Whether a tick finds its data in the caches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Caches {
    /// It does.
    Warm,
    /// The caches hold something else: see [`Stream`].
    Cold,
}

/// Memory that cold ticks stream.
pub struct Stream(Vec<u64>);

impl Default for Stream {
    fn default() -> Self {
        Self(vec![1; STREAM / 8])
    }
}

impl Stream {
    /// Reads and writes all of it.
    pub fn run(&mut self) {
        for number in &mut self.0 {
            *number = number.wrapping_mul(3);
        }
        black_box(&self.0);
    }
}
