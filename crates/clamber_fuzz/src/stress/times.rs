//! How long queries take, by what they are.

use std::collections::BTreeMap;
use std::time::Instant;

use super::MeshFamily;

/// Queries that are alike, in whatever pose: where poses make a difference, it is in the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Class {
    /// On what.
    pub mesh: MeshFamily,
    /// Of about how many triangles.
    pub triangles: usize,
    /// Which query, aimed how.
    pub query: &'static str,
    /// How much it had to do: nodes of the hierarchy, four times the clusters and eight times the triangles, which is
    /// about what they cost; rounded up to a power of four less one.
    pub work: usize,
}

impl Class {
    /// The class with so much work.
    pub(super) fn with_work(self, done: usize) -> Self {
        let mut work = 0;
        while work < done {
            work = work * 4 + 3;
        }
        Self { work, ..self }
    }
}

/// Medians below this count as this, nanoseconds: what the first box rules out takes a twentieth of it, and is no measure
/// for what goes a little farther.
pub const FLOOR: f64 = 1_000.0;

/// So many medians the slowest queries of a class may take.
pub const LIMIT: f64 = 20.0;

/// Times beyond so many medians are taken again, and the shortest counts.
pub const DOUBTFUL: f64 = 4.0;

/// How often.
const AGAIN: usize = 3;

/// So many of a class are taken again in any case: there is no median to speak of yet.
const FEW: usize = 16;

/// Times of classes.
#[derive(Clone, Debug, Default)]
pub struct Times {
    classes: BTreeMap<Class, Samples>,
}

#[derive(Clone, Debug, Default)]
struct Samples {
    nanoseconds: Vec<f32>,
    /// About; found anew whenever their number has doubled.
    median: f32,
    worst: f32,
    /// The case that took longest.
    of: String,
}

/// What a class took.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Queries.
    pub count: usize,
    /// Half of them took at most this, nanoseconds.
    pub median: f64,
    /// And 999 of 1,000 this; of fewer than 1,000 it is the slowest one's.
    pub p999: f64,
    /// The case that took longest.
    pub longest: String,
}

impl Summary {
    /// How many medians, of [`FLOOR`] at least, the slowest took.
    pub fn ratio(&self) -> f64 {
        self.p999 / self.median.max(FLOOR)
    }
}

impl Times {
    /// Times a query. One that takes more than [`DOUBTFUL`] times the median so far is asked three times more at once, and
    /// its shortest time counts: another process that had the core says nothing about the query.
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

    /// What every class took.
    pub fn summaries(&self) -> impl Iterator<Item = (Class, Summary)> {
        let all = self.classes.iter();
        all.map(|(class, samples)| (*class, samples.summary()))
    }

    /// [`Times::summaries`] with classes of unlike work thrown together; that of those is told as 0.
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
