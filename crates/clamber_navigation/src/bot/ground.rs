//! A bot on the ground: how it chooses an entry, and gets on there.

use std::collections::BTreeMap;

use clamber_climber::{ClimberInput, ClimberMode};
use glam::DVec3;

use super::{BotConfig, Danger, View};
use crate::graph::highest_entry;
use crate::plan::Around;
use crate::{ClimbGraph, Footing, Start};

/// The bot jumps within this many radii of the place where it gets on, seen from above.
const JUMP_DISTANCE: f64 = 2.2;

/// The bot counts as blocked if it wants to walk, but stays below this share of its walking speed for [`BLOCKED_TIME`]
/// seconds.
const BLOCKED_SPEED_SHARE: f64 = 0.15;
/// Time after which a bot that does not move counts as blocked, seconds.
const BLOCKED_TIME: f64 = 0.3;

/// Tolerance of the distance that the bot keeps, radii.
const KEPT_DISTANCE_TOLERANCE: f64 = 0.5;

/// Least time between two jumps, seconds.
const BETWEEN_JUMPS: f64 = 1.2;

/// Number of jumps at an entry before the bot tries another one.
const JUMPS_PER_ENTRY: u32 = 3;
/// Time for which the bot avoids an entry that did not work, seconds.
const ENTRY_AVOIDED_TIME: f64 = 20.0;

/// A bot that falls within this time after it got on avoids the limb by which it got on, seconds.
const EARLY_FALL_TIME: f64 = 8.0;

/// An entry that moves faster than this share of the speed at which hands catch counts as swinging.
const SWINGING_SPEED_SHARE: f64 = 0.4;

/// The bot chooses an entry anew once in this time, seconds.
const CHOICE_INTERVAL: f64 = 0.5;

/// Time from the ground to the first patch, seconds.
const GET_ON_TIME: f64 = 0.5;
/// The longest time that the bot waits for a good time to get on, seconds.
const LONGEST_WAIT: f64 = 60.0;

/// The longest pause between two searches for such a time while they find none, seconds. The searches take long.
const LONGEST_PAUSE: f64 = 2.0;

/// Another entry has to be better by this time to replace the present one, seconds. It keeps the bot from switching
/// back and forth.
const BETTER_ENTRY_TIME: f64 = 1.5;

/// State of a bot on the ground.
#[derive(Clone, Debug)]
pub(super) struct Approach {
    /// The entry to which the bot goes.
    entry: Option<usize>,
    /// Number of jumps at this entry so far.
    tries: u32,
    /// Entries that did not work, each with the time until which it is avoided, seconds.
    avoided: Vec<(usize, f64)>,
    /// When the bot last chose an entry, seconds.
    chosen: f64,
    /// When the bot last jumped, seconds.
    jumped: f64,
    /// When the bot was last not blocked, seconds.
    free: f64,
    /// When the bot first saw the present attack, seconds.
    attacked: Option<f64>,
    /// The entry by which the bot got on last, and when.
    rode: Option<(usize, f64)>,
    /// The present entry, with its place at the last look and the time of that look.
    seen: Option<(usize, DVec3, f64)>,
    /// When the bot began to wait for a time from which on its stamina is enough, seconds.
    waits: Option<f64>,
    /// True if its stamina is enough from now on.
    lasts: bool,
    /// Seconds after which the forecast repeats.
    repeats: f64,
    /// When the bot last searched for such a time, seconds.
    looked: f64,
    /// Seconds from that search until the next one.
    pause: f64,
    /// True if the bot has let go. It does not grip before it stands on the ground.
    pub(super) drops: bool,
}

impl Default for Approach {
    fn default() -> Self {
        Self {
            entry: None,
            tries: 0,
            avoided: Vec::new(),
            chosen: f64::NEG_INFINITY,
            jumped: f64::NEG_INFINITY,
            free: 0.0,
            attacked: None,
            rode: None,
            seen: None,
            waits: None,
            lasts: false,
            repeats: LONGEST_WAIT,
            looked: f64::NEG_INFINITY,
            pause: 0.5 * CHOICE_INTERVAL,
            drops: false,
        }
    }
}

impl Approach {
    pub(super) fn got_on(&mut self, seconds: f64) {
        self.rode = self
            .entry
            .take()
            .map(|entry| (entry, seconds))
            .or(self.rode);
        self.tries = 0;
        self.attacked = None;
        // A bot that got on after a wait without success does not wait again: it keeps `waits`.
        if self.lasts {
            self.waits = None;
        }
    }

    /// Avoids the present entry for a while, and chooses another one.
    pub(super) fn gives_up(&mut self, seconds: f64) {
        if let Some(entry) = self.entry.take() {
            self.avoided.push((entry, seconds + ENTRY_AVOIDED_TIME));
        }
        self.tries = 0;
        self.chosen = f64::NEG_INFINITY;
    }

    /// True if the bot jumps now: the last jump was long enough ago.
    pub(super) fn jumps(&mut self, seconds: f64) -> bool {
        let jumps = seconds - self.jumped > BETWEEN_JUMPS;
        if jumps {
            self.jumped = seconds;
        }
        jumps
    }

    pub(super) fn input(
        &mut self,
        graph: &ClimbGraph,
        config: &BotConfig,
        view: &View<'_>,
    ) -> ClimberInput {
        let (seconds, state) = (view.seconds, view.climber.state());
        let stands = state.mode == ClimberMode::Standing;
        if self.drops && !stands {
            return ClimberInput::IDLE;
        }
        self.drops = false;
        if stands {
            self.fell_off(graph, view);
        }
        let up = view.climber.config().up();
        let level = |way: DVec3| way - up * way.dot(up);
        let attacks = view.danger == Danger::Attacks;
        self.attacked = self.attacked.or(Some(seconds)).filter(|_| attacks);
        let grip = ClimberInput {
            grip: true,
            ..ClimberInput::IDLE
        };
        if self
            .attacked
            .is_some_and(|since| seconds - since >= config.reaction)
        {
            self.free = seconds;
            let away = level(state.position - view.surface.world_from_model().translation);
            // A tired bot does not grip, so that it rests on the ground even if it runs into a leg.
            return ClimberInput {
                walk: away.normalize_or(up.any_orthonormal_vector()),
                grip: !stands || is_rested(config, view),
                ..ClimberInput::IDLE
            };
        }
        if seconds - self.chosen >= CHOICE_INTERVAL && state.mode == ClimberMode::Standing {
            self.choose(graph, config, view);
        }
        let Some(entry) = self.entry else {
            self.free = seconds;
            // Without an entry that leads to the goal, a standing bot grips nothing.
            return if stands { ClimberInput::IDLE } else { grip };
        };
        let patch = &graph.patches()[graph.entries()[entry].patch];
        let toward = level(view.spot(patch).point - state.position);
        let (walk, keeps) = approach(toward, config, view);
        let kept = BLOCKED_SPEED_SHARE * view.climber.config().ground.walk_speed;
        if walk == DVec3::ZERO || state.velocity.length() > kept {
            self.free = seconds;
        }
        let is_ready = is_rested(config, view) && self.is_time(view);
        let near = toward.length() < JUMP_DISTANCE * view.climber.config().body.radius;
        let swings = self.swings(entry, view.spot(patch).point, view);
        let is_blocked = seconds - self.free > BLOCKED_TIME;
        let wants = keeps == 0.0 && !swings && is_ready && (near || is_blocked);
        let jump = state.mode == ClimberMode::Standing && wants && self.jumps(seconds);
        if jump {
            self.tries += 1;
            if self.tries >= JUMPS_PER_ENTRY {
                self.gives_up(seconds);
            }
        }
        ClimberInput {
            walk,
            jump,
            // A bot that walks into a limb holds on to it.
            grip: is_ready || !stands,
            ..ClimberInput::IDLE
        }
    }

    /// After a fall soon after the bot got on: avoids the limb by which it got on for a while.
    fn fell_off(&mut self, graph: &ClimbGraph, view: &View<'_>) {
        let Some((entry, since)) = self.rode.take() else {
            return;
        };
        if view.seconds - since > EARLY_FALL_TIME {
            return;
        }
        let mesh = view.surface.mesh();
        let joint = |entry: usize| {
            let entry = graph.entries().get(entry)?;
            mesh.joint_of(graph.patches().get(entry.patch)?.triangle)
        };
        let limb = joint(entry);
        let until = view.seconds + ENTRY_AVOIDED_TIME;
        let all = 0..graph.entries().len();
        let same = all.filter(|other| *other == entry || limb.is_some() && joint(*other) == limb);
        self.avoided.extend(same.map(|entry| (entry, until)));
        self.chosen = f64::NEG_INFINITY;
    }

    /// Avoids all entries that lead to a patch for a while, because no way leads on from there.
    pub(super) fn gives_up_limb(&mut self, graph: &ClimbGraph, view: &View<'_>, patch: usize) {
        (self.rode, self.drops) = (None, true);
        self.gives_up(view.seconds);
        let reached = graph.region([patch]);
        let until = view.seconds + ENTRY_AVOIDED_TIME;
        let all = graph.entries().iter().enumerate();
        let same = all.filter(|(_, entry)| reached.has(entry.patch));
        self.avoided.extend(same.map(|(entry, _)| (entry, until)));
    }

    /// Input with which the bot gets off the creature from any place on it.
    pub(super) fn leave(&mut self, view: &View<'_>) -> ClimberInput {
        let state = view.climber.state();
        let up = view.climber.config().up();
        let away = state.position - view.surface.world_from_model().translation;
        let level = away - up * away.dot(up);
        let stands = state.mode == ClimberMode::Standing;
        ClimberInput {
            walk: level.normalize_or(up.any_orthonormal_vector()),
            jump: stands && self.jumps(view.seconds),
            ..ClimberInput::IDLE
        }
    }

    /// True while an entry moves too fast for hands to catch it. A swinging foot becomes an entry when it stands.
    fn swings(&mut self, entry: usize, place: DVec3, view: &View<'_>) -> bool {
        let before = self.seen.replace((entry, place, view.seconds));
        let Some((_, from, since)) = before.filter(|(seen, ..)| *seen == entry) else {
            return true;
        };
        let lasted = view.seconds - since;
        // A climber without a grip catches nothing, so no entry is too fast for its hands.
        let grip = view.climber.config().grip;
        let catches = grip.map_or(f64::INFINITY, |grip| grip.catch_speed);
        lasted > 0.0 && place.distance(from) > SWINGING_SPEED_SHARE * catches * lasted
    }

    /// True if it is time to get on: the bot's stamina is enough for the forecast from now on, or the bot has waited
    /// for one full repetition of the forecast, a minute at most.
    fn is_time(&mut self, view: &View<'_>) -> bool {
        if view.forecast.is_still() || self.lasts {
            self.waits = None;
            return true;
        }
        if view.danger != Danger::None {
            // While the creature is dangerous, the bot keeps away instead.
            self.waits = None;
            return false;
        }
        let since = *self.waits.get_or_insert(view.seconds);
        view.seconds - since >= self.repeats
    }

    /// The hardest shake in which the bot gets on, metres per second squared.
    fn shake(config: &BotConfig, view: &View<'_>) -> f64 {
        let climber = view.climber.config();
        let stands = config.stands_in * climber.ground.throw_acceleration;
        let holds = climber
            .grip
            .map(|grip| config.climbs_in * grip.hang_acceleration);
        holds.unwrap_or(stands)
    }

    /// The entry from which the bot's stamina is enough for the forecast. `comes` gives the time at which the bot
    /// arrives at an entry.
    fn lasting(
        &self,
        graph: &ClimbGraph,
        config: &BotConfig,
        view: &View<'_>,
        comes: impl Fn(usize) -> Option<f64>,
    ) -> Option<usize> {
        let reach = 0..graph.entries().len();
        let known: BTreeMap<usize, (usize, f64)> = reach
            .filter_map(|entry| Some((graph.entries()[entry].patch, (entry, comes(entry)?))))
            .collect();
        let most = Self::shake(config, view);
        let starts = graph.starts_on_ground(strength(config, view));
        let starts: Vec<Start> = starts
            .filter_map(|start| {
                let comes = known.get(&start.patch)?.1;
                let is_calm = view.forecast.is_calm_from(graph, start.patch, comes, most);
                let seconds = comes + GET_ON_TIME;
                is_calm.then_some(Start { seconds, ..start })
            })
            .collect();
        let around = Around {
            is_open: &|_, to| graph.is_there(to, view.surface),
            ..Around::default()
        };
        let plan = graph.plan_around(&starts, view.goal, view.forecast, &around)?;
        Some(known.get(&plan.steps.first()?.patch)?.0)
    }

    /// Chooses the entry by which the bot gets to the goal first.
    fn choose(&mut self, graph: &ClimbGraph, config: &BotConfig, view: &View<'_>) {
        let seconds = view.seconds;
        self.chosen = seconds;
        self.avoided.retain(|(_, until)| *until > seconds);
        let avoided = &self.avoided;
        let comes = |entry: usize| comes(graph, view, avoided, entry);
        self.lasts = false;
        if !view.forecast.is_still()
            && view.danger == Danger::None
            && is_rested(config, view)
            && seconds - self.looked >= self.pause
        {
            let lasting = self.lasting(graph, config, view, comes);
            self.lasts = lasting.is_some();
            self.repeats = view.forecast.repeats_after().min(LONGEST_WAIT);
            // A search that finds nothing takes long, so it is repeated less and less often.
            self.pause = if self.lasts {
                CHOICE_INTERVAL
            } else {
                (2.0 * self.pause).min(LONGEST_PAUSE)
            };
            self.looked = seconds;
            if lasting.is_some() {
                (self.entry, self.tries) =
                    (lasting, if self.entry == lasting { self.tries } else { 0 });
                return;
            }
        }
        let (strength, most) = (strength(config, view), Self::shake(config, view));
        let footings = [Footing::Stands, Footing::Holds];
        // The cost of an entry: whether the bot tires on the way to the goal, then the seconds to the goal. If it
        // tires, it gets as far as its stamina lasts.
        let cost = |entry: usize| {
            let comes = comes(entry)?;
            let at = graph.entries()[entry].patch;
            let [stands, holds] =
                footings.map(|footing| view.goal.least_seconds_with(at, footing, strength));
            let lasts = stands.min(holds);
            let tires = !lasts.is_finite();
            let left = if tires {
                view.goal.least_seconds_from(at)
            } else {
                lasts
            };
            // A swinging foot becomes an entry when it stands.
            let seconds = comes + view.forecast.calms_after(graph, at, comes, most) + left;
            left.is_finite().then_some((tires, seconds))
        };
        let all = (0..graph.entries().len()).filter_map(|entry| Some((cost(entry)?, entry)));
        let best =
            all.min_by(|((tires, cost), _), ((a, b), _)| tires.cmp(a).then(cost.total_cmp(b)));
        let now = self.entry.and_then(cost);
        let is_better = |(tires, seconds): (bool, f64)| {
            now.is_none_or(|(now, left)| {
                (!tires && now) || tires == now && seconds + BETTER_ENTRY_TIME < left
            })
        };
        match best {
            Some((cost, entry)) if is_better(cost) => {
                if self.entry != Some(entry) {
                    self.tries = 0;
                }
                self.entry = Some(entry);
            }
            None => {
                self.entry = None;
                self.avoided.clear();
            }
            _ => {}
        }
    }
}

/// Seconds until the bot arrives at an entry. `None` for an entry that is too high, did not work, or is gone, as on a
/// plate that broke.
fn comes(
    graph: &ClimbGraph,
    view: &View<'_>,
    avoided: &[(usize, f64)],
    entry: usize,
) -> Option<f64> {
    let is_avoided = avoided.iter().any(|(other, _)| *other == entry);
    let patch = graph.entries()[entry].patch;
    if is_avoided || !graph.is_there(patch, view.surface) {
        return None;
    }
    let (state, climber) = (view.climber.state(), view.climber.config());
    let feet = state.position.dot(climber.up()) - climber.body.radius;
    let place = view.spot(&graph.patches()[patch]).point;
    if place.dot(climber.up()) - feet > highest_entry(graph.config()) {
        return None;
    }
    let way = place - state.position;
    let way = (way - climber.up() * way.dot(climber.up())).length();
    Some(way / climber.ground.walk_speed.max(1e-3))
}

/// The stamina that the bot counts on when it gets on: it rests before that.
fn strength(config: &BotConfig, view: &View<'_>) -> f64 {
    let stamina = view.climber.config().stamina;
    let rests = stamina.is_some_and(|stamina| stamina.refill > 0.0);
    let now = view.climber.state().stamina;
    let then = if rests {
        now.max(config.rested.min(1.0))
    } else {
        now
    };
    (then - config.reserve).max(0.0)
}

/// How the bot walks to a place, and how far from it the bot keeps, metres.
fn approach(toward: DVec3, config: &BotConfig, view: &View<'_>) -> (DVec3, f64) {
    let radius = view.climber.config().body.radius;
    let keeps = match view.danger {
        Danger::None => 0.0,
        _ => config.keeps_away * radius,
    };
    let away = toward.length() - keeps;
    let ahead = if away.abs() > KEPT_DISTANCE_TOLERANCE * radius {
        away.signum()
    } else {
        0.0
    };
    (toward.normalize_or_zero() * ahead, keeps)
}

/// True if the bot has the stamina to get on.
fn is_rested(config: &BotConfig, view: &View<'_>) -> bool {
    let stamina = view.climber.config().stamina;
    let rests = stamina.is_some_and(|stamina| stamina.refill > 0.0);
    !rests || view.climber.state().stamina >= config.rested.min(1.0)
}
