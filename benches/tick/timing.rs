//! Times whole ticks of all contenders in turn, so that all run under the same conditions of the machine.

use std::hint::black_box;
use std::time::Instant;

use clamber_scenes::measure::quantile;
use clamber_scenes::riders::Tick;

use crate::contender::Contender;

/// Bytes streamed between cold ticks, in place of the rest of a game: more than the caches hold.
const STREAM: usize = 64 << 20;

/// Whether a tick finds its data in the processor's caches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Caches {
    /// The caches hold the data of the tick before.
    Warm,
    /// The caches hold other data: see [`Stream`].
    Cold,
}

/// Memory to stream before a cold tick.
pub(crate) struct Stream(Vec<u64>);

impl Default for Stream {
    fn default() -> Self {
        Self(vec![1; STREAM / 8])
    }
}

impl Stream {
    /// Reads and writes all of the memory, which evicts other data from the caches.
    fn run(&mut self) {
        for number in &mut self.0 {
            *number = number.wrapping_mul(3);
        }
        black_box(&self.0);
    }
}

/// Times all contenders on all ticks, with warm or cold caches.
pub(crate) fn race(
    contenders: &mut [&mut dyn Contender],
    ticks: &[Tick],
    caches: Caches,
    stream: &mut Stream,
) -> Vec<Lap> {
    let mut times = vec![Vec::with_capacity(ticks.len()); contenders.len()];
    let mut hits = vec![0; contenders.len()];
    // The first three ticks warm up and are not counted.
    for (turn, tick) in ticks.iter().take(3).chain(ticks).enumerate() {
        for (k, contender) in contenders.iter_mut().enumerate() {
            if caches == Caches::Cold {
                stream.run();
            } else {
                // Two ticks that are not counted bring back the data that the others evicted. It takes two, since every
                // other tick has its own cache.
                black_box(contender.tick(tick));
                black_box(contender.tick(tick));
            }
            let start = Instant::now();
            let found = black_box(contender.tick(tick));
            let elapsed = start.elapsed().as_secs_f64() * 1e6;
            if turn >= 3 {
                times[k].push(elapsed);
                hits[k] += found;
            }
        }
    }
    let laps = times.iter_mut().zip(hits);
    laps.map(|(times, hits)| Lap {
        median_us: quantile(times, 0.5),
        quartiles_us: [quantile(times, 0.25), quantile(times, 0.75)],
        hits,
    })
    .collect()
}

/// A contender's result: quantiles of the time of a tick, and the number of hits in all ticks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lap {
    pub(crate) median_us: f64,
    pub(crate) quartiles_us: [f64; 2],
    pub(crate) hits: usize,
}

impl Lap {
    /// This median divided by another's.
    pub(crate) fn over(&self, other: &Self) -> f64 {
        self.median_us / other.median_us
    }
}
