//! Following a plan while the skin moves.

use super::{Target, View};
use crate::{ClimbGraph, Footing, Plan};

/// It looks for itself on so many steps of its plan, before and after the one that it was on.
const BACK: usize = 3;
const ON: usize = 8;

/// A plan, and how far it has been followed.
#[derive(Clone, Debug)]
pub(super) struct Progress {
    pub(super) plan: Plan,
    /// The step that it is on.
    at: usize,
    /// The farthest step that it has been on, and since when.
    farthest: usize,
    since: f64,
    /// The step up to which it has rested.
    rested: usize,
}

impl Progress {
    pub(super) fn new(plan: Plan, seconds: f64) -> Self {
        Self {
            plan,
            at: 0,
            farthest: 0,
            since: seconds,
            rested: 0,
        }
    }

    /// Finds the step that it is on. False if it is off its way.
    pub(super) fn find(
        &mut self,
        graph: &ClimbGraph,
        view: &View<'_>,
        patch: usize,
        off_its_way: f64,
    ) -> bool {
        let here = view.climber.state().position;
        let steps = &self.plan.steps;
        let from = self.at.saturating_sub(BACK);
        let to = (self.at + ON).min(steps.len() - 1);
        let apart = |index: &usize| {
            let step = &steps[*index];
            if step.patch == patch {
                return 0.0;
            }
            view.seat(&graph.patches()[step.patch]).distance(here)
        };
        let mut nearest = (f64::INFINITY, self.at);
        for index in from..=to {
            // It does not skip rests.
            if index > self.at && self.is_rest(index) && index > self.rested {
                break;
            }
            let apart = apart(&index);
            if apart <= nearest.0 {
                nearest = (apart, index);
            }
        }
        self.at = nearest.1;
        if self.at > self.farthest {
            (self.farthest, self.since) = (self.at, view.seconds);
        }
        nearest.0 <= off_its_way
    }

    /// True if a step is a rest.
    fn is_rest(&self, index: usize) -> bool {
        let steps = &self.plan.steps;
        index > 0
            && steps[index].footing == Footing::Stands
            && steps[index - 1].patch == steps[index].patch
            && steps[index - 1].footing == Footing::Stands
    }

    /// Stamina until which it rests here.
    pub(super) fn rests_until(&self) -> Option<f64> {
        let mut last = None;
        let mut index = self.at + 1;
        while index < self.plan.steps.len() && self.is_rest(index) {
            if index > self.rested {
                last = Some(self.plan.steps[index].stamina);
            }
            index += 1;
        }
        last
    }

    pub(super) fn has_rested(&mut self) {
        let mut index = self.at + 1;
        while index < self.plan.steps.len() && self.is_rest(index) {
            self.rested = index;
            index += 1;
        }
    }

    /// It waits, and is not stuck.
    pub(super) fn waits(&mut self, seconds: f64) {
        self.since = seconds;
    }

    pub(super) fn is_stuck(&self, seconds: f64, patience: f64) -> bool {
        seconds - self.since > patience
    }

    /// The way that it is on.
    pub(super) fn next_way(&self) -> Option<[usize; 2]> {
        let here = self.plan.steps.get(self.at)?.patch;
        let mut on = self.plan.steps[self.at..].iter().map(|step| step.patch);
        let next = on.find(|patch| *patch != here)?;
        Some([here, next])
    }

    /// Where it goes: some way ahead.
    pub(super) fn target(&self, graph: &ClimbGraph, view: &View<'_>) -> Option<Target> {
        let here = view.climber.state().position;
        let mut target = None;
        for (index, step) in self.plan.steps.iter().enumerate().skip(self.at) {
            if index > self.at && self.is_rest(index) && index > self.rested {
                break;
            }
            let place = view.seat(&graph.patches()[step.patch]);
            target = Some(Target {
                place,
                footing: step.footing,
            });
            if index > self.at && place.distance(here) > AHEAD {
                break;
            }
        }
        target
    }
}

/// It aims so far ahead, metres.
const AHEAD: f64 = 1.2;
