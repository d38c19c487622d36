//! Follows a plan while the skin moves.

use glam::DVec3;

use super::{BotConfig, Target, View};
use crate::graph::Spot;
use crate::{ClimbGraph, Footing, Plan};

/// Number of steps before the last known one among which the bot searches its present step.
const STEPS_BACK: usize = 3;
/// Number of steps after the last known one among which the bot searches its present step.
const STEPS_AHEAD: usize = 8;

/// A plan, and how far it has been followed.
#[derive(Clone, Debug)]
pub(super) struct Progress {
    pub(super) plan: Plan,
    /// The step at which the bot is.
    at: usize,
    /// The farthest step at which the bot has been.
    farthest: usize,
    /// When the bot reached that step or last waited, seconds.
    since: f64,
    /// The step up to which the bot has rested.
    rested: usize,
    /// When the bot last moved, seconds.
    moved: f64,
    /// Until when the bot tries another direction, seconds.
    tries_until: f64,
    /// Time and position at the last call of [`Progress::tries_else`].
    seen: (f64, DVec3),
    /// The places that the bot passes on its way to its target: memory that is reused.
    passed: Vec<DVec3>,
    /// True if the plan was found for the bot's stamina and in its forecast.
    lasts: bool,
}

impl Progress {
    pub(super) fn new(plan: Plan, lasts: bool, seconds: f64) -> Self {
        Self {
            plan,
            at: 0,
            farthest: 0,
            since: seconds,
            rested: 0,
            moved: seconds,
            tries_until: f64::NEG_INFINITY,
            seen: (seconds, DVec3::ZERO),
            passed: Vec::new(),
            lasts,
        }
    }

    /// True if the plan walks at the present step.
    pub(super) fn walks(&self) -> bool {
        let step = self.plan.steps.get(self.at);
        step.is_some_and(|step| step.footing == Footing::Stands)
    }

    /// True if this much stamina is enough to go on as planned.
    pub(super) fn is_enough(&self, stamina: f64) -> bool {
        let planned = self.plan.steps.get(self.at).map(|step| step.stamina);
        self.lasts && planned.is_some_and(|planned| stamina >= planned)
    }

    /// Finds the bot's present step. False if the bot is off its way.
    pub(super) fn find(
        &mut self,
        graph: &ClimbGraph,
        view: &View<'_>,
        patch: usize,
        config: &BotConfig,
    ) -> bool {
        let here = view.climber.state().position;
        let radius = view.climber.config().body.radius;
        let steps = &self.plan.steps;
        let from = self.at.saturating_sub(STEPS_BACK);
        let to = (self.at + STEPS_AHEAD).min(steps.len() - 1);
        let apart = |index: &usize| {
            let step = &steps[*index];
            let apart = view.spot(&graph.patches()[step.patch]).seat.distance(here);
            if step.patch == patch {
                apart.min(ON_IT * radius)
            } else {
                apart
            }
        };
        let mut nearest = (f64::INFINITY, self.at);
        for index in from..=to {
            // Steps beyond a rest that is still to come are not searched.
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
        nearest.0 <= config.off_its_way * radius
    }

    /// True if a step is a rest.
    fn is_rest(&self, index: usize) -> bool {
        let steps = &self.plan.steps;
        index > 0
            && steps[index].footing == Footing::Stands
            && steps[index - 1].patch == steps[index].patch
            && steps[index - 1].footing == Footing::Stands
    }

    /// The stamina until which the bot rests at its present step; `None` if no rest comes next.
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

    /// Notes that the bot waits on purpose, so that it does not count as stuck.
    pub(super) fn waits(&mut self, seconds: f64) {
        self.since = seconds;
    }

    pub(super) fn is_stuck(&self, seconds: f64, patience: f64) -> bool {
        seconds - self.since > patience
    }

    /// True if the bot should try another direction: for a while after it came to rest on its way.
    pub(super) fn tries_else(&mut self, view: &View<'_>) -> bool {
        let (state, seconds) = (view.climber.state(), view.seconds);
        let climbs = view
            .climber
            .config()
            .grip
            .map_or(0.0, |grip| grip.climb_speed);
        // The way that it has moved. Where an obstacle blocks it, this is less than its velocity says.
        let passed = seconds - self.seen.0;
        let made = state.position - self.seen.1 - state.base_velocity * passed;
        if passed > 0.0 && made.length() > RESTING_SPEED_SHARE * climbs * passed {
            self.moved = seconds;
        }
        self.seen = (seconds, state.position);
        let is_at_rest = seconds - self.moved.max(self.since) > REST_BEFORE_TRY;
        if is_at_rest && seconds > self.tries_until {
            (self.tries_until, self.moved) = (seconds + TRY_TIME, seconds + TRY_TIME);
        }
        seconds < self.tries_until
    }

    /// The patches of the jump that comes next, if the bot is at the step where it begins.
    pub(super) fn next_jump(&self) -> Option<[usize; 2]> {
        let [here, next] = [self.at, self.at + 1].map(|at| self.plan.steps.get(at));
        Some([here?.patch, next.filter(|next| next.jumps)?.patch])
    }

    /// The patches of the way that the bot is on.
    pub(super) fn next_way(&self) -> Option<[usize; 2]> {
        let here = self.plan.steps.get(self.at)?.patch;
        let mut on = self.plan.steps[self.at..].iter().map(|step| step.patch);
        let next = on.find(|patch| *patch != here)?;
        Some([here, next])
    }

    /// The bot's target: a place some way ahead on its plan.
    pub(super) fn target(
        &mut self,
        graph: &ClimbGraph,
        view: &View<'_>,
        config: &BotConfig,
    ) -> Option<Target> {
        let state = view.climber.state();
        let (here, radius) = (state.position, view.climber.config().body.radius);
        let held = state
            .support
            .map_or(DVec3::ZERO, |support| support.normal_in_world());
        self.passed.clear();
        let mut target = None;
        for (index, step) in self.plan.steps.iter().enumerate().skip(self.at) {
            let is_own =
                index > self.at && (step.jumps || self.is_rest(index) && index > self.rested);
            if is_own {
                break;
            }
            let patch = &graph.patches()[step.patch];
            let Spot {
                seat: place,
                normal,
                ..
            } = view.spot(patch);
            let before = self.plan.steps[index.saturating_sub(1)].patch;
            let corner = graph
                .ways
                .corner(before, step.patch)
                .filter(|_| index > self.at);
            if let Some(corner) = corner
                && step.footing == Footing::Holds
                && normal.dot(held) < CORNER_COSINE
                && (place - here).dot(held) > CORNER_RISE * radius
            {
                let place = view.corner(corner).unwrap_or(place);
                if target.is_none()
                    || is_straight(here, place, &self.passed, MOST_CORNER_CUT * radius)
                {
                    return Some(Target {
                        place,
                        normal,
                        footing: Footing::Holds,
                        in_corner: true,
                    });
                }
                break;
            }
            if target.is_some() && !is_straight(here, place, &self.passed, MOST_CORNER_CUT * radius)
            {
                break;
            }
            // The bot's present place is no target if a later step gives one.
            if index > self.at || target.is_none() {
                target = Some(Target {
                    place,
                    normal,
                    footing: step.footing,
                    in_corner: false,
                });
                // If the patch is on another side, the target stays here: the bot takes hold of that side first.
                let turns = normal.dot(held) < CORNER_COSINE;
                if turns && index > self.at {
                    break;
                }
            }
            if index > self.at {
                self.passed.push(place);
                if place.distance(here) > config.ahead * radius {
                    break;
                }
            }
        }
        target
    }
}

/// True if the straight way passes all places in between within `aside` metres.
fn is_straight(from: DVec3, to: DVec3, between: &[DVec3], aside: f64) -> bool {
    let way = to - from;
    let squared = way.length_squared();
    between.iter().all(|place| {
        let share = if squared > 0.0 {
            ((*place - from).dot(way) / squared).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (from + way * share).distance(*place) <= aside
    })
}

/// If the way rises off the skin that the bot holds by more than this share of its radius, the bot goes by the corner.
const CORNER_RISE: f64 = 0.5;

/// A bot on a patch counts as no farther from its middle than this many radii.
const ON_IT: f64 = 0.5;

/// The bot counts as at rest below this share of its climbing speed.
const RESTING_SPEED_SHARE: f64 = 0.2;
/// The bot has to be at rest for this time before it tries another direction, seconds.
const REST_BEFORE_TRY: f64 = 0.3;
/// The bot tries another direction for this time, seconds.
const TRY_TIME: f64 = 0.5;

/// Two sides whose normals have a lower cosine than this meet in a corner.
const CORNER_COSINE: f64 = 0.7;

/// The bot cuts corners by at most this many radii.
const MOST_CORNER_CUT: f64 = 0.5;
