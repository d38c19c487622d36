use std::fmt;

use serde::Serialize;

/// What the sweeps answered, and whether that is right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct CcdReport {
    /// Queries asked.
    pub queries: usize,
    /// Those with a contact.
    pub hits: usize,
    /// Those without.
    pub misses: usize,
    /// Hits where the files say that nothing touches: radius and tolerance bring them near.
    pub near_misses_hit: usize,
    /// Misses where the file says that the motion touches.
    pub false_negatives: usize,
    /// Hits of what never comes within radius and tolerance.
    pub false_positives: usize,
    /// Contacts, or their absence, claimed of a time before which the points as rounded are within the
    /// radius.
    pub late: usize,
    /// Answers that could neither be proved nor refuted.
    pub unproved: usize,
    /// Hits that say themselves that they may be too far away.
    pub undecided: usize,
    /// Most steps of any query.
    pub worst_steps: u32,
    /// Mean time that a query took, with nothing in the caches.
    pub ns_per_query: f64,
}

impl CcdReport {
    /// True if no answer is false.
    pub fn holds(&self) -> bool {
        self.false_negatives + self.false_positives + self.late + self.unproved == 0
    }

    /// As one JSON object.
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
            ("near misses hit", self.near_misses_hit),
            ("false negatives", self.false_negatives),
            ("false positives", self.false_positives),
            ("late", self.late),
            ("unproved", self.unproved),
            ("undecided", self.undecided),
            ("worst iterations", self.worst_steps as usize),
        ];
        for (name, count) in counts {
            writeln!(f, "  {name:<20}{count:>8}")?;
        }
        writeln!(f, "  {:<20}{:>8.0}", "ns per query", self.ns_per_query)
    }
}
