//! Goals, with lower bounds of the time and stamina from every node to them.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use crate::{ClimbGraph, Footing};

/// A goal: a set of patches, any one of which is to be reached, and lower bounds of the time and stamina that it takes
/// to reach the nearest of them from each patch.
#[derive(Clone, Debug)]
pub struct Goal {
    patches: Vec<usize>,
    /// The lower bounds of each node.
    least: Vec<Least>,
    /// Factor on the stamina that holding on costs.
    pub(super) strain: f64,
    /// Stamina that holding on costs per second, with the strain.
    drain: f64,
    /// Stamina that standing refills per second.
    refill: f64,
}

/// Lower bounds of the cost from a node to the goal; infinite if no way leads there.
#[derive(Clone, Copy, Debug)]
struct Least {
    /// Seconds of the way.
    seconds: f64,
    /// Seconds for which the climber holds on.
    holds: f64,
    /// Stamina that is needed if the climber rests wherever it can; infinite if full stamina is not enough.
    stamina: f64,
}

impl Goal {
    /// The patches of the goal: indices into [`ClimbGraph::patches`], sorted from the smallest to the largest. A
    /// climber that reaches any one of them has reached the goal.
    pub fn patches(&self) -> &[usize] {
        &self.patches
    }

    /// The least time from a patch to the goal on a creature at rest, seconds, for a climber that does not tire.
    /// `patch` is an index into [`ClimbGraph::patches`], and `footing` tells whether the climber stands or holds on
    /// there at first. Infinite if no way leads to the goal, if that footing is not possible on the patch, or if the
    /// graph has no such patch.
    pub fn least_seconds(&self, patch: usize, footing: Footing) -> f64 {
        let least = self.of(patch, footing);
        least.map_or(f64::INFINITY, |least| least.seconds)
    }

    /// The smaller [`Goal::least_seconds`] of both footings on a patch.
    pub fn least_seconds_from(&self, patch: usize) -> f64 {
        let footings = [Footing::Stands, Footing::Holds];
        let [stands, holds] = footings.map(|footing| self.least_seconds(patch, footing));
        stands.min(holds)
    }

    /// The least stamina, 0 to 1, that a climber has to have on a patch to get from there to the goal, on a creature at
    /// rest; infinite if no stamina is enough. Wherever the climber can stand, it rests, if stamina refills at all.
    /// `patch` and `footing` are as for [`Goal::least_seconds`].
    pub fn least_stamina(&self, patch: usize, footing: Footing) -> f64 {
        let least = self.of(patch, footing);
        least.map_or(f64::INFINITY, |least| least.stamina)
    }

    /// The least time from a patch to the goal on a creature at rest for a climber with some stamina, 0 to 1, rests
    /// included, seconds; infinite if that stamina is not enough. No plan is faster. `patch` and `footing` are as for
    /// [`Goal::least_seconds`].
    ///
    /// Whichever way the climber takes, it has to hold on for at least some time. If this costs more stamina than the
    /// climber has, it has to stand until the difference is refilled. The bound is the sum of both times, and at least
    /// [`Goal::least_seconds`].
    pub fn least_seconds_with(&self, patch: usize, footing: Footing, stamina: f64) -> f64 {
        if self.of(patch, footing).is_some() {
            return self.at(node(patch, footing), stamina);
        }
        f64::INFINITY
    }

    fn of(&self, patch: usize, footing: Footing) -> Option<&Least> {
        let node = patch.checked_mul(2)? + usize::from(footing == Footing::Holds);
        self.least.get(node)
    }

    /// True if it is a goal of this graph, or of one with as many patches.
    pub(super) fn is_of(&self, graph: &ClimbGraph) -> bool {
        self.least.len() == 2 * graph.patches.len()
    }

    pub(super) fn at(&self, node: usize, stamina: f64) -> f64 {
        let least = &self.least[node];
        if stamina < least.stamina - ROUNDING {
            return f64::INFINITY;
        }
        let lacks = self.drain * least.holds - stamina;
        if lacks > 0.0 && self.refill > 0.0 {
            return least.seconds.max(least.holds + lacks / self.refill);
        }
        least.seconds
    }

    /// True if a node is at the goal.
    pub(super) fn has(&self, node: usize) -> bool {
        self.patches.binary_search(&(node / 2)).is_ok()
    }
}

/// Tolerance for sums of stamina, which differ by less than this in another order.
const ROUNDING: f64 = 1e-9;

/// The index of a patch and a footing.
pub(crate) fn node(patch: usize, footing: Footing) -> usize {
    2 * patch + usize::from(footing == Footing::Holds)
}

/// The inverse of [`node`].
pub(crate) fn of_node(node: usize) -> (usize, Footing) {
    let footing = if node % 2 == 1 {
        Footing::Holds
    } else {
        Footing::Stands
    };
    (node / 2, footing)
}

/// A step of a way, from one node to the next.
#[derive(Clone, Copy, Debug)]
struct Step {
    /// The footing with which it begins.
    footing: Footing,
    /// Seconds that it takes.
    passes: f64,
    /// Seconds of these for which the climber holds on.
    holds: f64,
    /// Stamina that it costs.
    costs: f64,
}

impl Step {
    /// A step with one footing all the way.
    fn on(footing: Footing, passes: f64, drain: f64) -> Self {
        let holds = match footing {
            Footing::Stands => 0.0,
            Footing::Holds => passes,
        };
        Self {
            footing,
            passes,
            holds,
            costs: drain * holds,
        }
    }
}

impl ClimbGraph {
    /// The patches whose middles are within `radius` metres of a place in the world, in ascending order. The creature
    /// is taken to be at rest where [`GraphConfig::world_from_model`](crate::GraphConfig::world_from_model) puts it,
    /// not where a living creature is now.
    pub fn patches_near(&self, place: DVec3, radius: f64) -> Vec<usize> {
        let near = |patch: &usize| self.patches[*patch].point.distance(place) <= radius;
        (0..self.patches.len()).filter(near).collect()
    }

    /// The goal to reach any one of these patches, given by their indices in [`ClimbGraph::patches`]. Indices beyond
    /// the list are left out, and repeated ones count once. If none is left, no plan reaches the goal.
    pub fn goal(&self, patches: &[usize]) -> Goal {
        self.goal_strained(patches, 1.0)
    }

    /// [`ClimbGraph::goal`] for a climber that spends `strain` times as much stamina on holding on.
    pub(crate) fn goal_strained(&self, patches: &[usize], strain: f64) -> Goal {
        let mut patches: Vec<usize> = patches
            .iter()
            .copied()
            .filter(|patch| *patch < self.patches.len())
            .collect();
        patches.sort_unstable();
        patches.dedup();
        let costs = self.config.climber.stamina;
        let drain = costs.map_or(0.0, |costs| strain * costs.hold_drain);
        let refill = costs.map_or(0.0, |costs| costs.refill);
        let needs = |beyond: f64, step: Step| {
            let need = beyond + strain * step.costs;
            match step.footing {
                _ if need > 1.0 + ROUNDING => f64::INFINITY,
                // The climber rests here until it has the stamina for the rest of the way.
                Footing::Stands if refill > 0.0 => 0.0,
                _ => need,
            }
        };
        let seconds = self.backwards(&patches, |beyond, step| beyond + step.passes);
        let holds = self.backwards(&patches, |beyond, step| beyond + step.holds);
        let stamina = self.backwards(&patches, needs);
        let least = seconds.into_iter().zip(holds).zip(stamina);
        let least = least.map(|((seconds, holds), stamina)| Least {
            seconds,
            holds,
            stamina,
        });
        Goal {
            least: least.collect(),
            patches,
            strain,
            drain,
            refill,
        }
    }

    /// For each node, the least cost of a way to one of some patches. `cost` maps a step and the cost beyond it to the
    /// cost from the step's beginning.
    ///
    /// Dijkstra's search (1959), backwards from the goal, because ways lead in both directions. A rest can lower a cost
    /// on the way. A node whose cost gets lower is visited again.
    fn backwards(&self, patches: &[usize], cost: impl Fn(f64, Step) -> f64) -> Vec<f64> {
        let mut least = vec![f64::INFINITY; 2 * self.patches.len()];
        let mut open = BinaryHeap::new();
        for patch in patches {
            for footing in self.footings(*patch) {
                let node = node(*patch, footing);
                least[node] = 0.0;
                open.push(Reverse((0u64, node)));
            }
        }
        let drain = self
            .config
            .climber
            .stamina
            .map_or(0.0, |costs| costs.hold_drain);
        // Costs are not negative, so their bits sort like the floats.
        while let Some(Reverse((bits, at))) = open.pop() {
            let beyond = f64::from_bits(bits);
            if beyond > least[at] {
                continue;
            }
            let (patch, footing) = of_node(at);
            let mut offer = |to: usize, cost: f64| {
                if cost < least[to] {
                    least[to] = cost;
                    open.push(Reverse((cost.to_bits(), to)));
                }
            };
            for other in self.footings(patch) {
                let changes = Step::on(other, 0.0, drain);
                offer(node(patch, other), cost(beyond, changes));
            }
            for (beside, way, length) in self.ways.of(patch) {
                let leads = match footing {
                    Footing::Stands => way.walks,
                    Footing::Holds => way.climbs,
                };
                let passes = length / self.speed(footing);
                if leads && passes.is_finite() {
                    let step = Step::on(footing, passes, drain);
                    offer(node(beside, footing), cost(beyond, step));
                }
            }
            for leap in self.leaps.to(patch).filter(|leap| leap.lands == footing) {
                let passes = leap.seconds();
                let step = Step {
                    footing: Footing::Stands,
                    passes,
                    // A jump counts as holding on for the time in which that costs as much stamina.
                    holds: if drain > 0.0 {
                        (leap.costs() / drain).min(passes)
                    } else {
                        0.0
                    },
                    costs: leap.costs(),
                };
                offer(
                    node(leap.from as usize, Footing::Stands),
                    cost(beyond, step),
                );
            }
        }
        least
    }

    /// The footings that are possible on a patch.
    pub(crate) fn footings(&self, patch: usize) -> impl Iterator<Item = Footing> + use<> {
        let patch = self.patches[patch];
        let stands = patch.can_stand.then_some(Footing::Stands);
        let holds = patch.can_hold.then_some(Footing::Holds);
        stands.into_iter().chain(holds)
    }

    /// The climber's speed with a footing, metres per second.
    pub(crate) fn speed(&self, footing: Footing) -> f64 {
        let climber = &self.config.climber;
        match footing {
            Footing::Stands => climber.ground.walk_speed,
            Footing::Holds => climber.grip.map_or(0.0, |grip| grip.climb_speed),
        }
    }
}
