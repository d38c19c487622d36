//! Searches the fastest way to a goal on which stamina lasts.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use clamber_climber::ClimberConfig;

use super::goal::{node, of_node};
use super::{Forecast, Goal};
use crate::clips::{COSINE_STEP, Moment, SLICE_SECONDS};
use crate::graph::Leap;
use crate::{ClimbGraph, Footing};

/// A place from which a plan may begin: a patch, and when, how and with how much stamina the climber is there. For a
/// climber on the creature it is where the climber is now; for one on the ground, a patch onto which it can get
/// ([`ClimbGraph::starts_on_ground`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// The patch on which the plan begins: an index into [`ClimbGraph::patches`].
    pub patch: usize,
    /// Whether the climber stands or holds on at `patch`, on which the plan begins.
    pub footing: Footing,
    /// Seconds from the beginning of the plan until the climber is on `patch`; 0 if it is there already.
    pub seconds: f64,
    /// Stamina that the climber has when it is on `patch`, 0 to 1. If it has yet to get there, the stamina that it will
    /// have left on arrival.
    pub stamina: f64,
}

/// One step of a plan: to reach a patch, or to rest on the patch of the step before.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PlanStep {
    /// The patch to which the step leads: an index into [`ClimbGraph::patches`].
    pub patch: usize,
    /// Whether the climber stands or holds on at `patch`, to which the step leads.
    pub footing: Footing,
    /// Time of arrival on `patch`, seconds after the beginning of the plan. If the step before has the same patch and
    /// footing, the time until which the climber rests there.
    pub seconds: f64,
    /// The climber's stamina at the time `seconds`, 0 to 1.
    pub stamina: f64,
    /// True if the climber comes from the step before by a jump.
    pub jumps: bool,
}

/// A way to a goal, step by step.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Plan {
    /// The steps, from the start to the goal; never empty.
    pub steps: Vec<PlanStep>,
    /// Number of partial ways that the search has stored, starts included, whether or not it went on from them: a
    /// measure of its work. At most two million.
    pub looked_at: usize,
}

impl Plan {
    /// Time of arrival at the goal, seconds after the beginning of the plan.
    pub fn seconds(&self) -> f64 {
        self.steps.last().map_or(0.0, |step| step.seconds)
    }

    /// Stamina that is left at the goal, 0 to 1.
    pub fn stamina(&self) -> f64 {
        self.steps.last().map_or(0.0, |step| step.stamina)
    }
}

/// Number of levels in which stamina is compared; the topmost one is full stamina. If two ways reach a place on the
/// same level, the faster one is kept. More levels miss fewer ways, and cost more.
const STAMINA_LEVELS: usize = 12;

/// Tolerance for sums of seconds or stamina, which differ by less than this in another order.
const ROUNDING: f64 = 1e-9;

/// The most partial ways of a search. It limits the time of a search that finds nothing.
const MOST_PARTIAL_WAYS: usize = 2_000_000;

/// The latest start that is used, seconds.
const LATEST_START: f64 = 1e6;

/// A partial way, to a node.
#[derive(Clone, Copy, Debug)]
struct Label {
    /// The node where the way ends.
    node: u32,
    /// The label before it; [`NO_LABEL`] for a start.
    before: u32,
    /// Time of arrival, seconds.
    seconds: f64,
    /// Stamina at that time.
    stamina: f64,
}

/// The label before a start. No label has this number.
const NO_LABEL: u32 = u32::MAX;

impl ClimbGraph {
    /// The fastest way from one of some starts to a goal on which stamina lasts, in the shakes of a forecast; `None` if
    /// the search finds no such way.
    ///
    /// A label-setting search with a resource (Desrochers and Soumis 1988) in the order of A* (Hart, Nilsson and
    /// Raphael 1968): of two ways to a patch, one that is neither faster nor leaves more stamina is dropped. Stamina is
    /// compared in 12 levels, so the search may miss a way that would leave less than an eleventh more. In a forecast
    /// with shakes it may also miss one that arrives later with more stamina. The heuristic is the least time to the
    /// goal at rest, rests included. It never exceeds the time that is needed, so the first way that reaches the goal
    /// is the fastest. Where stamina does not last at rest it never lasts, so such ways are not followed.
    ///
    /// Starts are left out if their numbers are not finite or they are later than a million seconds. A search gives up
    /// after two million partial ways. A goal of a graph with another number of patches is never reached.
    pub fn plan(&self, starts: &[Start], goal: &Goal, forecast: &Forecast) -> Option<Plan> {
        self.plan_around(starts, goal, forecast, &Around::default())
    }

    /// [`ClimbGraph::plan`] restricted to the ways, jumps and goal patches that `around` allows.
    pub(crate) fn plan_around(
        &self,
        starts: &[Start],
        goal: &Goal,
        forecast: &Forecast,
        around: &Around<'_>,
    ) -> Option<Plan> {
        if !goal.is_of(self) {
            return None;
        }
        let mut search = Search {
            graph: self,
            goal,
            forecast,
            around: *around,
            labels: Vec::new(),
            best: vec![[f32::INFINITY; STAMINA_LEVELS]; 2 * self.patches.len()],
            open: BinaryHeap::new(),
            course: Vec::new(),
        };
        for start in starts {
            let can = start.patch < self.patches.len()
                && self
                    .footings(start.patch)
                    .any(|footing| footing == start.footing);
            if can && (0.0..=LATEST_START).contains(&start.seconds) && start.stamina.is_finite() {
                let node = node(start.patch, start.footing);
                let tires = self.config.climber.stamina.is_some();
                let stamina = if tires {
                    start.stamina.clamp(0.0, 1.0)
                } else {
                    1.0
                };
                search.offer(node, NO_LABEL, start.seconds, stamina);
            }
        }
        search.run()
    }
}

/// Restrictions of a search.
#[derive(Clone, Copy)]
pub(crate) struct Around<'a> {
    /// True if the way from one patch to another is open.
    pub(crate) is_open: &'a dyn Fn(usize, usize) -> bool,
    /// True if a jump may be taken, by its index.
    pub(crate) lands: &'a dyn Fn(usize) -> bool,
    /// True if a patch of the goal counts.
    pub(crate) arrives: &'a dyn Fn(usize) -> bool,
}

impl Default for Around<'_> {
    fn default() -> Self {
        Self {
            is_open: &|_, _| true,
            lands: &|_| true,
            arrives: &|_| true,
        }
    }
}

struct Search<'a> {
    graph: &'a ClimbGraph,
    goal: &'a Goal,
    forecast: &'a Forecast,
    around: Around<'a>,
    labels: Vec<Label>,
    /// For each node and level of stamina, the earliest time at which it is reached with that level or a higher one.
    best: Vec<[f32; STAMINA_LEVELS]>,
    /// Labels by the earliest time at which they can reach the goal.
    open: BinaryHeap<Reverse<(u64, u32)>>,
    /// The stay at the label that is expanded, slice by slice, as far as it is known: the time and stamina at the
    /// slice's beginning, and the conditions in it.
    course: Vec<((f64, f64), Stay)>,
}

impl Search<'_> {
    fn offer(&mut self, node: usize, before: u32, seconds: f64, stamina: f64) {
        let (level, time) = (level(stamina), seconds as f32);
        let best = self.best.get(node).map_or(0.0, |best| best[level]);
        if best <= time || self.labels.len() >= MOST_PARTIAL_WAYS {
            return;
        }
        let left = self.goal.at(node, stamina);
        if !(left.is_finite() && seconds.is_finite()) {
            return;
        }
        for best in self.best[node][..=level].iter_mut().rev() {
            if *best <= time {
                break;
            }
            *best = time;
        }
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
            let time = label.seconds as f32;
            let best = &self.best[at];
            let more = best.get(level + 1).is_some_and(|more| *more <= time);
            if more || best[level] < time {
                continue;
            }
            let (patch, footing) = of_node(at);
            if self.goal.has(at) && (self.around.arrives)(patch) {
                return Some(self.plan(index));
            }
            let graph = self.graph;
            for other in graph.footings(patch).filter(|other| *other != footing) {
                self.offer(node(patch, other), index, label.seconds, label.stamina);
            }
            let Some(stay) = self.stay(patch, footing, label.seconds) else {
                continue;
            };
            let here = (label.seconds, label.stamina);
            if footing == Footing::Stands && label.stamina < 1.0 {
                self.rest(index, stay);
            }
            let Some((here, stay)) = self.until_it_moves(here, stay) else {
                continue;
            };
            self.course.clear();
            self.course.push((here, stay));
            for (beside, way, length) in graph.ways.of(patch) {
                let leads = match footing {
                    Footing::Stands => way.walks,
                    Footing::Holds => way.climbs,
                };
                if !leads || !(self.around.is_open)(patch, beside) {
                    continue;
                }
                let went = if footing == Footing::Stands && !graph.patches[beside].can_hold {
                    self.wait_and_go(beside, length)
                } else {
                    self.go(0, length)
                };
                if let Some((seconds, stamina)) = went {
                    self.offer(node(beside, footing), index, seconds, stamina);
                }
            }
            if footing == Footing::Stands {
                for (number, leap) in graph.leaps.of(patch) {
                    let to = leap.to as usize;
                    if !(self.around.is_open)(patch, to) || !(self.around.lands)(number) {
                        continue;
                    }
                    if let Some((seconds, stamina)) = self.jump(number, leap) {
                        self.offer(node(to, leap.lands), index, seconds, stamina);
                    }
                }
            }
        }
        None
    }

    /// Rests until stamina is a level higher.
    fn rest(&mut self, index: u32, first: Stay) {
        let label = self.labels[index as usize];
        let refill = self
            .graph
            .config
            .climber
            .stamina
            .map_or(0.0, |stamina| stamina.refill);
        if refill <= 0.0 {
            return;
        }
        let next_level = (level(label.stamina) + 1) as f64 / (STAMINA_LEVELS - 1) as f64;
        let wanted = next_level.min(1.0);
        let (mut time, mut known) = ((label.seconds, label.stamina), Some(first));
        for _ in 0..MOST_SLICES {
            let rests = (wanted - time.1) / refill;
            if rests <= ROUNDING {
                self.offer(label.node as usize, index, time.0, wanted);
                return;
            }
            let stay = known.take().or_else(|| self.stay_on(first, time.0));
            match stay.and_then(|stay| stay.pass(time, rests)) {
                Some(next) => time = next,
                None => return,
            }
        }
    }

    /// The conditions `index` slices after the present one. `None` if the climber falls before.
    #[inline]
    fn slice(&mut self, index: usize) -> Option<((f64, f64), Stay)> {
        while self.course.len() <= index {
            let (time, stay) = *self.course.last()?;
            let time = stay.pass(time, stay.lasts)?;
            self.course.push((time, self.stay_on(stay, time.0)?));
        }
        Some(self.course[index])
    }

    /// Moves by `length` metres, beginning in slice `from` of the course. Returns the time of arrival and the stamina
    /// then; `None` if the climber falls on the way.
    #[inline]
    fn go(&mut self, from: usize, length: f64) -> Option<(f64, f64)> {
        let (mut time, mut stay) = self.slice(from)?;
        let speed = self.graph.speed(stay.footing);
        let mut left = length;
        for index in from..from + MOST_SLICES {
            let wanted = left / speed;
            if stay.moves && wanted <= stay.lasts {
                return stay.pass(time, wanted);
            }
            let moved = stay.moves;
            let before = time.0;
            (time, stay) = self.slice(index + 1)?;
            if moved {
                left -= speed * (time.0 - before);
            }
        }
        None
    }

    /// Waits until the climber can move. Returns the time and the stamina then, and the conditions. `None` if it falls
    /// first, or can never move.
    #[inline]
    fn until_it_moves(&self, mut time: (f64, f64), mut stay: Stay) -> Option<((f64, f64), Stay)> {
        for _ in 0..=self.forecast.len() {
            if stay.moves {
                return Some((time, stay));
            }
            time = stay.pass(time, stay.lasts)?;
            stay = self.stay_on(stay, time.0)?;
        }
        None
    }

    /// [`Search::go`] to a patch where the climber can only stand. It starts in the first slice that lets it arrive
    /// without being thrown or slipping.
    fn wait_and_go(&mut self, to: usize, length: f64) -> Option<(f64, f64)> {
        for index in 0..=self.forecast.len() {
            let footing = self.slice(index)?.1.footing;
            let went = self.go(index, length)?;
            if self.stay(to, footing, went.0).is_some() {
                return Some(went);
            }
        }
        None
    }

    /// Jumps in the first slice at which the jump is sure: the slice's clip plays until the landing, and the jump lands
    /// in that clip whenever it begins.
    fn jump(&mut self, number: usize, leap: &Leap) -> Option<(f64, f64)> {
        let to = leap.to as usize;
        for index in 0..=self.forecast.len() {
            let (time, stay) = self.slice(index)?;
            let is_sure = stay.moves && self.forecast.lands(self.graph, number, time.0);
            let lands = time.0 + leap.seconds();
            if is_sure && self.stay(to, leap.lands, lands).is_some() {
                let left = time.1 - self.goal.strain * leap.costs();
                return (left >= 0.0).then_some((lands, left));
            }
        }
        None
    }

    /// The conditions of a stay at a later time.
    fn stay_on(&self, stay: Stay, seconds: f64) -> Option<Stay> {
        self.stay(stay.patch, stay.footing, seconds)
    }

    /// The conditions on a patch from a time to the end of its slice. `None` if the climber falls.
    fn stay(&self, patch: usize, footing: Footing, seconds: f64) -> Option<Stay> {
        let climber = &self.graph.config.climber;
        let slice = slice_of(seconds);
        let moment = self.forecast.at(self.graph, slice, patch);
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
        let hangs = climber.grip.map_or(0.0, |grip| grip.hang_acceleration);
        let costs = climber.stamina.map_or(0.0, |costs| {
            if holds {
                self.goal.strain * (costs.hold_drain + costs.shake_drain * moment.excess)
            } else if moment.excess == 0.0 {
                -costs.refill
            } else {
                0.0
            }
        });
        Some(Stay {
            patch,
            footing,
            lasts: if self.forecast.is_still() {
                f64::INFINITY
            } else {
                (slice as f64 + 1.0) * SLICE_SECONDS - seconds
            },
            moves: if footing == Footing::Holds {
                moment.shake <= hangs
            } else {
                !holds
            },
            costs,
        })
    }

    fn plan(&self, last: u32) -> Plan {
        let mut steps: Vec<PlanStep> = Vec::new();
        let mut index = last;
        while index != NO_LABEL {
            let label = self.labels[index as usize];
            let (patch, footing) = of_node(label.node as usize);
            if let Some(after) = steps.last_mut() {
                let leap = self.graph.leaps.between(patch, after.patch);
                after.jumps = footing == Footing::Stands && leap.is_some();
            }
            steps.push(PlanStep {
                patch,
                footing,
                seconds: label.seconds,
                stamina: label.stamina,
                jumps: false,
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

/// The conditions on a patch for a while.
#[derive(Clone, Copy, Debug)]
struct Stay {
    patch: usize,
    footing: Footing,
    /// Length of this while, seconds.
    lasts: f64,
    /// True if the climber can move.
    moves: bool,
    /// Stamina that the stay costs per second; negative if it refills.
    costs: f64,
}

impl Stay {
    /// Lets `wanted` seconds pass, but not more than the stay lasts; the whole stay if the climber cannot move. Returns
    /// the time and the stamina then. `None` if the stamina does not suffice.
    #[inline]
    fn pass(&self, (seconds, stamina): (f64, f64), wanted: f64) -> Option<(f64, f64)> {
        let passes = if self.moves {
            wanted.min(self.lasts)
        } else {
            self.lasts
        };
        let after = (stamina - passes * self.costs).min(1.0);
        (self.costs <= 0.0 || after > 0.0).then_some((seconds + passes, after))
    }
}

/// The most slices that one step takes. Longer steps are given up.
const MOST_SLICES: usize = 256;

/// The slice of a forecast that contains a time.
pub(super) fn slice_of(seconds: f64) -> usize {
    (seconds / SLICE_SECONDS + ROUNDING) as usize
}

fn level(stamina: f64) -> usize {
    ((stamina * (STAMINA_LEVELS - 1) as f64 + ROUNDING) as usize).min(STAMINA_LEVELS - 1)
}

/// True if a climber that stands there without holding on is thrown or knocked down. Assumes that the patch shakes
/// straight up and down.
pub(crate) fn throws(climber: &ClimberConfig, moment: &Moment) -> bool {
    let knock = climber
        .tumble
        .map_or(f64::INFINITY, |tumble| tumble.knock_acceleration);
    let weight = climber.gravity.length() * moment.upright;
    moment.shake > (climber.ground.throw_acceleration + weight).min(knock)
}

/// True if the patch is too steep to stand on, beyond the step size in which slopes are stored.
pub(crate) fn slips(climber: &ClimberConfig, moment: &Moment) -> bool {
    moment.upright + COSINE_STEP < libm::cos(climber.ground.release_slope())
}
