//! Times of queries, by class.

use std::collections::BTreeMap;
use std::time::Instant;

use super::MeshFamily;

/// A class of similar queries, in any pose. The pose matters only through the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Class {
    /// The mesh.
    pub mesh: MeshFamily,
    /// Approximate number of triangles.
    pub triangles: usize,
    /// Name of the query and its aim.
    pub query: &'static str,
    /// Work of the query: nodes of the hierarchy, plus four times the clusters, plus eight times the triangles, about
    /// in proportion to their cost. It is rounded up to a power of four minus one.
    pub work: usize,
}

/// Smallest median of a class, nanoseconds; a shorter one is replaced by it. A query that the root's box rules out
/// takes a twentieth of this time, which is no measure for queries that get a little farther.
pub const FLOOR: f64 = 1_000.0;

/// The largest allowed ratio of the slowest queries of a class to the class's median.
pub const LIMIT: f64 = 20.0;

/// A query that takes more than this many times the median is timed again, and its shortest time counts.
pub const DOUBTFUL: f64 = 4.0;

/// Number of times that a query is timed again.
const AGAIN: usize = 3;

/// Number of first queries of a class that are always timed again, since the class's median is not yet reliable.
const FEW: usize = 16;

/// Times of queries by class.
#[derive(Clone, Debug, Default)]
pub struct Times {
    classes: BTreeMap<Class, Samples>,
}

#[derive(Clone, Debug, Default)]
struct Samples {
    nanoseconds: Vec<f32>,
    /// Approximate median, computed again whenever the number of samples has doubled.
    median: f32,
    worst: f32,
    /// The case with the longest time.
    of: String,
}

/// Summary of a class's times.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Number of queries.
    pub count: usize,
    /// Median time, nanoseconds.
    pub median: f64,
    /// The 99.9th percentile of the times, nanoseconds. With fewer than 1,000 queries it is the longest time.
    pub p999: f64,
    /// The case with the longest time.
    pub longest: String,
}

impl Summary {
    /// `p999` divided by the median, or by [`FLOOR`] if the median is smaller.
    pub fn ratio(&self) -> f64 {
        self.p999 / self.median.max(FLOOR)
    }
}

impl Times {
    /// Times a query. The first queries of a class, and queries that take more than [`DOUBTFUL`] times the median so
    /// far, are timed three times more right away, and the shortest time counts: another process may have had the core.
    pub(super) fn add(&mut self, class: Class, case: &impl ToString, mut ask: impl FnMut()) {
        let mut time = || {
            let start = Instant::now();
            ask();
            start.elapsed().as_nanos() as f32
        };
        let samples = self.classes.entry(class).or_default();
        let mut taken = time();
        let slow = samples.median.max(FLOOR as f32) * DOUBTFUL as f32;
        if samples.nanoseconds.len() < FEW || taken > slow {
            for _ in 0..AGAIN {
                taken = taken.min(time());
            }
        }
        if taken > samples.worst {
            samples.worst = taken;
            samples.of = case.to_string();
        }
        samples.nanoseconds.push(taken);
        if samples.nanoseconds.len().is_power_of_two() {
            samples.median = quantile(&samples.nanoseconds, 0.5);
        }
    }

    /// The summaries of all classes.
    pub fn summaries(&self) -> impl Iterator<Item = (Class, Summary)> {
        let all = self.classes.iter();
        all.map(|(class, samples)| (*class, samples.summary()))
    }

    /// [`Times::summaries`], with classes merged that differ only in their work. A merged class has a work of 0.
    pub fn whatever_work(&self) -> Vec<(Class, Summary)> {
        let mut merged: BTreeMap<Class, Samples> = BTreeMap::new();
        for (class, samples) in &self.classes {
            let into = merged.entry(Class { work: 0, ..*class }).or_default();
            into.nanoseconds.extend(&samples.nanoseconds);
            if samples.worst > into.worst {
                into.worst = samples.worst;
                into.of.clone_from(&samples.of);
            }
        }
        let all = merged.into_iter();
        all.map(|(class, samples)| (class, samples.summary()))
            .collect()
    }
}

impl Samples {
    fn summary(&self) -> Summary {
        let all = &self.nanoseconds;
        Summary {
            count: all.len(),
            median: quantile(all, 0.5).into(),
            p999: quantile(all, 0.999).into(),
            longest: self.of.clone(),
        }
    }
}

fn quantile(values: &[f32], part: f64) -> f32 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f32::total_cmp);
    let index = ((sorted.len() as f64 * part).ceil() as usize).saturating_sub(1);
    sorted[index.min(sorted.len() - 1)]
}
