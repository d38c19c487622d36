//! Tools that benches share: tables, plots, quantiles, times, cold caches, and the exact smallest ball.

mod caches;
mod cells;
mod plot;
mod smallest_ball;
mod table;

pub use caches::{Caches, Stream};
pub use cells::{Bound, Cells, measure_folder};
pub use plot::{Plot, Series};
pub use smallest_ball::{Ball, smallest_ball};
pub use table::Table;

use std::time::{Duration, Instant};

/// True if a bench should run briefly, by criterion's rule: always, unless `--bench` is passed, as `cargo bench`
/// does, and `--test` is not.
pub fn is_brief() -> bool {
    let passed = |flag: &str| std::env::args().any(|argument| argument == flag);
    !passed("--bench") || passed("--test")
}

/// The smallest of `values` that at least the share `part` (0 to 1) of them does not exceed; NaN without
/// values. Sorts `values`.
pub fn quantile(values: &mut [f64], part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let index = (values.len() as f64 * part).ceil() as usize;
    let last = values.len().checked_sub(1);
    last.map_or(f64::NAN, |last| values[index.saturating_sub(1).min(last)])
}

/// The median time of `run`, microseconds, over as many runs as fit into `budget`, at least three. One run
/// before them is not counted.
pub fn median_us(budget: Duration, mut run: impl FnMut()) -> f64 {
    run();
    let begin = Instant::now();
    let mut times = Vec::new();
    while times.len() < 3 || begin.elapsed() < budget {
        let start = Instant::now();
        run();
        times.push(start.elapsed().as_secs_f64() * 1e6);
    }
    quantile(&mut times, 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_of_few_values() {
        let mut values = [4.0, 1.0, 3.0, 2.0];
        assert_eq!(quantile(&mut values, 0.5), 2.0);
        assert_eq!(quantile(&mut values, 0.95), 4.0);
        assert_eq!(quantile(&mut values, 0.0), 1.0);
        assert!(quantile(&mut [], 0.5).is_nan());
    }
}
