//! A bot: drives a climber by plans.

mod climb;
mod config;
mod follow;
mod ground;
mod jumps;
mod limbs;
mod replan;
mod room;
mod view;

use clamber_climber::{ClimberInput, ClimberMode};
use glam::DVec3;
use std::sync::Arc;

pub use config::BotConfig;
pub use view::{Danger, View};

use crate::report::REST_SLOPE_SHARE;
use crate::{ClimbGraph, Footing, Goal, Plan};
use follow::Progress;
use ground::Approach;
use jumps::Jumps;
use limbs::Limbs;
use replan::Blocked;

/// Drives a climber to a goal on a creature, by its input alone.
///
/// On the ground the bot walks to an entry, keeps away while the creature attacks, and jumps. On the creature it
/// follows a plan: it walks and climbs from patch to patch, holds on while the skin shakes, and rests where the plan
/// says so. It plans anew when it has been carried off its way, makes no progress, or has fallen.
#[derive(Clone, Debug)]
pub struct Bot {
    graph: Arc<ClimbGraph>,
    config: BotConfig,
    plan: Option<Progress>,
    approach: Approach,
    /// Ways on which the bot was stuck.
    blocked: Vec<Blocked>,
    /// When the bot last planned, seconds.
    planned: f64,
    /// Since when the bot hangs in calm, seconds.
    hangs: Option<f64>,
    /// Number of plans so far.
    plans: u64,
    /// The goal to reach a level patch, where the bot can rest.
    level: Arc<Goal>,
    /// True if the bot has to rest before it goes on.
    rests: bool,
    /// Limbs that threw the bot off.
    limbs: Limbs,
    /// The first and the last time at which the bot found no way from where it is, seconds.
    lost: Option<[f64; 2]>,
    /// False if the bot found no place that stays calm while it rests.
    finds_calm: bool,
    /// The direction in which the bot goes along a ledge, and until when, seconds.
    shimmies: (DVec3, f64),
    jumps: Jumps,
    /// The time of the last look, and the time between it and the look before, seconds.
    looks: [f64; 2],
}

impl Bot {
    /// A bot that has not planned anything yet.
    pub fn new(graph: Arc<ClimbGraph>, config: BotConfig) -> Self {
        let level: Vec<usize> = (0..graph.patches.len())
            .filter(|patch| {
                let patch = &graph.patches[*patch];
                let cosine = patch.normal.dot(graph.config.climber.up());
                patch.can_stand
                    && cosine > libm::cos(REST_SLOPE_SHARE * graph.config.climber.ground.max_slope)
            })
            .collect();
        Self {
            level: Arc::new(graph.goal(&level)),
            rests: false,
            graph,
            config,
            plan: None,
            approach: Approach::default(),
            blocked: Vec::new(),
            planned: f64::NEG_INFINITY,
            hangs: None,
            plans: 0,
            limbs: Limbs::default(),
            lost: None,
            finds_calm: true,
            shimmies: (DVec3::ZERO, f64::NEG_INFINITY),
            jumps: Jumps::default(),
            looks: [f64::NAN; 2],
        }
    }

    /// The graph on which the bot plans.
    pub fn graph(&self) -> &Arc<ClimbGraph> {
        &self.graph
    }

    /// The bot's present plan; `None` on the ground, and when no way leads to the goal.
    pub fn plan(&self) -> Option<&Plan> {
        self.plan.as_ref().map(|progress| &progress.plan)
    }

    /// True if the bot has been on the creature for some seconds and finds no way from where it is, not even with full
    /// stamina, or has no patch of the graph near it. It then lets go and tries another entry.
    pub fn is_lost(&self, seconds: f64) -> bool {
        let lasts = self.lost.map_or(0.0, |[first, last]| last - first);
        lasts > LOST_TIME
            && self
                .lost
                .is_some_and(|[_, last]| seconds - last <= LOST_TIME)
    }

    /// Number of times that the bot has planned.
    pub fn plan_count(&self) -> u64 {
        self.plans
    }

    /// True if the climber has reached the bot's goal: it stands on the creature or holds on to it, and its patch, or
    /// the nearest one if it is on none, is a patch of the goal. Also true if the centre of its ball is within half its
    /// radius of the seat of such a patch, on the skin as it is now; the seat is where the ball's centre is on a patch
    /// ([`Patch::seat`](crate::Patch::seat)).
    pub fn is_there(&self, view: &View<'_>) -> bool {
        let Some(patch) = self.patch_below(view) else {
            return false;
        };
        let (here, radius) = (
            view.climber.state().position,
            view.climber.config().body.radius,
        );
        let is_near = |patch: &usize| {
            let patch = self.graph.patches.get(*patch);
            patch.is_some_and(|patch| {
                view.spot(patch).seat.distance(here) < ARRIVED_SEAT_DISTANCE * radius
            })
        };
        let goal = view.goal.patches();
        goal.binary_search(&patch).is_ok() || goal.iter().any(is_near)
    }

    /// Discards the bot's plans. Call it when its goal changes, or when the climber was put elsewhere. The bot still
    /// remembers for a minute which limbs threw it off.
    pub fn forget(&mut self) {
        self.plan = None;
        self.planned = f64::NEG_INFINITY;
        self.approach = Approach::default();
        self.blocked.clear();
        (self.hangs, self.lost) = (None, None);
        (self.rests, self.finds_calm) = (false, true);
        self.shimmies = (DVec3::ZERO, f64::NEG_INFINITY);
        self.jumps = Jumps::default();
    }

    /// True if the bot has to rest before it goes on or does anything that costs stamina.
    pub fn wants_rest(&mut self, view: &View<'_>) -> bool {
        if self.jumps.flies() {
            return self.rests;
        }
        let state = view.climber.state();
        let before = self.rests;
        let least = if before {
            self.config.rested.min(1.0)
        } else {
            self.config.tired
        };
        let costs = view
            .climber
            .config()
            .stamina
            .is_some_and(|stamina| stamina.refill > 0.0);
        // The bot goes on if its stamina is enough for its plan, or if the forecast is still and its stamina is enough
        // for the goal.
        let goes_on = || {
            if before {
                return false;
            }
            let as_planned = self.plan.as_ref();
            as_planned.is_some_and(|plan| plan.is_enough(state.stamina))
                || view.forecast.is_still()
                    && self.patch_below(view).is_some_and(|patch| {
                        let footings = [Footing::Stands, Footing::Holds];
                        let needs = footings.map(|footing| view.goal.least_stamina(patch, footing));
                        state.stamina >= needs[0].min(needs[1]) + SPARE_STAMINA
                    })
        };
        self.rests = costs && view.is_on_creature() && state.stamina < least && !goes_on();
        if self.rests != before {
            self.plan = None;
            self.planned = f64::NEG_INFINITY;
            self.finds_calm = true;
        }
        self.rests
    }

    /// The input for the next tick.
    pub fn input(&mut self, view: &View<'_>) -> ClimberInput {
        self.looks = [view.seconds, view.seconds - self.looks[0]];
        self.wants_rest(view);
        let state = view.climber.state();
        self.limbs.watch(&self.config, view);
        if !matches!(state.mode, ClimberMode::Hanging | ClimberMode::LedgeHanging) {
            self.hangs = None;
        }
        if matches!(state.mode, ClimberMode::Falling | ClimberMode::Sliding)
            && let Some(input) = self.jumps.input(view)
        {
            return input;
        }
        match state.mode {
            ClimberMode::Tumbling | ClimberMode::Custom(_) => ClimberInput::IDLE,
            ClimberMode::LedgeHanging => ClimberInput {
                climb: self.over_ledge(view),
                ..self.hang(view)
            },
            ClimberMode::Hanging => self.hang(view),
            _ => match self.patch_below(view) {
                Some(patch) => self.climb(view, patch),
                None if view.is_on_creature() => self.strays(view),
                None => self.come(view),
            },
        }
    }

    /// The patch that the climber is on.
    fn patch_below(&self, view: &View<'_>) -> Option<usize> {
        let (triangle, barycentric) = view.material()?;
        self.graph.patch_near(triangle, barycentric)
    }

    /// The climber is on the creature, but the graph has no patch near it. If this lasts, the bot is lost.
    fn strays(&mut self, view: &View<'_>) -> ClimberInput {
        self.lost = Some(self.lost_until(view.seconds));
        if self.is_lost(view.seconds) {
            self.approach.drops = true;
            return self.approach.leave(view);
        }
        ClimberInput {
            grip: true,
            ..ClimberInput::IDLE
        }
    }

    fn come(&mut self, view: &View<'_>) -> ClimberInput {
        if let Some(way) = self.jumps.ends(&self.graph, view) {
            self.block(way, view.seconds);
        }
        self.plan = None;
        self.lost = None;
        self.planned = f64::NEG_INFINITY;
        self.approach.input(&self.graph, &self.config, view)
    }
}

/// A place to rest has to stay calm for this time, seconds.
const CALM_REST_TIME: f64 = 8.0;

/// A bot within this share of its radius of a goal patch's seat has arrived.
const ARRIVED_SEAT_DISTANCE: f64 = 0.5;

/// A bot that finds no way for this time lets go, seconds.
const LOST_TIME: f64 = 3.0;

/// Stamina that the bot has to spare when it goes on without a rest.
const SPARE_STAMINA: f64 = 0.05;

/// The place to which the bot moves next.
#[derive(Clone, Copy, Debug)]
struct Target {
    place: DVec3,
    normal: DVec3,
    footing: Footing,
    /// True if the climber takes hold of another side there.
    in_corner: bool,
}
