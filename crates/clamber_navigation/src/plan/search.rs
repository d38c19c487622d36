//! The fastest way to a goal on which stamina lasts.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use clamber_climber::ClimberConfig;

use super::goal::{node, of_node};
use super::{Forecast, Goal};
use crate::clips::{Moment, SLICE};
use crate::{ClimbGraph, Footing};

/// Where a plan begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// The patch.
    pub patch: usize,
    /// How the climber is on it.
    pub footing: Footing,
    /// Seconds until it is there.
    pub seconds: f64,
    /// Stamina that it has there, 0 to 1.
    pub stamina: f64,
}

/// One step of a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PlanStep {
    /// The patch.
    pub patch: usize,
    /// How the climber is on it.
    pub footing: Footing,
    /// When it comes there or, if the step before is the same patch and footing, until when it rests there, seconds.
    pub seconds: f64,
    /// Stamina that it then has.
    pub stamina: f64,
}

/// A way to a goal.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Plan {
    /// The steps, from the start to the goal; never empty.
    pub steps: Vec<PlanStep>,
    /// How many ways to places the search looked at.
    pub looked_at: usize,
}

impl Plan {
    /// When it comes to the goal, seconds.
    pub fn seconds(&self) -> f64 {
        self.steps.last().map_or(0.0, |step| step.seconds)
    }

    /// Stamina left there.
    pub fn stamina(&self) -> f64 {
        self.steps.last().map_or(0.0, |step| step.stamina)
    }
}

/// Stamina is compared in so many steps: of two ways to a place that are as many steps high, the faster one is kept.
const LEVELS: usize = 16;

/// A search looks at no more ways than this.
const MOST: usize = 2_000_000;

/// A way to a place.
#[derive(Clone, Copy, Debug)]
struct Label {
    node: u32,
    before: u32,
    seconds: f64,
    stamina: f64,
}

const NOTHING: u32 = u32::MAX;

impl ClimbGraph {
    /// The fastest way from one of some starts to a goal on which stamina lasts, in the weather of a forecast; `None` if there
    /// is none.
    ///
    /// A label-setting search with a resource (Desrochers and Soumis 1988) in the order of A* (Hart, Nilsson and Raphael 1968):
    /// of two ways to a patch, one that is neither faster nor leaves more stamina is dropped. Stamina is compared in 16 steps,
    /// so that a way that would leave less than a sixteenth more may be missed. The least time to the goal at rest never
    /// exceeds the time that is needed, so what comes to the goal first is fastest.
    pub fn plan(&self, starts: &[Start], goal: &Goal, forecast: &Forecast) -> Option<Plan> {
        self.plan_around(starts, goal, forecast, &|_, _| true)
    }

    /// [`ClimbGraph::plan`] for a climber whom holding on costs `strain` times as much strength.
    pub(crate) fn plan_strained(
        &self,
        starts: &[Start],
        goal: &Goal,
        forecast: &Forecast,
        strain: f64,
    ) -> Option<Plan> {
        self.search(starts, goal, forecast, &|_, _| true, strain)
    }

    /// [`ClimbGraph::plan`] on those ways only that are open, from a patch to another.
    pub(crate) fn plan_around(
        &self,
        starts: &[Start],
        goal: &Goal,
        forecast: &Forecast,
        is_open: &dyn Fn(usize, usize) -> bool,
    ) -> Option<Plan> {
        self.search(starts, goal, forecast, is_open, 1.0)
    }

    fn search(
        &self,
        starts: &[Start],
        goal: &Goal,
        forecast: &Forecast,
        is_open: &dyn Fn(usize, usize) -> bool,
        strain: f64,
    ) -> Option<Plan> {
        let mut search = Search {
            graph: self,
            goal,
            forecast,
            is_open,
            strain,
            labels: Vec::new(),
            best: vec![[f64::INFINITY; LEVELS + 1]; 2 * self.patches.len()],
            open: BinaryHeap::new(),
        };
        for start in starts {
            let can = start.patch < self.patches.len()
                && self
                    .footings(start.patch)
                    .any(|footing| footing == start.footing);
            if can && start.seconds >= 0.0 {
                let node = node(start.patch, start.footing);
                search.offer(node, NOTHING, start.seconds, start.stamina.clamp(0.0, 1.0));
            }
        }
        search.run()
    }
}

struct Search<'a> {
    graph: &'a ClimbGraph,
    goal: &'a Goal,
    forecast: &'a Forecast,
    is_open: &'a dyn Fn(usize, usize) -> bool,
    /// Factor on what holding on costs.
    strain: f64,
    labels: Vec<Label>,
    /// Of each node and each level of stamina, when it is reached with that much.
    best: Vec<[f64; LEVELS + 1]>,
    /// Labels by when they come to the goal at the earliest.
    open: BinaryHeap<Reverse<(u64, u32)>>,
}

impl Search<'_> {
    fn offer(&mut self, node: usize, before: u32, seconds: f64, stamina: f64) {
        let left = self.goal.at(node);
        if !(left.is_finite() && seconds.is_finite()) || self.labels.len() >= MOST {
            return;
        }
        let best = &mut self.best[node];
        let level = level(stamina);
        if best[level..].iter().any(|known| *known <= seconds) {
            return;
        }
        best[level] = seconds;
        let label = self.labels.len() as u32;
        self.labels.push(Label {
            node: node as u32,
            before,
            seconds,
            stamina,
        });
        self.open.push(Reverse(((seconds + left).to_bits(), label)));
    }

    fn run(mut self) -> Option<Plan> {
        while let Some(Reverse((_, index))) = self.open.pop() {
            let label = self.labels[index as usize];
            let at = label.node as usize;
            let level = level(label.stamina);
            let better = self.best[at][level + 1..]
                .iter()
                .any(|known| *known <= label.seconds);
            if better || self.best[at][level] < label.seconds {
                continue;
            }
            let (patch, footing) = of_node(at);
            if self.goal.at(at) == 0.0 {
                return Some(self.plan(index));
            }
            let graph = self.graph;
            for other in graph.footings(patch).filter(|other| *other != footing) {
                self.offer(node(patch, other), index, label.seconds, label.stamina);
            }
            if footing == Footing::Stands && label.stamina < 1.0 {
                self.rest(index, patch);
            }
            for (beside, way, length) in graph.ways.of(patch) {
                let leads = match footing {
                    Footing::Stands => way.walks,
                    Footing::Holds => way.climbs,
                };
                if !leads || !(self.is_open)(patch, beside) {
                    continue;
                }
                let went = self.go(patch, footing, (label.seconds, label.stamina), length);
                if let Some((seconds, stamina)) = went {
                    self.offer(node(beside, footing), index, seconds, stamina);
                }
            }
        }
        None
    }

    /// Rests until stamina is a level higher.
    fn rest(&mut self, index: u32, patch: usize) {
        let label = self.labels[index as usize];
        let refill = self
            .graph
            .config
            .climber
            .stamina
            .map_or(0.0, |stamina| stamina.refill);
        let more = (level(label.stamina) + 1) as f64 / LEVELS as f64 - label.stamina;
        if refill <= 0.0 {
            return;
        }
        let mut time = (label.seconds, label.stamina);
        let wanted = (label.stamina + more).min(1.0);
        for _ in 0..MOST_SLICES {
            let rests = (wanted - time.1) / refill;
            if rests <= 1e-9 {
                self.offer(label.node as usize, index, time.0, wanted);
                return;
            }
            match self.pass(patch, Footing::Stands, time, rests) {
                Some((next, _)) => time = next,
                None => return,
            }
        }
    }

    /// Goes so many metres; gives when it is there, and its stamina. `None` if it falls on the way.
    fn go(
        &self,
        patch: usize,
        footing: Footing,
        mut time: (f64, f64),
        length: f64,
    ) -> Option<(f64, f64)> {
        let speed = self.graph.speed(footing);
        let mut left = length;
        for _ in 0..MOST_SLICES {
            let wanted = left / speed;
            if wanted <= 1e-9 {
                return Some(time);
            }
            let (next, moves) = self.pass(patch, footing, time, wanted)?;
            if moves {
                left -= speed * (next.0 - time.0);
            }
            time = next;
        }
        None
    }

    /// Lets time pass, at most to the end of the slice: gives the time and the stamina then, and whether it could move.
    fn pass(
        &self,
        patch: usize,
        footing: Footing,
        (seconds, stamina): (f64, f64),
        wanted: f64,
    ) -> Option<((f64, f64), bool)> {
        let climber = &self.graph.config.climber;
        let moment = self.forecast.at(self.graph, seconds, patch);
        let whole = SLICE - seconds.rem_euclid(SLICE);
        let whole = if whole < 1e-9 { SLICE } else { whole };
        let holds = match footing {
            Footing::Holds => true,
            Footing::Stands => {
                let falls = throws(climber, &moment) || slips(climber, &moment);
                if falls && !self.graph.patches[patch].can_hold {
                    return None;
                }
                falls
            }
        };
        let moves = if footing == Footing::Holds {
            let hangs = climber.grip.map_or(0.0, |grip| grip.hang_acceleration);
            moment.shake <= hangs
        } else {
            !holds
        };
        let passes = if moves { wanted.min(whole) } else { whole };
        let Some(costs) = climber.stamina else {
            return Some(((seconds + passes, 1.0), moves));
        };
        let after = if holds {
            stamina - passes * self.strain * (costs.hold_drain + costs.shake_drain * moment.excess)
        } else if moment.excess == 0.0 {
            (stamina + passes * costs.refill).min(1.0)
        } else {
            stamina
        };
        (after > 0.0).then_some(((seconds + passes, after), moves))
    }

    fn plan(&self, last: u32) -> Plan {
        let mut steps = Vec::new();
        let mut index = last;
        while index != NOTHING {
            let label = self.labels[index as usize];
            let (patch, footing) = of_node(label.node as usize);
            steps.push(PlanStep {
                patch,
                footing,
                seconds: label.seconds,
                stamina: label.stamina,
            });
            index = label.before;
        }
        steps.reverse();
        Plan {
            steps,
            looked_at: self.labels.len(),
        }
    }
}

/// A step takes at most so many slices.
const MOST_SLICES: usize = 256;

fn level(stamina: f64) -> usize {
    ((stamina * LEVELS as f64 + 1e-9) as usize).min(LEVELS)
}

/// True if whoever stands there without holding on is thrown or knocked down.
pub(crate) fn throws(climber: &ClimberConfig, moment: &Moment) -> bool {
    let knock = climber
        .tumble
        .map_or(f64::INFINITY, |tumble| tumble.knock_acceleration);
    moment.shake > climber.ground.throw_acceleration.min(knock)
}

/// True if it is too steep there to stand on.
pub(crate) fn slips(climber: &ClimberConfig, moment: &Moment) -> bool {
    libm::acos(moment.upright.clamp(-1.0, 1.0)) > climber.ground.max_slope
}
