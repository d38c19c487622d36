//! Everything that can be reached from the entries.

use super::ClimbGraph;
use super::arms::EXACT;

/// How a climber is on a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Mode {
    /// It stands.
    Stand,
    /// It holds on.
    Hold,
}

/// What can be reached, by patch.
#[derive(Clone, Debug)]
pub(crate) struct Reachable {
    pub(crate) stands: Vec<bool>,
    pub(crate) holds: Vec<bool>,
}

/// Tells whether something is reached.
pub(crate) trait Reached {
    /// True if a patch is reached in any mode.
    fn has(&self, patch: usize) -> bool;
}

impl Reached for Reachable {
    fn has(&self, patch: usize) -> bool {
        self.stands[patch] || self.holds[patch]
    }
}

impl ClimbGraph {
    /// All that can be reached at rest from some patches, with arms of this reach. It walks where it can stand, climbs where
    /// it can hold on, and changes from one to the other wherever it can do both.
    pub(crate) fn flood(&self, from: impl IntoIterator<Item = usize>, reach: f64) -> Reachable {
        let none = vec![false; self.patches.len()];
        let mut reached = Reachable {
            stands: none.clone(),
            holds: none,
        };
        let mut open: Vec<(usize, Mode)> = Vec::new();
        let enter = |reached: &mut Reachable, open: &mut Vec<_>, patch: usize, mode: Mode| {
            let (can, is) = match mode {
                Mode::Stand => (self.can_stand(patch), &mut reached.stands[patch]),
                Mode::Hold => (self.can_hold(patch, reach), &mut reached.holds[patch]),
            };
            if can && !std::mem::replace(is, true) {
                open.push((patch, mode));
            }
        };
        for patch in from {
            enter(&mut reached, &mut open, patch, Mode::Stand);
            enter(&mut reached, &mut open, patch, Mode::Hold);
        }
        while let Some((patch, mode)) = open.pop() {
            enter(&mut reached, &mut open, patch, Mode::Stand);
            enter(&mut reached, &mut open, patch, Mode::Hold);
            for (beside, _) in self.links.of(patch) {
                let is_open = match mode {
                    Mode::Stand => !reached.stands[beside],
                    // Hands hold something all the way.
                    Mode::Hold => {
                        !reached.holds[beside]
                            && self.can_hold(beside, reach)
                            && self.arm_between([patch, beside], reach) <= reach + EXACT
                    }
                };
                if is_open {
                    enter(&mut reached, &mut open, beside, mode);
                }
            }
        }
        reached
    }
}
