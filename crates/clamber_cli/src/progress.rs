//! Shows the progress of long work on standard error.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// A progress bar on a terminal. Elsewhere it prints a line every few seconds, so that a log shows that the work goes
/// on.
pub(crate) struct Progress {
    bar: Option<ProgressBar>,
    of: &'static str,
    all: usize,
    done: usize,
    start: Instant,
    told: Instant,
}

/// Shortest time between two lines of a log.
const EVERY: Duration = Duration::from_secs(5);

impl Progress {
    /// Progress of `all` steps. `of` names the steps, in the plural.
    pub(crate) fn new(all: usize, of: &'static str) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(all as u64);
            let template = format!("{{bar:40}} {{pos}} of {{len}} {of}  [{{eta}} left]");
            let style = ProgressStyle::with_template(&template);
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar
        });
        let now = Instant::now();
        Self {
            bar,
            of,
            all,
            done: 0,
            start: now,
            told: now,
        }
    }

    /// Counts one more step as done.
    pub(crate) fn step(&mut self) {
        self.set(self.done + 1);
    }

    /// Sets the number of steps that are done.
    pub(crate) fn set(&mut self, done: usize) {
        self.done = done;
        if let Some(bar) = &self.bar {
            bar.set_position(done as u64);
        } else if self.told.elapsed() >= EVERY && (1..self.all).contains(&self.done) {
            self.told = Instant::now();
            let each = self.start.elapsed().as_secs_f64() / self.done as f64;
            let left = each * (self.all - self.done) as f64;
            eprintln!(
                "{} of {} {}, {left:.0} s left",
                self.done, self.all, self.of
            );
        }
    }

    /// Removes the bar.
    pub(crate) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
