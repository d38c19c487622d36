//! One fixed run on an animated skin, and the hash of every bit of its results: clips, palettes, skinning, every kind
//! of query, anchors, climbers. The hash is the same in every build, on any number of threads, at every SIMD level and
//! on every platform that runs this test. `cargo xtask ci --only golden` also runs it optimised, and for the native
//! CPU.
//!
//! [`RUN`] changes whenever a result changes by a single bit. If the change is intended, store the new hashes in it.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

mod bits;
mod creature;
mod run;

use clamber_surface::SimdLevel;

/// Expected hashes: of the results of queries and anchors, and of the climbers.
const RUN: [u64; 2] = [0x1d72_8a0c_df1c_39c6, 0x54e8_3fc8_8d78_f9ad];

/// Plays the run on `threads` threads at a SIMD level. On failure prints the hashes in the form of [`RUN`].
fn assert_golden(level: SimdLevel, threads: usize) {
    let found = run::run(level, threads);
    assert!(
        found == RUN,
        "{} on {threads} threads gave [{:#018x}, {:#018x}]",
        level.name(),
        found[0],
        found[1],
    );
}

#[test]
fn the_run_has_the_same_bits_at_every_simd_level() {
    // Scalar code is among them with the feature `scalar` of `clamber_surface`, which CI turns on.
    for level in SimdLevel::available() {
        assert_golden(level, 1);
    }
}

#[test]
fn the_run_has_the_same_bits_on_any_number_of_threads() {
    for threads in [1, 2, 4] {
        assert_golden(SimdLevel::best(), threads);
    }
}
