//! On the ground: to where it can get on.

use std::collections::BTreeMap;

use clamber_climber::{ClimberInput, ClimberMode};
use glam::DVec3;

use super::{BotConfig, Danger, View};
use crate::graph::highest_entry;
use crate::plan::Around;
use crate::{ClimbGraph, Footing, Start};

/// It jumps within so many radii of where it gets on, seen from above.
const NEAR: f64 = 2.2;

/// It counts as blocked if it wants to walk but moves at less than this share of its walking speed for `PUZZLED`
/// seconds.
const KEPT: f64 = 0.15;
const PUZZLED: f64 = 0.3;

/// It keeps its distance to so many radii.
const SWAY: f64 = 0.5;

/// Least time between two jumps, seconds.
const BETWEEN_JUMPS: f64 = 1.2;

/// Jumps at an entry before it tries another one, and for how long it then avoids it, seconds.
const TRIES: u32 = 3;
const AVOIDS: f64 = 20.0;

/// Who falls within so many seconds after it got on avoids that limb.
const SOON: f64 = 8.0;

/// An entry that is faster than this share of the speed at which hands catch swings.
const SWINGS: f64 = 0.4;

/// It chooses an entry anew every so many seconds.
const CHOOSES: f64 = 0.5;

/// From the ground to its first patch it takes so long, and it waits no longer than `WAITS` for a good time to do so,
/// seconds.
const GETS_ON: f64 = 0.5;
const WAITS: f64 = 60.0;

/// A search for that time which found nothing is made again after so many seconds at most.
const PAUSE: f64 = 2.0;

/// An entry has to be better by so many seconds to be taken instead of the one that it goes to.
const BETTER: f64 = 1.5;

/// Memory of a bot on the ground.
#[derive(Clone, Debug)]
pub(super) struct Approach {
    /// The entry that it goes to.
    entry: Option<usize>,
    tries: u32,
    /// Entries that did not work, and until when they are avoided.
    avoided: Vec<(usize, f64)>,
    chosen: f64,
    jumped: f64,
    /// When it was last not blocked.
    free: f64,
    /// Since when it sees an attack.
    attacked: Option<f64>,
    /// The entry by which it got on last, and when.
    rode: Option<(usize, f64)>,
    /// Where the entry that it goes to was, and when.
    seen: Option<(usize, DVec3, f64)>,
    /// Since when it waits for a time from which its strength is enough, whether that is now, and after how long it has
    /// seen all that is expected, seconds.
    waits: Option<f64>,
    lasts: bool,
    repeats: f64,
    /// When it last looked for that, and after how long it looks again, seconds.
    looked: f64,
    pause: f64,
    /// It has let go, and holds on to nothing before it stands on the ground.
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
            repeats: WAITS,
            looked: f64::NEG_INFINITY,
            pause: 0.5 * CHOOSES,
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
        // Who has waited in vain does not wait again.
        if self.lasts {
            self.waits = None;
        }
    }

    /// Tries another entry than the one that it goes to.
    pub(super) fn gives_up(&mut self, seconds: f64) {
        if let Some(entry) = self.entry.take() {
            self.avoided.push((entry, seconds + AVOIDS));
        }
        self.tries = 0;
        self.chosen = f64::NEG_INFINITY;
    }

    /// True if it jumps now: not too soon after the last jump.
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
            // A tired one does not grip: it rests on the ground, even if it runs into a leg.
            return ClimberInput {
                walk: away.normalize_or(up.any_orthonormal_vector()),
                grip: !stands || is_rested(config, view),
                ..ClimberInput::IDLE
            };
        }
        if seconds - self.chosen >= CHOOSES && state.mode == ClimberMode::Standing {
            self.choose(graph, config, view);
        }
        let Some(entry) = self.entry else {
            self.free = seconds;
            // Nothing that it could hold leads on.
            return if stands { ClimberInput::IDLE } else { grip };
        };
        let patch = &graph.patches()[graph.entries()[entry].patch];
        let toward = level(view.spot(patch).point - state.position);
        let keeps = match view.danger {
            Danger::None => 0.0,
            _ => config.keeps_away * view.climber.config().body.radius,
        };
        let away = toward.length() - keeps;
        let ahead = if away.abs() > SWAY * view.climber.config().body.radius {
            away.signum()
        } else {
            0.0
        };
        let walk = toward.normalize_or_zero() * ahead;
        let kept = KEPT * view.climber.config().ground.walk_speed;
        if walk == DVec3::ZERO || state.velocity.length() > kept {
            self.free = seconds;
        }
        let is_ready = is_rested(config, view) && self.is_time(view);
        let near = toward.length() < NEAR * view.climber.config().body.radius;
        let swings = self.swings(entry, view.spot(patch).point, view);
        let is_blocked = seconds - self.free > PUZZLED;
        let wants = keeps == 0.0 && !swings && is_ready && (near || is_blocked);
        let jump = state.mode == ClimberMode::Standing && wants && self.jumps(seconds);
        if jump {
            self.tries += 1;
            if self.tries >= TRIES {
                self.gives_up(seconds);
            }
        }
        ClimberInput {
            walk,
            jump,
            // Whoever walks into a limb holds on to it.
            grip: is_ready || !stands,
            ..ClimberInput::IDLE
        }
    }

    /// It has fallen soon after it had got on: the limb by which it did is avoided for a while.
    fn fell_off(&mut self, graph: &ClimbGraph, view: &View<'_>) {
        let Some((entry, since)) = self.rode.take() else {
            return;
        };
        if view.seconds - since > SOON {
            return;
        }
        let mesh = view.surface.mesh();
        let joint = |entry: usize| {
            let entry = graph.entries().get(entry)?;
            mesh.joint_of(graph.patches().get(entry.patch)?.triangle)
        };
        let limb = joint(entry);
        let until = view.seconds + AVOIDS;
        let all = 0..graph.entries().len();
        let same = all.filter(|other| *other == entry || limb.is_some() && joint(*other) == limb);
        self.avoided.extend(same.map(|entry| (entry, until)));
        self.chosen = f64::NEG_INFINITY;
    }

    /// No way leads on from a patch: all entries that lead to it are avoided for a while.
    pub(super) fn gives_up_limb(&mut self, graph: &ClimbGraph, view: &View<'_>, patch: usize) {
        (self.rode, self.drops) = (None, true);
        self.gives_up(view.seconds);
        let reached = graph.region([patch]);
        let until = view.seconds + AVOIDS;
        let all = graph.entries().iter().enumerate();
        let same = all.filter(|(_, entry)| reached.has(entry.patch));
        self.avoided.extend(same.map(|(entry, _)| (entry, until)));
    }

    /// The input of somebody who gets off the creature, from wherever that is.
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

    /// True while an entry moves too fast for hands to catch it: a foot that swings is none until it stands.
    fn swings(&mut self, entry: usize, place: DVec3, view: &View<'_>) -> bool {
        let before = self.seen.replace((entry, place, view.seconds));
        let Some((_, from, since)) = before.filter(|(seen, ..)| *seen == entry) else {
            return true;
        };
        let lasted = view.seconds - since;
        // A climber without a grip catches nothing, so no entry is too fast for its hands.
        let grip = view.climber.config().grip;
        let catches = grip.map_or(f64::INFINITY, |grip| grip.catch_speed);
        lasted > 0.0 && place.distance(from) > SWINGS * catches * lasted
    }

    /// True if it is time to get on: its strength is enough for what is expected from now on, or it has waited for such
    /// a time until all that is expected has passed.
    fn is_time(&mut self, view: &View<'_>) -> bool {
        if view.forecast.is_still() || self.lasts {
            self.waits = None;
            return true;
        }
        if view.danger != Danger::None {
            // It keeps away for now.
            self.waits = None;
            return false;
        }
        let since = *self.waits.get_or_insert(view.seconds);
        view.seconds - since >= self.repeats
    }

    /// The hardest shake in which it gets on, metres a second squared.
    fn shake(config: &BotConfig, view: &View<'_>) -> f64 {
        let climber = view.climber.config();
        let stands = config.stands_in * climber.ground.throw_acceleration;
        let holds = climber
            .grip
            .map(|grip| config.climbs_in * grip.hang_acceleration);
        holds.unwrap_or(stands)
    }

    /// The entry from which its strength is enough for what is expected.
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
                let seconds = comes + GETS_ON;
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

    /// Chooses the entry from which it comes to the goal first.
    fn choose(&mut self, graph: &ClimbGraph, config: &BotConfig, view: &View<'_>) {
        let seconds = view.seconds;
        self.chosen = seconds;
        self.avoided.retain(|(_, until)| *until > seconds);
        let (state, climber) = (view.climber.state(), view.climber.config());
        let feet = state.position.dot(climber.up()) - climber.body.radius;
        let highest = highest_entry(graph.config());
        let footings = [Footing::Stands, Footing::Holds];
        let place = |entry: usize| {
            view.spot(&graph.patches()[graph.entries()[entry].patch])
                .point
        };
        // When it comes to an entry; `None` to one that is too high, did not work, or is not there, as on a plate that broke.
        let comes = |entry: usize| {
            let is_avoided = self.avoided.iter().any(|(other, _)| *other == entry);
            if is_avoided || !graph.is_there(graph.entries()[entry].patch, view.surface) {
                return None;
            }
            let place = place(entry);
            if place.dot(climber.up()) - feet > highest {
                return None;
            }
            let way = place - state.position;
            let way = (way - climber.up() * way.dot(climber.up())).length();
            Some(way / climber.ground.walk_speed.max(1e-3))
        };
        self.lasts = false;
        if !view.forecast.is_still()
            && view.danger == Danger::None
            && is_rested(config, view)
            && seconds - self.looked >= self.pause
        {
            let lasting = self.lasting(graph, config, view, comes);
            self.lasts = lasting.is_some();
            self.repeats = view.forecast.repeats_after().min(WAITS);
            // A search that finds nothing takes long: it is made less and less often.
            self.pause = if self.lasts {
                CHOOSES
            } else {
                (2.0 * self.pause).min(PAUSE)
            };
            self.looked = seconds;
            if lasting.is_some() {
                (self.entry, self.tries) =
                    (lasting, if self.entry == lasting { self.tries } else { 0 });
                return;
            }
        }
        let (strength, most) = (strength(config, view), Self::shake(config, view));
        // Seconds to the goal by an entry, after whether it tires on the way: then it comes as far as its strength goes.
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
            // A foot that swings is no entry until it stands.
            let seconds = comes + view.forecast.calms_after(graph, at, comes, most) + left;
            left.is_finite().then_some((tires, seconds))
        };
        let all = (0..graph.entries().len()).filter_map(|entry| Some((cost(entry)?, entry)));
        let best =
            all.min_by(|((tires, cost), _), ((a, b), _)| tires.cmp(a).then(cost.total_cmp(b)));
        let now = self.entry.and_then(cost);
        let is_better = |(tires, seconds): (bool, f64)| {
            now.is_none_or(|(now, left)| (!tires && now) || tires == now && seconds + BETTER < left)
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

/// The stamina that it counts on once it gets on: it rests before it does.
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

/// True if it has the strength to get on.
fn is_rested(config: &BotConfig, view: &View<'_>) -> bool {
    let stamina = view.climber.config().stamina;
    let rests = stamina.is_some_and(|stamina| stamina.refill > 0.0);
    !rests || view.climber.state().stamina >= config.rested.min(1.0)
}
