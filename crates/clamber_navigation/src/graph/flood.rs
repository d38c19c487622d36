//! Everything that can be reached from the entries.

use super::ClimbGraph;

/// How a climber is on a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Footing {
    /// It stands.
    Stands,
    /// It holds on.
    Holds,
}

/// What can be reached, by patch.
#[derive(Clone, Debug)]
pub(crate) struct Reachable {
    stands: Vec<bool>,
    holds: Vec<bool>,
}

impl Reachable {
    /// True if a patch is reached, standing or holding on.
    pub(crate) fn has(&self, patch: usize) -> bool {
        self.stands[patch] || self.holds[patch]
    }
}

impl ClimbGraph {
    /// All that can be reached at rest from some patches by a climber that does not tire. It walks where it can stand,
    /// climbs where it can hold on, and changes from one to the other wherever it can do both.
    pub(crate) fn flood(&self, from: impl IntoIterator<Item = usize>) -> Reachable {
        let none = vec![false; self.patches.len()];
        let mut reached = Reachable {
            stands: none.clone(),
            holds: none,
        };
        let mut open: Vec<usize> = Vec::new();
        let enter = |reached: &mut Reachable,
                     open: &mut Vec<usize>,
                     patch: usize,
                     [stands, holds]: [bool; 2]| {
            let here = &self.patches[patch];
            // Where it can do both it does both.
            let is_both = here.can_stand && here.can_hold && (stands || holds);
            let stands = here.can_stand && (stands || is_both);
            let holds = here.can_hold && (holds || is_both);
            let is_new = stands && !reached.stands[patch] || holds && !reached.holds[patch];
            if is_new {
                reached.stands[patch] |= stands;
                reached.holds[patch] |= holds;
                open.push(patch);
            }
        };
        for patch in from {
            enter(&mut reached, &mut open, patch, [true; 2]);
        }
        while let Some(patch) = open.pop() {
            for (beside, way, _) in self.ways.of(patch) {
                let walks = way.walks && reached.stands[patch];
                let climbs = way.climbs && reached.holds[patch];
                enter(&mut reached, &mut open, beside, [walks, climbs]);
            }
        }
        reached
    }
}
