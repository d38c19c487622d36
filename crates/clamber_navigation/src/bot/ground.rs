//! On the ground: to where it can get on.

use clamber_climber::{ClimberInput, ClimberMode};
use glam::DVec3;

use super::{BotConfig, Danger, View};
use crate::ClimbGraph;
use crate::graph::highest_entry;

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

/// It chooses an entry anew every so many seconds.
const CHOOSES: f64 = 0.5;

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
        }
    }
}

impl Approach {
    pub(super) fn got_on(&mut self) {
        self.entry = None;
        self.tries = 0;
        self.attacked = None;
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
            return ClimberInput {
                walk: away.normalize_or(up.any_orthonormal_vector()),
                ..grip
            };
        }
        if seconds - self.chosen >= CHOOSES && state.mode == ClimberMode::Standing {
            self.choose(graph, view);
        }
        let Some(entry) = self.entry else {
            self.free = seconds;
            return grip;
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
        let near = toward.length() < NEAR * view.climber.config().body.radius;
        let wants = keeps == 0.0 && (near || seconds - self.free > PUZZLED);
        let jump = state.mode == ClimberMode::Standing && wants && self.jumps(seconds);
        if jump {
            self.tries += 1;
            if self.tries >= TRIES {
                self.gives_up(seconds);
            }
        }
        ClimberInput { walk, jump, ..grip }
    }

    /// Chooses the entry from which it comes to the goal first.
    fn choose(&mut self, graph: &ClimbGraph, view: &View<'_>) {
        let seconds = view.seconds;
        self.chosen = seconds;
        self.avoided.retain(|(_, until)| *until > seconds);
        let (state, climber) = (view.climber.state(), view.climber.config());
        let feet = state.position.dot(climber.up()) - climber.body.radius;
        let highest = highest_entry(graph.config());
        let cost = |entry: usize| {
            let at = graph.entries()[entry];
            let patch = &graph.patches()[at.patch];
            let left = view.goal.least_seconds_from(at.patch);
            let avoided = self.avoided.iter().any(|(other, _)| *other == entry);
            if !left.is_finite() || avoided {
                return f64::INFINITY;
            }
            let place = view.spot(patch).point;
            let height = place.dot(climber.up()) - feet;
            if height > highest {
                return f64::INFINITY;
            }
            let way = place - state.position;
            let way = (way - climber.up() * way.dot(climber.up())).length();
            way / climber.ground.walk_speed.max(1e-3) + left
        };
        let all = (0..graph.entries().len()).map(|entry| (cost(entry), entry));
        let best = all
            .filter(|(cost, _)| cost.is_finite())
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let now = self.entry.map_or(f64::INFINITY, cost);
        match best {
            Some((cost, entry)) if cost + BETTER < now || self.entry.is_none() => {
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
