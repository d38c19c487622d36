use std::fmt;

use serde::Serialize;

/// Numbers of the sweeps' answers, and of the wrong answers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct CcdReport {
    /// Queries that were run.
    pub queries: usize,
    /// Queries answered with a contact.
    pub hits: usize,
    /// Queries answered without a contact.
    pub misses: usize,
    /// Hits although the file says that the motion does not touch. Such a hit is correct if the motion comes within
    /// radius and tolerance.
    pub near_misses_hit: usize,
    /// Misses although the file says that the motion touches.
    pub false_negatives: usize,
    /// Hits although the motion never comes within radius and tolerance.
    pub false_positives: usize,
    /// Late answers: the rounded points come within the radius before the claimed time of contact, or at all if no
    /// contact is claimed.
    pub late: usize,
    /// Answers that could neither be proved nor refuted.
    pub unproved: usize,
    /// Hits that the sweep flagged as undecided: the contact may be beyond the tolerance.
    pub undecided: usize,
    /// Largest number of steps of the exact test in a query.
    pub worst_steps: u32,
    /// Mean time of a query with empty skin caches, nanoseconds.
    pub ns_per_query: f64,
}

impl CcdReport {
    /// True if no answer is wrong or unproved.
    pub fn holds(&self) -> bool {
        self.false_negatives + self.false_positives + self.late + self.unproved == 0
    }

    /// The report as one JSON object.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_else(|error| error.to_string())
    }
}

impl fmt::Display for CcdReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = [
            ("queries", self.queries),
            ("hits", self.hits),
            ("misses", self.misses),
            ("hits of near misses", self.near_misses_hit),
            ("false negatives", self.false_negatives),
            ("false positives", self.false_positives),
            ("late", self.late),
            ("unproved", self.unproved),
            ("undecided", self.undecided),
            ("most steps", self.worst_steps as usize),
        ];
        for (name, count) in counts {
            writeln!(f, "  {name:<20}{count:>8}")?;
        }
        writeln!(f, "  {:<20}{:>8.0}", "ns per query", self.ns_per_query)
    }
}
