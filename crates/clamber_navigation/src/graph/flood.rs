//! The patches that can be reached from the entries.

use std::collections::BinaryHeap;

use super::ClimbGraph;
use crate::Start;
use crate::plan::{node, of_node};

/// How a climber is supported on a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub enum Footing {
    /// The climber stands.
    Stands,
    /// The climber holds on.
    Holds,
}

/// The patches that are reached, by footing.
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
    /// All patches that a climber that does not tire reaches from some patches on the creature at rest. It walks where
    /// it can stand, climbs where it can hold on, changes between both wherever both are possible, and jumps.
    pub(crate) fn flood(&self, from: impl IntoIterator<Item = usize>) -> Reachable {
        self.reach(from, true)
    }

    /// [`ClimbGraph::flood`] without jumps: every patch of the result can also be left on the same way back.
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
            // A climber that can both stand and hold on here can change between the two.
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

    /// For each node, the most stamina with which a climber arrives there from some starts on the creature at rest, if
    /// it rests wherever it can; negative if it does not get there.
    ///
    /// Dijkstra's search (1959) for the widest path. A node whose stamina a rest improves is visited again.
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
                // The bits of floats that are not negative sort like the floats.
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
