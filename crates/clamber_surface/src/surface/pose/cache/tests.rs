//! The protocol of the cache under every interleaving and every order of memory that
//! [loom] finds, and the cache by itself.

use std::sync::atomic::AtomicU64;

use super::{Cache, Ordering, Word};

impl Word for loom::sync::atomic::AtomicU64 {
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

/// Marks entries as [`super::super::UNASKED`] does.
const AHEAD: u64 = 1 << 63;

/// What everybody computes for the entry in an epoch; never 0, which is what an empty one holds.
fn computed(epoch: u64) -> [f32; 4] {
    [1.0, 2.0, 3.0, 4.0].map(|x| x * epoch as f32)
}

/// Asks for the entry as a pose does: out of the cache if the stamp says so, and computed and stored
/// otherwise. True if it was in the cache.
fn ask<W: Word>(cache: &Cache<W>, epoch: u64) -> bool {
    let stamp = cache.stamp(0);
    let filled = stamp & !AHEAD == epoch;
    if filled {
        let mut numbers = [0.0; 4];
        cache.load(0, &mut numbers);
        assert_eq!(numbers, computed(epoch), "stamp {stamp:#x}");
        if stamp & AHEAD != 0 {
            cache.set_stamp(0, epoch);
        }
    } else {
        cache.store(0, &computed(epoch));
        cache.set_stamp(0, epoch);
    }
    filled
}

type LoomCache = Cache<loom::sync::atomic::AtomicU64>;

/// Has some threads ask for one entry, in every way that two can meet; of more, in every way that
/// takes at most two preemptions, since all of them take more than ten minutes.
fn meet(threads: usize, prepare: fn(&LoomCache), epoch: u64) {
    let mut model = loom::model::Builder::new();
    model.preemption_bound = (threads > 2).then_some(2);
    model.check(move || {
        let cache = LoomCache::new(1, 4);
        prepare(&cache);
        let cache = loom::sync::Arc::new(cache);
        let others: Vec<_> = (1..threads)
            .map(|_| {
                let cache = cache.clone();
                loom::thread::spawn(move || ask(&cache, epoch))
            })
            .collect();
        ask(&cache, epoch);
        for other in others {
            other.join().unwrap();
        }
        // Whoever comes later finds it filled.
        assert!(ask(&cache, epoch));
        assert_eq!(cache.stamp(0), epoch);
    });
}

#[test]
fn two_threads_that_meet_at_an_empty_entry_read_what_was_computed() {
    meet(2, |_| {}, 1);
}

#[test]
fn three_threads_that_meet_at_an_empty_entry_read_what_was_computed() {
    meet(3, |_| {}, 1);
}

#[test]
fn threads_that_meet_at_an_outdated_entry_read_what_was_computed_anew() {
    let outdated = |cache: &LoomCache| assert!(!ask(cache, 1));
    meet(2, outdated, 2);
}

#[test]
fn threads_that_meet_at_an_entry_filled_ahead_read_it() {
    let ahead = |cache: &LoomCache| {
        cache.store(0, &computed(1));
        cache.set_stamp(0, 1 | AHEAD);
    };
    meet(3, ahead, 1);
}

#[test]
fn a_new_epoch_outdates_every_entry_and_stamps_tell_who_asked() {
    let mut cache = Cache::<AtomicU64>::new(3, 12);
    let with = |cache: &Cache, stamp: u64| -> Vec<usize> {
        cache.entries_with(|found| found == stamp).collect()
    };
    assert_eq!(with(&cache, 0), [0, 1, 2]);
    assert!(!ask(&cache, 1));
    assert!(ask(&cache, 1));
    assert!(!ask(&cache, 2), "outdated");
    assert!(ask(&cache, 2));
    cache.set(4, &computed(2));
    cache.set_stamp(1, 2 | AHEAD);
    assert_eq!(with(&cache, 2), [0]);
    assert_eq!(with(&cache, 2 | AHEAD), [1]);
    assert_eq!(with(&cache, 0), [2]);
    let mut numbers = [0.0; 4];
    cache.load(4, &mut numbers);
    assert_eq!(numbers, computed(2));
}

#[test]
fn numbers_keep_their_bits_and_their_neighbours() {
    let mut cache = Cache::<AtomicU64>::new(1, 8);
    let odd = [f32::NAN, -0.0, f32::from_bits(1), f32::INFINITY];
    cache.store(2, &odd);
    let mut all = [1.0; 8];
    cache.load(0, &mut all);
    let bits = |numbers: &[f32]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&all), bits(&[&[0.0; 2], &odd[..], &[0.0; 2]].concat()));
    cache.set(6, &[5.0, -6.0]);
    cache.set(0, &[f32::MAX, 7.0]);
    cache.load(0, &mut all);
    assert_eq!(
        bits(&all),
        bits(&[&[f32::MAX, 7.0], &odd[..], &[5.0, -6.0]].concat())
    );
    assert_eq!(cache.memory(), 8 * 5);
}
