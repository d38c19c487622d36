//! Where to go, and how long it takes at least from everywhere.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use crate::{ClimbGraph, Footing};

/// A goal: some patches, and for each place the least time to the nearest of them.
#[derive(Clone, Debug)]
pub struct Goal {
    patches: Vec<usize>,
    /// Of each node, seconds; infinite where no way leads to the goal.
    seconds: Vec<f64>,
}

impl Goal {
    /// Its patches, in ascending order.
    pub fn patches(&self) -> &[usize] {
        &self.patches
    }

    /// The least time from a patch to the goal on a creature at rest, seconds, for a climber that does not tire; infinite if
    /// no way leads there.
    pub fn least_seconds(&self, patch: usize, footing: Footing) -> f64 {
        let seconds = self.seconds.get(node(patch, footing));
        seconds.copied().unwrap_or(f64::INFINITY)
    }

    pub(super) fn at(&self, node: usize) -> f64 {
        self.seconds[node]
    }
}

/// A patch and a footing, as a number.
pub(super) fn node(patch: usize, footing: Footing) -> usize {
    2 * patch + usize::from(footing == Footing::Holds)
}

/// The inverse of [`node`].
pub(super) fn of_node(node: usize) -> (usize, Footing) {
    let footing = if node % 2 == 1 {
        Footing::Holds
    } else {
        Footing::Stands
    };
    (node / 2, footing)
}

impl ClimbGraph {
    /// The patches whose middles are within `radius` metres of a place, all at rest.
    pub fn patches_near(&self, place: DVec3, radius: f64) -> Vec<usize> {
        let near = |patch: &usize| self.patches[*patch].point.distance(place) <= radius;
        (0..self.patches.len()).filter(near).collect()
    }

    /// The goal to come to one of some patches. Numbers that are none of a patch are left out.
    pub fn goal(&self, patches: &[usize]) -> Goal {
        let mut patches: Vec<usize> = patches
            .iter()
            .copied()
            .filter(|patch| *patch < self.patches.len())
            .collect();
        patches.sort_unstable();
        patches.dedup();
        let mut seconds = vec![f64::INFINITY; 2 * self.patches.len()];
        let mut open = BinaryHeap::new();
        for patch in &patches {
            for footing in self.footings(*patch) {
                let node = node(*patch, footing);
                seconds[node] = 0.0;
                open.push(Reverse((0u64, node)));
            }
        }
        // Dijkstra 1959, from the goal backwards: ways lead back as well as there. Times are not negative, so that their bits
        // have their order.
        while let Some(Reverse((bits, at))) = open.pop() {
            let so_far = f64::from_bits(bits);
            if so_far > seconds[at] {
                continue;
            }
            let (patch, footing) = of_node(at);
            let mut offer = |to: usize, time: f64| {
                if time < seconds[to] {
                    seconds[to] = time;
                    open.push(Reverse((time.to_bits(), to)));
                }
            };
            for other in self.footings(patch) {
                offer(node(patch, other), so_far);
            }
            for (beside, way, length) in self.ways.of(patch) {
                let leads = match footing {
                    Footing::Stands => way.walks,
                    Footing::Holds => way.climbs,
                };
                if leads {
                    offer(node(beside, footing), so_far + length / self.speed(footing));
                }
            }
        }
        Goal { patches, seconds }
    }

    /// How a climber can be on a patch.
    pub(super) fn footings(&self, patch: usize) -> impl Iterator<Item = Footing> + use<> {
        let patch = self.patches[patch];
        let stands = patch.can_stand.then_some(Footing::Stands);
        let holds = patch.can_hold.then_some(Footing::Holds);
        stands.into_iter().chain(holds)
    }

    /// How fast it gets on, metres a second.
    pub(super) fn speed(&self, footing: Footing) -> f64 {
        let climber = &self.config.climber;
        match footing {
            Footing::Stands => climber.ground.walk_speed,
            Footing::Holds => climber.grip.map_or(0.0, |grip| grip.climb_speed),
        }
    }
}
