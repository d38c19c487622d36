//! Everything that can be reached from the entries.

use std::collections::BinaryHeap;

use super::ClimbGraph;
use crate::Start;
use crate::plan::{node, of_node};

/// How a climber is on a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
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
    /// climbs where it can hold on, changes from one to the other wherever it can do both, and jumps.
    pub(crate) fn flood(&self, from: impl IntoIterator<Item = usize>) -> Reachable {
        self.reach(from, true)
    }

    /// [`ClimbGraph::flood`] without jumps: the way back is open, too.
    pub(crate) fn region(&self, from: impl IntoIterator<Item = usize>) -> Reachable {
        self.reach(from, false)
    }

    fn reach(&self, from: impl IntoIterator<Item = usize>, jumps: bool) -> Reachable {
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
            if jumps && reached.stands[patch] {
                for (_, leap) in self.leaps.of(patch) {
                    let footings = [Footing::Stands, Footing::Holds];
                    let lands = footings.map(|footing| footing == leap.lands);
                    enter(&mut reached, &mut open, leap.to as usize, lands);
                }
            }
        }
        reached
    }

    /// Of each node, the most stamina with which a climber comes there at rest from some starts if it rests wherever
    /// it can; negative if it does not come there.
    ///
    /// Dijkstra's search (1959) for the widest path. A place that a rest makes better is looked at again.
    pub(crate) fn strength(&self, starts: impl IntoIterator<Item = Start>) -> Vec<f64> {
        let costs = self.config.climber.stamina;
        let drain = costs.map_or(0.0, |costs| costs.hold_drain);
        let rests = costs.is_none_or(|costs| costs.refill > 0.0);
        let mut most = vec![-1.0; 2 * self.patches.len()];
        let mut open = BinaryHeap::new();
        let offer = |most: &mut [f64], open: &mut BinaryHeap<_>, patch, footing, stamina: f64| {
            let stamina: f64 = if rests && footing == Footing::Stands {
                1.0
            } else {
                stamina
            };
            let node = node(patch, footing);
            if stamina >= 0.0 && stamina > most[node] {
                most[node] = stamina;
                // Bits of numbers that are not negative have their order.
                open.push((stamina.to_bits(), node));
            }
        };
        for start in starts {
            if self
                .footings(start.patch)
                .any(|footing| footing == start.footing)
            {
                offer(
                    &mut most,
                    &mut open,
                    start.patch,
                    start.footing,
                    start.stamina.clamp(0.0, 1.0),
                );
            }
        }
        while let Some((bits, at)) = open.pop() {
            let stamina = f64::from_bits(bits);
            if stamina < most[at] {
                continue;
            }
            let (patch, footing) = of_node(at);
            for other in self.footings(patch) {
                offer(&mut most, &mut open, patch, other, stamina);
            }
            for (beside, way, length) in self.ways.of(patch) {
                let (leads, costs) = match footing {
                    Footing::Stands => (way.walks, 0.0),
                    Footing::Holds => (way.climbs, drain * length / self.speed(footing)),
                };
                if leads && !costs.is_nan() {
                    offer(&mut most, &mut open, beside, footing, stamina - costs);
                }
            }
            if footing == Footing::Stands {
                for (_, leap) in self.leaps.of(patch) {
                    let left = stamina - leap.costs();
                    offer(&mut most, &mut open, leap.to as usize, leap.lands, left);
                }
            }
        }
        most
    }
}
