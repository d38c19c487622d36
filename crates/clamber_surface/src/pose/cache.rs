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
    stamps: Vec<W>,
    /// Two numbers each.
    words: Vec<W>,
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

/// Marks the stamp of an entry that was filled before anybody asked for it.
const UNASKED: u64 = 1 << 63;

impl<W: Word> Cache<W> {
    /// All entries empty. No epoch may be 0.
    pub(super) fn new(entries: usize, numbers: usize) -> Self {
        let mut cache = Self {
            stamps: Vec::new(),
            words: Vec::new(),
        };
        cache.grow(entries, numbers);
        cache
    }

    /// Appends empty entries, up to so many in all.
    pub(super) fn grow(&mut self, entries: usize, numbers: usize) {
        self.stamps.resize_with(entries, || W::new(0));
        self.words.resize_with(numbers.div_ceil(2), || W::new(0));
    }

    /// Copies an entry's numbers out, if they are of this epoch: part after part, of even lengths, from
    /// the number `first` on, which is even. If false, compute them and [`Cache::keep`] them.
    pub(super) fn recall<const N: usize>(
        &self,
        entry: usize,
        epoch: u64,
        first: usize,
        parts: [&mut [f32]; N],
    ) -> bool {
        let stamp = self.stamps[entry].load(Ordering::Acquire);
        if stamp & !UNASKED != epoch {
            return false;
        }
        let mut words = &self.words[first / 2..];
        for part in parts {
            let (of_part, after) = words.split_at(part.len() / 2);
            for (pair, word) in part.as_chunks_mut::<2>().0.iter_mut().zip(of_part) {
                *pair = unpacked(word.load(Ordering::Relaxed));
            }
            words = after;
        }
        if stamp & UNASKED != 0 {
            self.stamps[entry].store(epoch, Ordering::Release);
        }
        true
    }

    /// Keeps an entry's numbers, as [`Cache::recall`] takes them.
    pub(super) fn keep<const N: usize>(
        &self,
        entry: usize,
        epoch: u64,
        first: usize,
        parts: [&[f32]; N],
    ) {
        let mut words = &self.words[first / 2..];
        for part in parts {
            let (of_part, after) = words.split_at(part.len() / 2);
            for (pair, word) in part.as_chunks::<2>().0.iter().zip(of_part) {
                word.store(packed(pair), Ordering::Relaxed);
            }
            words = after;
        }
        self.stamps[entry].store(epoch, Ordering::Release);
    }

    /// The entries that somebody asked for in this epoch.
    pub(super) fn asked(&self, epoch: u64) -> impl Iterator<Item = usize> {
        self.entries_with(move |stamp| stamp == epoch)
    }

    /// The entries that are filled in this epoch, asked for or not.
    pub(super) fn filled(&self, epoch: u64) -> impl Iterator<Item = usize> {
        self.entries_with(move |stamp| stamp & !UNASKED == epoch)
    }

    fn entries_with(&self, counts: impl Fn(u64) -> bool) -> impl Iterator<Item = usize> {
        let stamps = self.stamps.iter().enumerate();
        stamps
            .filter(move |(_, stamp)| counts(stamp.load(Ordering::Relaxed)))
            .map(|(entry, _)| entry)
    }
}

impl Cache<AtomicU64> {
    /// [`Cache::keep`] by whoever has the cache alone, before anybody asks; what was asked for already
    /// stays so.
    pub(super) fn keep_ahead<const N: usize>(
        &mut self,
        entry: usize,
        epoch: u64,
        first: usize,
        parts: [&[f32]; N],
    ) {
        let mut words = &mut self.words[first / 2..];
        for part in parts {
            let (of_part, after) = words.split_at_mut(part.len() / 2);
            for (pair, word) in part.as_chunks::<2>().0.iter().zip(of_part) {
                *word.get_mut() = packed(pair);
            }
            words = after;
        }
        let stamp = self.stamps[entry].get_mut();
        if *stamp != epoch {
            *stamp = epoch | UNASKED;
        }
    }

    /// Empties an entry.
    pub(super) fn forget(&mut self, entry: usize) {
        *self.stamps[entry].get_mut() = 0;
    }

    /// Copies numbers out, of whatever epoch, as whoever has the cache alone may.
    pub(super) fn peek<const N: usize>(&mut self, first: usize, parts: [&mut [f32]; N]) {
        let mut words = &mut self.words[first / 2..];
        for part in parts {
            let (of_part, after) = words.split_at_mut(part.len() / 2);
            for (pair, word) in part.as_chunks_mut::<2>().0.iter_mut().zip(of_part) {
                *pair = unpacked(*word.get_mut());
            }
            words = after;
        }
    }

    /// In bytes.
    pub(super) fn memory(&self) -> usize {
        (self.stamps.len() + self.words.len()) * size_of::<AtomicU64>()
    }
}

fn unpacked(word: u64) -> [f32; 2] {
    [word as u32, (word >> 32) as u32].map(f32::from_bits)
}

fn packed(pair: &[f32; 2]) -> u64 {
    let [low, high] = pair.map(|x| u64::from(x.to_bits()));
    low | high << 32
}

#[cfg(test)]
mod tests;
