//! Real models, cut short or with flipped bits: loading gives an error or a usable model, never a panic, an endless
//! loop, or unbounded memory.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use std::time::{Duration, Instant};

use allocation_counter::measure;
use clamber::gltf::{LoadOptions, load_slice};
use clamber::prelude::*;
use clamber_scenes::test_data;

/// Number of cuts of each model, and of variants with flipped bits: a fifth of 1,000, or all of them if the variable
/// `CLAMBER_ALL_CASES` is set, as `cargo xtask nightly` does.
fn trials() -> usize {
    match std::env::var_os("CLAMBER_ALL_CASES") {
        Some(_) => 1_000,
        None => 200,
    }
}

/// Largest peak of memory, bytes per byte of the file.
const MEMORY: u64 = 100;

/// Longest time that a broken model may take to load. Models load in milliseconds; this limit only finds endless loops.
const PATIENCE: Duration = Duration::from_secs(20);

#[test]
fn cut_models_are_refused() {
    let loaded = each_model("cut models", |bytes, rng| {
        let mut cut = bytes[..rng.usize(0..bytes.len())].to_vec();
        // Half of the cut files have the remaining length in their header.
        if cut.len() >= 12 && rng.bool() {
            let length = cut.len() as u32;
            cut[8..12].copy_from_slice(&length.to_le_bytes());
        }
        cut
    });
    assert_eq!(loaded, 0);
}

#[test]
fn models_with_flipped_bits_load_or_are_refused() {
    each_model("models with flipped bits", |bytes, rng| {
        let mut flipped = bytes.to_vec();
        // In half of the files, only bits of the headers and the JSON are flipped: these matter most.
        let length = u32::from_le_bytes([bytes[12], bytes[13], bytes[14], bytes[15]]) as usize;
        let reach = if rng.bool() { length + 20 } else { bytes.len() };
        for _ in 0..rng.usize(1..4) {
            flipped[rng.usize(0..reach)] ^= 1 << rng.u32(0..8);
        }
        flipped
    });
}

/// Loads variants of every model, made by `broken`, and poses the variants that load; returns their number.
fn each_model(test: &str, broken: impl Fn(&[u8], &mut fastrand::Rng) -> Vec<u8>) -> usize {
    let mut all_loaded = 0;
    for path in test_data::five_models(test) {
        let name = path.display();
        let bytes = std::fs::read(&path).unwrap();
        let mut rng = fastrand::Rng::with_seed(37);
        let (mut loaded, mut worst) = (0, 0);
        for trial in 0..trials() {
            let bytes = broken(&bytes, &mut rng);
            let mut model = None;
            let start = Instant::now();
            let memory = measure(|| model = load_slice(&bytes, &LoadOptions::default()).ok());
            assert!(
                start.elapsed() < PATIENCE,
                "{name}, trial {trial}: {:?}",
                start.elapsed()
            );
            let allowed = MEMORY * bytes.len().max(1 << 10) as u64;
            assert!(
                memory.bytes_max < allowed,
                "{name}, trial {trial}: {memory:?}"
            );
            worst = worst.max(memory.bytes_max / bytes.len().max(1 << 10) as u64);
            let Some(model) = model else {
                continue;
            };
            loaded += 1;
            // A rig that loads can be posed, or gives an error.
            let mut surface = SkinnedSurface::new(model.rig.collider.clone());
            let mut positions = Vec::new();
            let clip = model.rig.clips.get(trial % model.rig.clips.len().max(1));
            let rest = model.rig.skeleton.rest_pose();
            let pose = clip.map(|clip| clip.sample(&rest, clip.duration() * 0.3, Playback::Loop));
            if let Ok(palette) = model
                .rig
                .skeleton
                .palette(&pose.and_then(Result::ok).unwrap_or(rest))
                && surface.advance(&palette, Similarity::IDENTITY).is_ok()
            {
                surface.skin_all(&mut positions);
                assert!(
                    positions.iter().all(|p| p.is_finite()),
                    "{name}, trial {trial}"
                );
            }
        }
        let trials = trials();
        println!("{test}: {name}: {loaded} of {trials} load, memory up to {worst} times the file");
        all_loaded += loaded;
    }
    all_loaded
}
