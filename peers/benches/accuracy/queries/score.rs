//! The score of a peer on a set of queries, and the report of all scores.

use std::error::Error;

use clamber_peers::{Kind, Plot};
use clamber_scenes::measure::{Bound, Cells, Table, measure_file, quantile};

/// Share of the query's reach. A distance that is wrong by more counts as a leak or a false hit, not as an error.
const LEAK: f64 = 0.01;

/// Least error in the plots, metres; smaller errors are drawn as this one. f32 does not resolve less of a metre.
const FLOOR: f64 = 1e-9;

/// Columns of the table.
const COLUMNS: [&str; 11] = [
    "queries",
    "query",
    "method",
    "ns",
    "median error, m",
    "99 %, m",
    "worst, m",
    "latest, m",
    "leaks",
    "false hits",
    "of",
];

/// The score of a peer's answers.
#[derive(Default)]
pub(crate) struct Score {
    pub(crate) nanoseconds: f64,
    errors: Vec<f64>,
    /// Largest distance of an answer beyond the true one, metres.
    latest: f64,
    /// Answers that miss the skin, or find skin only far behind the first hit.
    leaks: usize,
    /// Answers that find skin at a place without skin.
    false_hits: usize,
    count: usize,
}

impl Score {
    pub(crate) fn add(
        &mut self,
        kind: Kind,
        expected: Option<f64>,
        more: usize,
        scale: f64,
        found: Option<f64>,
    ) {
        self.count += 1;
        match (expected, found) {
            (None, None) => {}
            (None, Some(_)) => self.false_hits += 1,
            (Some(_), None) => self.leaks += 1,
            (Some(expected), Some(found)) if kind == Kind::Overlap => {
                self.leaks += usize::from(found < expected);
                self.false_hits += usize::from(found > expected + more as f64);
            }
            (Some(expected), Some(found)) => {
                let late = found - expected;
                if late > LEAK * scale {
                    self.leaks += 1;
                } else if late < -LEAK * scale {
                    self.false_hits += 1;
                } else {
                    self.errors.push(late.abs());
                    self.latest = self.latest.max(late);
                }
            }
        }
    }
}

/// The table and the plots.
pub(crate) struct Report {
    table: Table,
    /// One for each kind of query.
    plots: [Plot; 4],
    /// Nanoseconds of ordinary queries, by kind and peer.
    times: Vec<(Kind, &'static str, f64)>,
}

impl Default for Report {
    fn default() -> Self {
        Self {
            table: Table::new(&COLUMNS),
            plots: Kind::ALL.map(|(_, name)| Plot {
                title: format!("{name}: error against time, a dot for each set of queries"),
                x: "ns a query".to_owned(),
                y: "error that 99 % stay below, m".to_owned(),
                ..Plot::default()
            }),
            times: Vec::new(),
        }
    }
}

impl Report {
    /// Adds a peer's score; `None` if it has no such query. Fails if clamber has a leak or a false hit.
    pub(crate) fn add(
        &mut self,
        set: &str,
        method: &'static str,
        kind: Kind,
        score: Option<Score>,
    ) -> Result<(), Box<dyn Error>> {
        let index = Kind::ALL.iter().position(|(known, _)| *known == kind);
        let index = index.unwrap_or_default();
        let mut row = [set, Kind::ALL[index].1, method]
            .map(str::to_owned)
            .to_vec();
        let Some(mut score) = score else {
            row.extend(["cannot"; 8].map(str::to_owned));
            self.table.push(row);
            return Ok(());
        };
        if set == "ordinary" {
            self.times.push((kind, method, score.nanoseconds));
        }
        if method.starts_with("clamber") && score.leaks + score.false_hits > 0 {
            let (leaks, wrong) = (score.leaks, score.false_hits);
            return Err(format!(
                "{set}, {}: {method}: {leaks} leaks, {wrong} false hits",
                row[1]
            )
            .into());
        }
        row.push(format!("{:.0}", score.nanoseconds));
        if kind == Kind::Overlap {
            row.extend(["", "", "", ""].map(str::to_owned));
        } else {
            let parts = [0.5, 0.99, 1.0].map(|part| quantile(&mut score.errors, part));
            row.extend(parts.map(|error| format!("{error:.1e}")));
            row.push(format!("{:.1e}", score.latest));
            let point = (score.nanoseconds, parts[1].max(FLOOR));
            self.plots[index].add(method, point);
        }
        row.extend([score.leaks, score.false_hits, score.count].map(|count| count.to_string()));
        println!("{}", row.join(", "));
        self.table.push(row);
        Ok(())
    }

    /// Compares clamber's times on ordinary queries with the peers that have bounds.
    fn compare(&self, brief: bool) -> Result<(), Box<dyn Error>> {
        let time = |kind: Kind, method: &str| {
            let times = self.times.iter();
            let mut of = times.filter(|(known, name, _)| (*known, *name) == (kind, method));
            of.next().map(|(.., ns)| *ns)
        };
        let mut cells = Cells::default();
        for (kind, peer, most) in [
            (Kind::Ray, "Embree 3 robust", 3.0),
            (Kind::Closest, "Embree 3 robust", 1.2),
            (Kind::Cast, "PhysX 5.1", 1.2),
        ] {
            if let (Some(ours), Some(other)) = (time(kind, "clamber"), time(kind, peer)) {
                let name = format!("{kind:?}, warm: clamber / {peer}");
                cells.push(&name, ours / other, Bound::Most(most));
            }
        }
        cells.finish("accuracy_times", brief)
    }

    pub(crate) fn finish(self, brief: bool) -> Result<(), Box<dyn Error>> {
        self.compare(brief)?;
        println!("\n{}", self.table);
        self.table.write("accuracy_queries", brief)?;
        for ((_, name), plot) in Kind::ALL.iter().zip(self.plots) {
            let name = format!("accuracy_{}", name.replace(' ', "_"));
            plot.write_svg(&measure_file(&name, brief, "svg"))?;
        }
        Ok(())
    }
}
