//! Tests the protocol of the cache under every interleaving and every memory order that [loom] finds, and the cache
//! by itself.

use std::sync::atomic::AtomicU64;

use super::{Cache, Ordering, UNASKED, Word};

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

/// The numbers that every thread computes for the entry in an epoch. Never 0, which an empty entry holds.
fn computed(epoch: u64) -> [f32; 4] {
    [1.0, 2.0, 3.0, 4.0].map(|x| x * epoch as f32)
}

/// Requests the entry as a pose does; false if it had to be computed.
fn ask<W: Word>(cache: &Cache<W>, epoch: u64) -> bool {
    let mut numbers = [0.0; 4];
    let known = cache.recall(0, epoch, 0, [&mut numbers[..]]);
    if known {
        assert_eq!(numbers, computed(epoch), "epoch {epoch}");
    } else {
        cache.keep(0, epoch, 0, [&computed(epoch)[..]]);
    }
    known
}

type LoomCache = Cache<loom::sync::atomic::AtomicU64>;

/// Lets some threads request one entry at the same time. Explores all interleavings of two threads. With more
/// threads it explores those with at most two preemptions, since all of them take more than ten minutes.
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
        // A later request finds it filled.
        assert!(ask(&cache, epoch));
    });
}

#[test]
fn two_threads_at_an_empty_entry_read_the_computed_numbers() {
    meet(2, |_| {}, 1);
}

#[test]
fn three_threads_at_an_empty_entry_read_the_computed_numbers() {
    meet(3, |_| {}, 1);
}

#[test]
fn threads_at_an_entry_of_an_old_epoch_read_the_new_numbers() {
    let outdated = |cache: &LoomCache| assert!(!ask(cache, 1));
    meet(2, outdated, 2);
}

#[test]
fn threads_at_an_entry_filled_ahead_read_its_numbers() {
    let ahead = |cache: &LoomCache| {
        cache.keep(0, 1 | UNASKED, 0, [&computed(1)[..]]);
    };
    meet(3, ahead, 1);
}

#[test]
fn a_new_epoch_invalidates_every_entry_and_stamps_tell_which_were_requested() {
    let mut cache = Cache::<AtomicU64>::new(3, 12);
    let asked = |cache: &Cache, epoch: u64| cache.asked(epoch).collect::<Vec<_>>();
    let filled = |cache: &Cache, epoch: u64| cache.filled(epoch).collect::<Vec<_>>();
    assert_eq!([ask(&cache, 1), ask(&cache, 1)], [false, true]);
    assert_eq!([ask(&cache, 2), ask(&cache, 2)], [false, true], "outdated");
    cache.keep_ahead(1, 2, 4, [&computed(2)[..]]);
    cache.keep_ahead(0, 2, 0, [&computed(2)[..]]);
    assert_eq!((asked(&cache, 2), filled(&cache, 2)), (vec![0], vec![0, 1]));
    let mut numbers = [0.0; 4];
    assert!(cache.recall(1, 2, 4, [&mut numbers[..]]));
    assert_eq!(numbers, computed(2));
    assert_eq!(
        (asked(&cache, 2), filled(&cache, 2)),
        (vec![0, 1], vec![0, 1])
    );
    assert_eq!((asked(&cache, 3), filled(&cache, 3)), (vec![], vec![]));
}

#[test]
fn numbers_keep_their_bits_and_leave_their_neighbours_alone() {
    let mut cache = Cache::<AtomicU64>::new(1, 8);
    let odd = [f32::NAN, -0.0, f32::from_bits(1), f32::INFINITY];
    let (start, end) = odd.split_at(2);
    cache.keep(0, 1, 2, [start, end]);
    let mut all = [1.0; 8];
    cache.peek(0, [&mut all[..]]);
    let bits = |numbers: &[f32]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&all), bits(&[&[0.0; 2], &odd[..], &[0.0; 2]].concat()));
    cache.keep_ahead(0, 1, 6, [&[5.0, -6.0][..]]);
    cache.keep_ahead(0, 1, 0, [&[f32::MAX, 7.0][..]]);
    let (start, end) = all.split_at_mut(4);
    assert!(cache.recall(0, 1, 0, [start, end]));
    assert_eq!(
        bits(&all),
        bits(&[&[f32::MAX, 7.0], &odd[..], &[5.0, -6.0]].concat())
    );
    assert_eq!(cache.memory(), 8 * 5);
}
