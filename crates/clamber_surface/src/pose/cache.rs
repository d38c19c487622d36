//! A cache of values that are computed on demand, without locks and without unsafe.

use std::sync::atomic::{AtomicU64, Ordering};

/// Numbers that queries compute on demand, grouped in entries, shared by any number of threads.
///
/// An entry is filled while its stamp is the current epoch of its pose. A new epoch invalidates all entries at
/// once, in O(1). Filling an entry is idempotent: a thread that finds the entry empty computes the numbers, stores
/// them with relaxed order, and then stores the stamp with release order. Two threads may do so at the same time
/// with equal bits, and neither waits. A thread that reads the stamp with acquire order therefore reads these
/// numbers. A new epoch needs `&mut`, so no thread sees two epochs.
#[derive(Debug)]
pub(super) struct Cache<W = AtomicU64> {
    stamps: Vec<W>,
    /// Each word holds two numbers.
    words: Vec<W>,
}

/// An atomic u64: that of std, or that of a model checker.
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

/// The bit that marks the stamp of an entry that was filled before anybody requested it.
const UNASKED: u64 = 1 << 63;

impl<W: Word> Cache<W> {
    /// A cache of empty entries. An epoch must not be 0, the stamp of empty entries.
    pub(super) fn new(entries: usize, numbers: usize) -> Self {
        let mut cache = Self {
            stamps: Vec::new(),
            words: Vec::new(),
        };
        cache.grow(entries, numbers);
        cache
    }

    /// Appends empty entries, up to `entries` entries and `numbers` numbers in all.
    pub(super) fn grow(&mut self, entries: usize, numbers: usize) {
        self.stamps.resize_with(entries, || W::new(0));
        self.words.resize_with(numbers.div_ceil(2), || W::new(0));
    }

    /// Copies the numbers of an entry to `parts`, one part after the other, and marks the entry as requested. The
    /// numbers start at index `first`, which must be even, as must the lengths of the parts. False if the entry is
    /// not of this epoch: then compute the numbers and call [`Cache::keep`].
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

    /// Stores the numbers of an entry and marks it as requested. The arguments are those of [`Cache::recall`].
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

    /// The entries that were requested in this epoch.
    pub(super) fn asked(&self, epoch: u64) -> impl Iterator<Item = usize> {
        self.entries_with(move |stamp| stamp == epoch)
    }

    /// The entries that are filled in this epoch, requested or not.
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
    /// [`Cache::keep`] with exclusive access, without marking the entry as requested. An entry that was already
    /// requested in this epoch stays marked.
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

    /// Copies numbers out, of any epoch, with exclusive access.
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

    /// Size of the arrays in bytes.
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
