//! One fixed run on an animated skin, and the hash of every bit of its results: clips, palettes, skinning, every kind
//! of query, anchors, climbers. The hash is the same in every build, on any number of threads, at every SIMD level and
//! on every platform that runs this test. `cargo xtask ci --only golden` also runs it optimised, and for the native
//! CPU.
//!
//! [`RUN`] changes whenever a result changes by a single bit. If the change is intended, store the new hash in it, and
//! write the file with `CLAMBER_BLESS=1`.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

mod bits;
mod creature;
mod run;

use clamber_surface::SimdLevel;
use clamber_verify::golden;

/// The hash of the run. If it differs, the file beside this one tells which climber, field, query and tick differ.
const RUN: u64 = 0xfd00_9dfd_dcfa_2a93;

/// Plays the run on `threads` threads at a SIMD level.
fn assert_golden(level: SimdLevel, threads: usize) {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/run.golden");
    let held = golden::hold(file, RUN, |run| run::play(run, level, threads));
    assert!(
        held.is_ok(),
        "{} on {threads} threads: {held:?}",
        level.name()
    );
}

#[test]
fn the_run_has_the_same_bits_at_every_simd_level() {
    // In a release build, scalar code is among the levels with the feature `scalar` of `clamber_surface`, which CI
    // turns on. With debug assertions, which make the lower levels slow, only the best level is played.
    let levels = SimdLevel::available();
    let count = if cfg!(debug_assertions) {
        1
    } else {
        levels.len()
    };
    for level in levels.into_iter().take(count) {
        assert_golden(level, 1);
    }
}

#[test]
fn the_run_has_the_same_bits_on_any_number_of_threads() {
    for threads in [2, 4] {
        assert_golden(SimdLevel::best(), threads);
    }
}
