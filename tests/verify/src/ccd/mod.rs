//! Tests the library's sweeps with continuous collision queries whose exact answers are known: from files ([`run`]), or
//! one by one ([`Stage`]).
//!
//! The answers to a file's queries are checked in rational numbers, with the exact points of the file.

mod options;
mod report;
mod stage;

use std::error::Error;
use std::time::Duration;

use crate::exact::{Apart, Claim, Last, Motion, number};
use crate::queries::{FileQuery, read_queries};
use indicatif::{ProgressBar, ProgressStyle};

pub use options::CcdOptions;
pub use report::CcdReport;
pub use stage::{Answer, CAP, Stage};

/// Runs all queries of all files. Shows a progress bar on standard error.
pub fn run(options: &CcdOptions) -> Result<CcdReport, Box<dyn Error>> {
    let mut files = Vec::new();
    for file in &options.files {
        files.push((file, read_queries(file)?));
    }
    let all: usize = files.iter().map(|(_, queries)| queries.len()).sum();
    let bar = ProgressBar::new(all as u64);
    let style =
        ProgressStyle::with_template("{bar:40} {percent:>3} % of the queries  [{eta} left]");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let mut stage = Stage::new()?;
    let mut report = CcdReport::default();
    let mut took = Duration::ZERO;
    for (file, queries) in &files {
        for query in queries {
            let (pair, tolerance) = (query.rounded(), query.tolerance());
            let answer = stage.sweep(&pair, tolerance);
            let answer =
                answer.map_err(|error| format!("{}:{}: {error}", file.display(), query.line))?;
            took += answer.took;
            report.worst_steps = report.worst_steps.max(answer.steps);
            report.count(query, &answer.claim());
            bar.inc(1);
        }
    }
    bar.finish_and_clear();
    report.ns_per_query = took.as_secs_f64() * 1e9 / (report.queries.max(1) as f64);
    Ok(report)
}

impl CcdReport {
    /// Counts a claim about a query, and any fault of it.
    ///
    /// # Panics
    /// If the claimed time is not in 0..=1.
    pub fn count(&mut self, query: &FileQuery, claim: &Claim) {
        let verdict = claim.check(&query.rounded(), query.tolerance());
        self.queries += 1;
        self.late += usize::from(verdict.is_late());
        self.unproved += usize::from(verdict.is_unknown());
        self.undecided += usize::from(claim.undecided);
        let Some(time) = claim.time else {
            self.misses += 1;
            self.false_negatives += usize::from(query.touches);
            return;
        };
        self.hits += 1;
        self.near_misses_hit += usize::from(!query.touches);
        let motion = Motion::of_exact(query.exact());
        if !motion.exact().is_within(time, &number(query.reach())) {
            match motion.apart(query.reach(), 1.0, Last::Included) {
                Apart::Always => self.false_positives += 1,
                Apart::Until(_) => {}
                Apart::Unknown(_) => self.unproved += 1,
            }
        }
    }
}

#[cfg(test)]
mod tests;
