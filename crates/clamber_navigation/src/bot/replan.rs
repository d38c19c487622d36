//! When a bot plans anew, from where, and around which ways.

use std::sync::Arc;

use super::follow::Progress;
use super::jumps::Jumps;
use super::room::Room;
use super::{Bot, CALM_REST_TIME, LOST_TIME, View};
use crate::plan::Around;
use crate::{Footing, Forecast, Start};

/// A way on which the bot was stuck.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blocked {
    way: [usize; 2],
    /// Until when the way is avoided, seconds.
    until: f64,
    /// For how long it is avoided, seconds.
    lasts: f64,
}

impl Blocked {
    /// True if the way has been open long enough to try it like a new one.
    fn is_forgotten(&self, seconds: f64) -> bool {
        seconds > self.until + FORGET_FACTOR * self.lasts
    }
}

/// A blocked way is forgotten after it was open for this many times as long as it was avoided.
const FORGET_FACTOR: f64 = 4.0;

impl Bot {
    /// Goes on with the present plan, or makes another one.
    pub(super) fn follow_or_plan(&mut self, view: &View<'_>, patch: usize) {
        let seconds = view.seconds;
        if let Some(progress) = &mut self.plan {
            let is_on_it = progress.find(&self.graph, view, patch, &self.config);
            // A new plan is kept for a while, because it may begin off the bot's place.
            let is_new = seconds - self.planned < self.config.plans_every;
            if is_new || is_on_it && !progress.is_stuck(seconds, 2.0 * self.config.patience) {
                return;
            }
            if is_on_it && let Some(way) = progress.next_way() {
                self.block(way, seconds);
            }
            self.plan = None;
            self.planned = f64::NEG_INFINITY;
        }
        if seconds - self.planned < self.config.plans_every {
            return;
        }
        self.planned = seconds;
        self.plans += 1;
        self.blocked
            .retain(|blocked| !blocked.is_forgotten(seconds));
        self.plan_anew(view, patch);
    }

    /// The patches where a plan can begin: the bot's own one, and those beside it that are open.
    fn starts(
        &self,
        patch: usize,
        stamina: f64,
        is_open: &dyn Fn(usize, usize) -> bool,
    ) -> Vec<Start> {
        let start = |patch: usize, footing, later: f64| Start {
            patch,
            footing,
            seconds: later,
            stamina,
        };
        let footings = [Footing::Stands, Footing::Holds];
        let mut starts = footings.map(|footing| start(patch, footing, 0.0)).to_vec();
        for (beside, way, length) in self.graph.ways.of(patch) {
            for (leads, footing) in [way.walks, way.climbs].into_iter().zip(footings) {
                if leads && is_open(patch, beside) {
                    let later = length / self.graph.speed(footing);
                    starts.push(start(beside, footing, later));
                }
            }
        }
        starts
    }

    /// Makes a plan, or records that the bot is lost.
    fn plan_anew(&mut self, view: &View<'_>, patch: usize) {
        let seconds = view.seconds;
        let state = view.climber.state();
        let level = Arc::clone(&self.level);
        let goal = if self.rests { &level } else { view.goal };
        let blocked = &self.blocked;
        let room = Room::new(view);
        let is_open = |from: usize, to: usize| {
            let is_it = |blocked: &Blocked| blocked.way == [from, to] && blocked.until > seconds;
            !blocked.iter().any(is_it)
                && self.graph.is_there(to, view.surface)
                && room.is_there(&self.graph.patches[to], to)
        };
        let limbs = &self.limbs;
        let may_land = Jumps::may_land(&self.graph, view, self.looks[1]);
        let lands = |jump: usize| may_land[jump];
        let is_safe = |from: usize, to: usize| {
            is_open(from, to) && !limbs.lead_onto(&self.graph, view, [from, to])
        };
        let rests = self.rests;
        let arrives =
            |patch: usize| !rests || view.forecast.is_calm_at(&self.graph, patch, CALM_REST_TIME);
        let stamina = (state.stamina - self.config.reserve).max(0.0);
        let safe_starts = self.starts(patch, stamina, &is_safe);
        let starts = self.starts(patch, stamina, &is_open);
        let with = |stamina: f64| -> Vec<Start> {
            let starts = starts.iter();
            starts.map(|start| Start { stamina, ..*start }).collect()
        };
        let (spent, tireless) = (with(state.stamina), with(1.0));
        let still = Forecast::still();
        let all = Around {
            is_open: &is_open,
            lands: &lands,
            ..Around::default()
        };
        let calm = Around {
            arrives: &arrives,
            ..all
        };
        let safe = Around {
            is_open: &is_safe,
            ..calm
        };
        let find = |starts: &[Start], goal, forecast, around| {
            self.graph.plan_around(starts, goal, forecast, around)
        };
        // Searches that cannot find anything take longest, so they are skipped.
        let finds_calm = !rests || goal.patches().iter().any(|patch| arrives(*patch));
        let is_free = |patch: &usize| !limbs.has(&self.graph, view, *patch);
        let goes_round = !limbs.is_empty() && finds_calm && goal.patches().iter().any(is_free);
        let safest = goes_round.then(|| find(&safe_starts, goal, view.forecast, &safe));
        let best = || find(&starts, goal, view.forecast, &calm);
        let lasting = safest.flatten().or_else(|| finds_calm.then(best).flatten());
        self.finds_calm = lasting.is_some();
        let (lasts, plan) = match lasting {
            Some(plan) => (true, Some(plan)),
            // No plan lasts, or none leads to a calm place. Plan with all stamina, without the reserve; else as if
            // stamina were full, and go as far as it lasts; at last the same straight to the goal.
            None => {
                let plan = find(&spent, goal, &still, &all)
                    .or_else(|| find(&tireless, goal, &still, &all))
                    .or_else(|| find(&tireless, view.goal, &still, &all));
                (false, plan)
            }
        };
        // A way that is blocked for now counts as a way. One over skin that is gone, or below a plate, does not.
        let is_there = |_: usize, to: usize| self.graph.is_there(to, view.surface);
        let is_lost = plan.is_none() && {
            let any = Around {
                is_open: &is_there,
                lands: &lands,
                ..Around::default()
            };
            find(&tireless, view.goal, &still, &any).is_none()
        };
        self.lost = is_lost.then(|| self.lost_until(seconds));
        self.plan = plan.map(|plan| Progress::new(plan, lasts, seconds));
    }

    /// Avoids a way on which the bot was stuck. Each further time doubles the time of avoidance.
    pub(super) fn block(&mut self, way: [usize; 2], seconds: f64) {
        let same = self.blocked.iter_mut().find(|blocked| blocked.way == way);
        let lasts = same
            .as_ref()
            .map_or(self.config.blocked_for, |before| 2.0 * before.lasts);
        let blocked = Blocked {
            way,
            until: seconds + lasts,
            lasts,
        };
        match same {
            Some(before) => *before = blocked,
            None => self.blocked.push(blocked),
        }
    }

    /// Since when the bot finds no way, and now. It begins anew if the last time was too long ago to count.
    pub(super) fn lost_until(&self, seconds: f64) -> [f64; 2] {
        let lately = self.lost.filter(|[_, last]| seconds - last <= LOST_TIME);
        [lately.map_or(seconds, |[first, _]| first), seconds]
    }
}
