//! The memory of palettes that were written is used again.

use std::time::Duration;

use allocation_counter::measure;
use clamber_record::{RecordOptions, Recorder, TickView};
use clamber_scenes::battle::{Battle, BattleOptions};
use clamber_scenes::giant::giant;

use crate::figure::{info, view};

/// Length of a chunk, ticks.
const CHUNK: u64 = 10;

/// Largest number of chunks that are recorded.
const CHUNKS: u64 = 100;

/// Once the first chunks are written, a tick without views allocates nothing. Only handing a chunk over does.
#[test]
fn a_tick_without_views_allocates_nothing() {
    let creature = giant().unwrap();
    let battle = Battle::new(&creature, &BattleOptions::ride(0, 1)).unwrap();
    let options = RecordOptions {
        transforms_every: 0,
        skin_every: 0,
        touched_every: 0,
        chunk_ticks: CHUNK as u32,
        ..RecordOptions::waiting()
    };
    let skeleton = &creature.rig.skeleton;
    let out = std::io::sink();
    let mut recorder = Recorder::new(out, &info(&battle), skeleton, options).unwrap();
    let mut record = |tick: u64| {
        let view = TickView {
            tick,
            ..view(&battle)
        };
        measure(|| recorder.tick(&view).unwrap()).count_total
    };
    let mut counts = Vec::new();
    for chunk in 0..CHUNKS {
        // The first tick of a chunk hands the chunk before it over. The writing thread looks for it after 50 ms at the
        // latest. On a busy machine it may take longer: then the next chunks are tried.
        let first = chunk * CHUNK;
        record(first);
        std::thread::sleep(Duration::from_millis(80));
        counts.push((first + 1..first + CHUNK).map(&mut record).sum::<u64>());
        if counts.last() == Some(&0) {
            break;
        }
    }
    assert_eq!(counts.last(), Some(&0), "{counts:?}");
    assert!(counts[0] >= CHUNK - 1, "nothing was counted: {counts:?}");
    recorder.finish().unwrap();
}
