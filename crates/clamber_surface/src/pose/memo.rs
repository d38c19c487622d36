//! Values that are computed on demand, without unsafe.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

/// Values by index that queries compute on demand, shared by any number of threads.
///
/// A value is computed once, where it is first requested, and handed out by reference. If two threads request it at the
/// same time, one waits for the other. Forgetting takes `&mut`, and costs O(values), and one bit per entry if entries
/// were filled ahead.
///
/// Entries without a value take a pointer each. Forgotten values are written again, the last one first, so few values
/// are in use, and stay in the processor's caches, however many entries there are. With a few more values than were
/// ever needed, a steady use allocates nothing.
#[derive(Debug)]
pub(super) struct Memo<T> {
    entries: Vec<OnceLock<Box<T>>>,
    /// A bit for every entry that was requested, kept only while `ahead`.
    asked: Bits,
    /// True if entries were filled before they were requested. If false, every entry with a value was requested.
    ahead: bool,
    shelf: Mutex<Shelf<T>>,
    /// The most values that were ever needed at once.
    most: usize,
}

/// The data that a thread needs to fill an entry. It is under one lock: taking a lock costs as much as bounding a
/// joint.
#[derive(Debug)]
struct Shelf<T> {
    /// Forgotten values, and some that were never used.
    spare: Vec<Box<T>>,
    /// The entries that have a value, in any order. One whose computation has panicked may be here without a value, or
    /// twice.
    filled: Vec<u32>,
}

/// Spare values are made in advance: the most that were ever needed, an eighth more, and this number more.
const AHEAD: usize = 32;

impl<T: Default> Memo<T> {
    pub(super) fn new(entries: usize) -> Self {
        let shelf = Shelf {
            spare: Vec::new(),
            filled: Vec::new(),
        };
        let mut memo = Self {
            entries: Vec::new(),
            asked: Bits::default(),
            ahead: false,
            shelf: Mutex::new(shelf),
            most: 0,
        };
        memo.grow(entries);
        memo
    }

    /// Appends entries without a value, up to `entries` in all.
    pub(super) fn grow(&mut self, entries: usize) {
        self.entries.resize_with(entries, OnceLock::new);
        self.asked.grow(entries);
    }

    /// The value of an entry, and marks it as requested. If the entry has no value, `compute` writes it over a default
    /// or forgotten value.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn get(&self, entry: usize, compute: impl FnOnce(&mut T)) -> &T {
        if self.ahead {
            self.asked.set(entry);
        }
        match self.entries[entry].get() {
            Some(value) => value,
            None => self.fill(entry, compute),
        }
    }

    #[cold]
    #[inline(never)]
    fn fill(&self, entry: usize, compute: impl FnOnce(&mut T)) -> &T {
        self.entries[entry].get_or_init(|| {
            let mut shelf = self.shelf();
            shelf.filled.push(entry as u32);
            let spare = shelf.spare.pop();
            drop(shelf);
            let mut value = spare.unwrap_or_default();
            compute(&mut value);
            value
        })
    }

    fn shelf(&self) -> MutexGuard<'_, Shelf<T>> {
        self.shelf.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Computes an entry, again if it has a value, without marking it as requested.
    pub(super) fn fill_ahead(&mut self, entry: usize, compute: impl FnOnce(&mut T)) {
        if !self.ahead {
            self.ahead = true;
            for entry in self.filled() {
                self.asked.set(entry);
            }
        }
        match self.entries[entry].get_mut() {
            Some(value) => compute(value),
            None => {
                self.fill(entry, compute);
            }
        }
    }

    /// The value of an entry, if it has one.
    pub(super) fn peek(&self, entry: usize) -> Option<&T> {
        self.entries[entry].get().map(|value| &**value)
    }

    /// Empties some entries. O(values and entries given).
    pub(super) fn forget(&mut self, entries: &[u32]) {
        let shelf = self.shelf.get_mut();
        let shelf = shelf.unwrap_or_else(PoisonError::into_inner);
        for entry in entries {
            let entry = *entry as usize;
            shelf.spare.extend(self.entries[entry].take());
            self.asked.clear(entry);
        }
        let entries = &self.entries;
        shelf
            .filled
            .retain(|entry| entries[*entry as usize].get().is_some());
    }

    /// Empties all entries.
    pub(super) fn forget_all(&mut self) {
        let shelf = self.shelf.get_mut();
        let shelf = shelf.unwrap_or_else(PoisonError::into_inner);
        let unused = shelf.spare.len();
        for entry in shelf.filled.drain(..) {
            shelf.spare.extend(self.entries[entry as usize].take());
        }
        self.most = self.most.max(shelf.spare.len() - unused);
        let wanted = (self.most + self.most / 8 + AHEAD).min(self.entries.len());
        shelf.filled.reserve(wanted);
        while shelf.spare.len() < wanted {
            shelf.spare.push(Box::default());
        }
        if self.ahead {
            self.asked.clear_all();
            self.ahead = false;
        }
    }

    /// Calls `visit` with the entries that were requested, in any order. It must not request any.
    pub(super) fn each_asked(&self, mut visit: impl FnMut(usize)) {
        if self.ahead {
            self.asked.iter().for_each(visit);
        } else {
            self.each_filled(&mut visit);
        }
    }

    /// Calls `visit` with the entries that have a value, requested or not, in any order. It must not request any.
    pub(super) fn each_filled(&self, mut visit: impl FnMut(usize)) {
        for entry in &self.shelf().filled {
            let entry = *entry as usize;
            if self.peek(entry).is_some() {
                visit(entry);
            }
        }
    }

    /// The entries that were requested, ascending.
    pub(super) fn asked(&self) -> Vec<usize> {
        let mut asked = Vec::new();
        self.each_asked(|entry| asked.push(entry));
        sorted(asked)
    }

    /// The entries that have a value, requested or not, ascending.
    pub(super) fn filled(&self) -> Vec<usize> {
        let mut filled = Vec::new();
        self.each_filled(|entry| filled.push(entry));
        sorted(filled)
    }

    /// Size in bytes, values included.
    pub(super) fn memory(&self) -> usize {
        let shelf = self.shelf();
        let values = shelf.spare.len() + shelf.filled.len();
        let lists = size_of_val(&self.asked.0[..]) + size_of_val(&shelf.filled[..]);
        size_of_val(&self.entries[..]) + lists + values * size_of::<T>()
    }
}

fn sorted(mut entries: Vec<usize>) -> Vec<usize> {
    entries.sort_unstable();
    entries.dedup();
    entries
}

/// A bit per entry, which threads may set at the same time.
#[derive(Debug, Default)]
struct Bits(Vec<AtomicU64>);

/// Number of bits in a word.
const WORD: usize = u64::BITS as usize;

impl Bits {
    fn grow(&mut self, bits: usize) {
        self.0.resize_with(bits.div_ceil(WORD), AtomicU64::default);
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn set(&self, bit: usize) {
        let (word, bit) = (&self.0[bit / WORD], 1 << (bit % WORD));
        // Read first, so that a line which several threads read is seldom written.
        if word.load(Ordering::Relaxed) & bit == 0 {
            word.fetch_or(bit, Ordering::Relaxed);
        }
    }

    fn clear(&mut self, bit: usize) {
        *self.0[bit / WORD].get_mut() &= !(1 << (bit % WORD));
    }

    fn clear_all(&mut self) {
        for word in &mut self.0 {
            *word.get_mut() = 0;
        }
    }

    fn iter(&self) -> impl Iterator<Item = usize> {
        self.0.iter().enumerate().flat_map(|(index, word)| {
            let mut word = word.load(Ordering::Relaxed);
            std::iter::from_fn(move || {
                let bit = word.trailing_zeros() as usize;
                word &= word.wrapping_sub(1);
                (bit < WORD).then_some(index * WORD + bit)
            })
        })
    }
}

#[cfg(test)]
mod tests;
