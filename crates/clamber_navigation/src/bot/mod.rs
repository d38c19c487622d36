//! A bot: drives a climber by plans.

mod config;
mod follow;
mod ground;
mod jumps;
mod limbs;
mod room;
mod view;

use clamber_climber::{ClimberInput, ClimberMode};
use glam::DVec3;
use std::sync::Arc;

pub use config::BotConfig;
pub use view::{Danger, View};

use crate::plan::Around;
use crate::report::LEVEL;
use crate::{ClimbGraph, Footing, Forecast, Goal, Plan, Start};
use follow::Progress;
use ground::Approach;
use jumps::{Jumps, TakeOff};
use limbs::Limbs;
use room::Room;

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
                patch.can_stand && cosine > libm::cos(LEVEL * graph.config.climber.ground.max_slope)
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
        lasts > LOST && self.lost.is_some_and(|[_, last]| seconds - last <= LOST)
    }

    /// Number of times that the bot has planned.
    pub fn plans(&self) -> u64 {
        self.plans
    }

    /// True if the bot is on a patch of the goal, or near the seat of one.
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
            patch.is_some_and(|patch| view.spot(patch).seat.distance(here) < THERE * radius)
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
                        state.stamina >= needs[0].min(needs[1]) + SPARE
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

    /// Waits until the skin is calm. Lets go if the climber cannot pull itself in.
    fn hang(&mut self, view: &View<'_>) -> ClimberInput {
        let seconds = view.seconds;
        let state = view.climber.state();
        let grip = view.climber.config().grip;
        let still = grip.map_or(f64::INFINITY, |grip| STILL * grip.hang_acceleration);
        if state.shake.length() > still {
            self.hangs = None;
        }
        let since = *self.hangs.get_or_insert(seconds);
        let is_on_ledge = state.mode == ClimberMode::LedgeHanging;
        let most = if is_on_ledge { LEDGES } else { 1.0 } * self.config.hangs_for;
        // A climber that pulls itself up may find room above.
        let pulls_up = is_on_ledge && state.ledge_hanging.pull_up > 0.0;
        let holds = pulls_up || seconds - since <= most;
        if !holds && is_on_ledge {
            // The ledge has no room above it or beside it.
            let way = self.plan.as_ref().and_then(Progress::next_way);
            if let Some(way) = way {
                self.block(way, seconds);
            }
            self.approach.gives_up(seconds);
        }
        ClimberInput {
            grip: holds,
            ..ClimberInput::IDLE
        }
    }

    /// The climb direction at a ledge: up. If there is no room above, along the ledge for a while, to the side where
    /// the way goes on.
    fn over_ledge(&mut self, view: &View<'_>) -> DVec3 {
        let (seconds, state) = (view.seconds, view.climber.state());
        let up = view.climber.config().up();
        let aside = state.heading.cross(up);
        if state.ledge_hanging.gave_up {
            let ahead = self.plan.as_mut();
            let ahead = ahead.and_then(|plan| plan.target(&self.graph, view, &self.config));
            let ahead = self
                .jumps
                .goes_to(&self.graph, view)
                .or(ahead.map(|target| target.place));
            // Without a way, the bot goes to each side in turn.
            let back = -self.shimmies.0.dot(aside);
            let toward = ahead.map_or(back, |place| (place - state.position).dot(aside));
            let (ledge, radius) = (
                view.climber.config().ledge,
                view.climber.config().body.radius,
            );
            let lasts = ledge.map_or(0.0, |ledge| {
                SHIMMIES * radius / ledge.shimmy_speed.max(1e-3)
            });
            self.shimmies = (aside * 1f64.copysign(toward), seconds + lasts);
        }
        let (way, until) = self.shimmies;
        if seconds < until { way } else { up }
    }

    fn climb(&mut self, view: &View<'_>, patch: usize) -> ClimberInput {
        self.approach.got_on(view.seconds);
        if let Some(way) = self.jumps.ends(&self.graph, view) {
            self.block(way, view.seconds);
        }
        let state = view.climber.state();
        let stands = state.mode == ClimberMode::Standing;
        let hold = ClimberInput {
            grip: true,
            ..ClimberInput::IDLE
        };
        let rest = ClimberInput::IDLE;
        let hangs = view
            .climber
            .config()
            .grip
            .map_or(0.0, |grip| grip.hang_acceleration);
        let throws = view.climber.config().ground.throw_acceleration;
        // If no place stays calm, the bot rests wherever it can, between shakes.
        let is_calm = || !self.finds_calm || view.forecast.is_calm_at(&self.graph, patch, RESTS);
        let rests_here = self.rests && (stands || view.is_level(LETS_GO)) && is_calm();
        // The shake ahead counts as well, because hands need time to take hold.
        let can_stand =
            state.shake.length().max(view.shake_ahead) <= self.config.stands_in * throws;
        let is_shaken = if stands || rests_here {
            !can_stand
        } else {
            state.shake.length() > self.config.climbs_in * hangs
        };
        if is_shaken {
            if let Some(plan) = &mut self.plan {
                plan.waits(view.seconds);
            }
            return hold;
        }
        if rests_here {
            return rest;
        }
        self.follow_or_plan(view, patch);
        if self.plan.is_none() {
            if self.is_lost(view.seconds) && !self.approach.drops {
                self.approach.gives_up_limb(&self.graph, view, patch);
            }
            if self.approach.drops {
                return self.approach.leave(view);
            }
            // The bot has no way for now, and rests if it can.
            let is_level = self.graph.patches[patch].can_stand || stands;
            return if is_level { rest } else { hold };
        }
        let Some(progress) = &mut self.plan else {
            return hold;
        };
        self.approach.drops = false;
        self.lost = None;
        if let Some(wanted) = progress.rests_until() {
            let is_level = stands || view.is_level(AS_PLANNED);
            let needs = state.stamina < 1.0 && state.stamina < wanted + self.config.reserve;
            if needs && is_level {
                progress.waits(view.seconds);
                return if can_stand { rest } else { hold };
            }
            // The climber may still hold on to the slope beside the place of its rest.
            let comes = needs && !progress.is_stuck(view.seconds, self.config.patience);
            if !comes {
                progress.has_rested();
            }
        }
        if stands && let Some(ends) = progress.next_jump() {
            match self.jumps.take_off(&self.graph, view, ends) {
                None => {}
                Some(TakeOff::Now(aim)) if can_stand => {
                    if self.approach.jumps(view.seconds) {
                        return self.jumps.begin(&self.graph, view, ends, aim);
                    }
                    return rest;
                }
                Some(TakeOff::Later | TakeOff::Tired) => {
                    progress.waits(view.seconds);
                    return if can_stand { rest } else { hold };
                }
                Some(TakeOff::Unsure | TakeOff::Now(_)) => {
                    return if can_stand { rest } else { hold };
                }
            }
        }
        let Some(target) = progress.target(&self.graph, view, &self.config) else {
            return hold;
        };
        let toward = target.place - state.position;
        let up = view.climber.config().up();
        let level = toward - up * toward.dot(up);
        // If the way can be walked, the climber lets go, so that its stamina refills.
        let walks = stands || can_stand && progress.walks() && view.is_level(AS_PLANNED);
        let tries_else = progress.tries_else(view);
        let jumps = stands && progress.is_stuck(view.seconds, self.config.patience);
        ClimberInput {
            climb: if tries_else {
                // If the way ahead leads straight off the climber's hold, the bot climbs against the target's normal
                // instead, until the climber touches the next skin.
                -target.normal
            } else {
                view.against(&target)
                    .normalize_or(view.climber.config().up())
            },
            walk: (level / view.climber.config().body.radius).clamp_length_max(1.0),
            grip: target.footing == Footing::Holds || !walks || tries_else,
            jump: jumps && self.approach.jumps(view.seconds),
            ..ClimberInput::IDLE
        }
    }

    /// Goes on with the present plan, or makes another one.
    fn follow_or_plan(&mut self, view: &View<'_>, patch: usize) {
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
        let arrives = |patch: usize| !rests || view.forecast.is_calm_at(&self.graph, patch, RESTS);
        let start = |patch: usize, footing, later: f64| Start {
            patch,
            footing,
            seconds: later,
            stamina: (state.stamina - self.config.reserve).max(0.0),
        };
        let footings = [Footing::Stands, Footing::Holds];
        let starts = |is_open: &dyn Fn(usize, usize) -> bool| -> Vec<Start> {
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
        };
        let safe_starts = starts(&is_safe);
        let starts = starts(&is_open);
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
    fn block(&mut self, way: [usize; 2], seconds: f64) {
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
    fn lost_until(&self, seconds: f64) -> [f64; 2] {
        let lately = self.lost.filter(|[_, last]| seconds - last <= LOST);
        [lately.map_or(seconds, |[first, _]| first), seconds]
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

/// A way on which the bot was stuck.
#[derive(Clone, Copy, Debug)]
struct Blocked {
    way: [usize; 2],
    /// Until when the way is avoided, seconds.
    until: f64,
    /// For how long it is avoided, seconds.
    lasts: f64,
}

impl Blocked {
    /// True if the way has been open long enough to try it like a new one.
    fn is_forgotten(&self, seconds: f64) -> bool {
        seconds > self.until + FORGETS * self.lasts
    }
}

/// A blocked way is forgotten after it was open for this many times as long as it was avoided.
const FORGETS: f64 = 4.0;

/// A bot within this share of its radius of a goal patch's seat has arrived.
const THERE: f64 = 0.5;

/// A bot that hangs counts as shaken in shakes above this share of the shake in which it can only hang. Its wait before
/// it lets go then starts over.
const STILL: f64 = 0.2;

/// A place to rest has to stay calm for this time, seconds.
const RESTS: f64 = 8.0;

/// A bot that finds no way for this time lets go, seconds.
const LOST: f64 = 3.0;

/// The steepest slope on which the bot lets go to rest anywhere, as a share of the steepest one that it can stand on.
const LETS_GO: f64 = 0.8;
/// The steepest slope on which the bot lets go to rest or walk as planned, as a share of the steepest one that it can
/// stand on.
const AS_PLANNED: f64 = 0.97;

/// From a ledge the bot hangs this many times as long before it lets go.
const LEDGES: f64 = 2.0;
/// Distance that the bot goes along a ledge without room above, radii.
const SHIMMIES: f64 = 2.5;

/// Stamina that the bot has to spare when it goes on without a rest.
const SPARE: f64 = 0.05;

/// The place to which the bot moves next.
#[derive(Clone, Copy, Debug)]
struct Target {
    place: DVec3,
    normal: DVec3,
    footing: Footing,
    /// True if the climber takes hold of another side there.
    in_corner: bool,
}
