//! What was computed on demand, kept until it is out of date, without locks and without unsafe.

use std::sync::atomic::{AtomicU64, Ordering};

/// Numbers that queries compute on demand, grouped in entries, shared by any number of threads.
///
/// An entry counts as filled while its stamp is the epoch of the pose that it belongs to; a new epoch
/// outdates all entries at once, in no time. Filling an entry is idempotent: whoever finds it empty
/// computes it, stores the numbers relaxed and then the stamp with release order; two threads may do
/// so at once with equal bits, and nobody waits. Whoever reads the stamp with acquire order therefore
/// reads those numbers. A new epoch needs `&mut`, so no thread sees two.
#[derive(Debug)]
pub(super) struct Cache<W = AtomicU64> {
    stamps: Box<[W]>,
    /// Two numbers each.
    words: Box<[W]>,
}

/// An atomic u64: std's, or a checker's.
pub(super) trait Word {
    fn new(value: u64) -> Self;
    fn load(&self, order: Ordering) -> u64;
    fn store(&self, value: u64, order: Ordering);
}

impl Word for AtomicU64 {
    fn new(value: u64) -> Self {
        Self::new(value)
    }

    fn load(&self, order: Ordering) -> u64 {
        self.load(order)
    }

    fn store(&self, value: u64, order: Ordering) {
        self.store(value, order);
    }
}

impl<W: Word> Cache<W> {
    /// All entries empty. No epoch may be 0.
    pub(super) fn new(entries: usize, numbers: usize) -> Self {
        Self {
            stamps: (0..entries).map(|_| W::new(0)).collect(),
            words: (0..numbers.div_ceil(2)).map(|_| W::new(0)).collect(),
        }
    }

    /// The entry's stamp. If it is the epoch, [`Cache::load`] gives its numbers.
    pub(super) fn stamp(&self, entry: usize) -> u64 {
        self.stamps[entry].load(Ordering::Acquire)
    }

    /// Says that an entry is filled, after its numbers were stored.
    pub(super) fn set_stamp(&self, entry: usize, stamp: u64) {
        self.stamps[entry].store(stamp, Ordering::Release);
    }

    /// Copies numbers out, from an even one on, an even count of them.
    pub(super) fn load(&self, first: usize, numbers: &mut [f32]) {
        let words = &self.words[first / 2..][..numbers.len() / 2];
        for (pair, word) in numbers.as_chunks_mut::<2>().0.iter_mut().zip(words) {
            let bits = word.load(Ordering::Relaxed);
            *pair = [
                f32::from_bits(bits as u32),
                f32::from_bits((bits >> 32) as u32),
            ];
        }
    }

    /// Copies numbers in, from an even one on, an even count of them.
    pub(super) fn store(&self, first: usize, numbers: &[f32]) {
        let words = &self.words[first / 2..][..numbers.len() / 2];
        for (pair, word) in numbers.as_chunks::<2>().0.iter().zip(words) {
            let [low, high] = pair.map(|x| u64::from(x.to_bits()));
            word.store(low | high << 32, Ordering::Relaxed);
        }
    }

    /// How many entries `counts` says yes to, by stamp.
    pub(super) fn entries_with(&self, counts: impl Fn(u64) -> bool) -> impl Iterator<Item = usize> {
        let stamps = self.stamps.iter().enumerate();
        stamps
            .filter(move |(_, stamp)| counts(stamp.load(Ordering::Relaxed)))
            .map(|(entry, _)| entry)
    }
}

impl Cache<AtomicU64> {
    /// [`Cache::store`] by whoever has the cache alone: plain stores.
    pub(super) fn set(&mut self, first: usize, numbers: &[f32]) {
        let words = &mut self.words[first / 2..][..numbers.len() / 2];
        for (pair, word) in numbers.as_chunks::<2>().0.iter().zip(words) {
            let [low, high] = pair.map(|x| u64::from(x.to_bits()));
            *word.get_mut() = low | high << 32;
        }
    }

    /// In bytes.
    pub(super) fn memory(&self) -> usize {
        (self.stamps.len() + self.words.len()) * size_of::<AtomicU64>()
    }
}

#[cfg(test)]
mod tests;
