//! A bot on a creature: it holds on while the skin shakes, rests, jumps and climbs as planned.

use clamber_climber::{ClimberInput, ClimberMode};
use glam::DVec3;

use super::follow::Progress;
use super::jumps::TakeOff;
use super::{Bot, CALM_REST_TIME, View};
use crate::Footing;

/// A bot that hangs counts as shaken in shakes above this share of the shake in which it can only hang. Its wait before
/// it lets go then starts over.
const SHAKEN_HANG_SHARE: f64 = 0.2;

/// The steepest slope on which the bot lets go to rest anywhere, as a share of the steepest one that it can stand on.
const LET_GO_SLOPE: f64 = 0.8;

/// The steepest slope on which the bot lets go to rest or walk as planned, as a share of the steepest one that it can
/// stand on.
const PLANNED_REST_SLOPE: f64 = 0.97;

/// From a ledge the bot hangs this many times as long before it lets go.
const LEDGE_HANG_FACTOR: f64 = 2.0;

/// Distance that the bot goes along a ledge without room above, radii.
const SHIMMY_DISTANCE: f64 = 2.5;

/// Holds on.
const HOLD_ON: ClimberInput = ClimberInput {
    grip: true,
    ..ClimberInput::IDLE
};

/// Rests: the climber lets go, and stands or lies.
const LET_GO: ClimberInput = ClimberInput::IDLE;

/// How safe a bot is where it is.
struct Balance {
    stands: bool,
    /// True if the skin shakes so little that the bot can stand.
    can_stand: bool,
    /// True if the bot has to rest, and can do so here.
    rests_here: bool,
    /// True if the bot has to hold on.
    is_shaken: bool,
}

impl Balance {
    /// Rests if the bot can stand; otherwise holds on.
    fn waits(&self) -> ClimberInput {
        if self.can_stand { LET_GO } else { HOLD_ON }
    }
}

impl Bot {
    /// The input on a patch of the creature.
    pub(super) fn climb(&mut self, view: &View<'_>, patch: usize) -> ClimberInput {
        self.approach.got_on(view.seconds);
        if let Some(way) = self.jumps.ends(&self.graph, view) {
            self.block(way, view.seconds);
        }
        let balance = self.balance(view, patch);
        if balance.is_shaken {
            if let Some(plan) = &mut self.plan {
                plan.waits(view.seconds);
            }
            return HOLD_ON;
        }
        if balance.rests_here {
            return LET_GO;
        }
        self.follow_or_plan(view, patch);
        if self.plan.is_none() {
            return self.without_way(view, patch, &balance);
        }
        self.approach.drops = false;
        self.lost = None;
        self.rest_as_planned(view, &balance)
            .or_else(|| self.jump_as_planned(view, &balance))
            .unwrap_or_else(|| self.go_on(view, &balance))
    }

    fn balance(&self, view: &View<'_>, patch: usize) -> Balance {
        let state = view.climber.state();
        let stands = state.mode == ClimberMode::Standing;
        let hangs = view
            .climber
            .config()
            .grip
            .map_or(0.0, |grip| grip.hang_acceleration);
        let throws = view.climber.config().ground.throw_acceleration;
        // If no place stays calm, the bot rests wherever it can, between shakes.
        let is_calm =
            || !self.finds_calm || view.forecast.is_calm_at(&self.graph, patch, CALM_REST_TIME);
        let rests_here = self.rests && (stands || view.is_level(LET_GO_SLOPE)) && is_calm();
        // The shake ahead counts as well, because hands need time to take hold.
        let can_stand =
            state.shake.length().max(view.shake_ahead) <= self.config.stands_in * throws;
        let is_shaken = if stands || rests_here {
            !can_stand
        } else {
            state.shake.length() > self.config.climbs_in * hangs
        };
        Balance {
            stands,
            can_stand,
            rests_here,
            is_shaken,
        }
    }

    /// The input of a bot that finds no way: it rests or holds on. If it is lost, it gets off.
    fn without_way(&mut self, view: &View<'_>, patch: usize, balance: &Balance) -> ClimberInput {
        if self.is_lost(view.seconds) && !self.approach.drops {
            self.approach.gives_up_limb(&self.graph, view, patch);
        }
        if self.approach.drops {
            return self.approach.leave(view);
        }
        // The bot has no way for now, and rests if it can.
        let is_level = self.graph.patches[patch].can_stand || balance.stands;
        if is_level { LET_GO } else { HOLD_ON }
    }

    /// The input of a rest that the plan has here; `None` once the bot is rested.
    fn rest_as_planned(&mut self, view: &View<'_>, balance: &Balance) -> Option<ClimberInput> {
        let state = view.climber.state();
        let progress = self.plan.as_mut()?;
        let wanted = progress.rests_until()?;
        let is_level = balance.stands || view.is_level(PLANNED_REST_SLOPE);
        let needs = state.stamina < 1.0 && state.stamina < wanted + self.config.reserve;
        if needs && is_level {
            progress.waits(view.seconds);
            return Some(balance.waits());
        }
        // The climber may still hold on to the slope beside the place of its rest.
        let comes = needs && !progress.is_stuck(view.seconds, self.config.patience);
        if !comes {
            progress.has_rested();
        }
        None
    }

    /// The input of a jump that the plan has here; `None` if the bot stands elsewhere, or there is none.
    fn jump_as_planned(&mut self, view: &View<'_>, balance: &Balance) -> Option<ClimberInput> {
        let progress = self.plan.as_mut().filter(|_| balance.stands)?;
        let ends = progress.next_jump()?;
        match self.jumps.take_off(&self.graph, view, ends)? {
            TakeOff::Now(aim) if balance.can_stand => Some(if self.approach.jumps(view.seconds) {
                self.jumps.begin(&self.graph, view, ends, aim)
            } else {
                LET_GO
            }),
            TakeOff::Later | TakeOff::Tired => {
                progress.waits(view.seconds);
                Some(balance.waits())
            }
            TakeOff::Unsure | TakeOff::Now(_) => Some(balance.waits()),
        }
    }

    /// The input towards the next patch of the plan.
    fn go_on(&mut self, view: &View<'_>, balance: &Balance) -> ClimberInput {
        let Some(progress) = &mut self.plan else {
            return HOLD_ON;
        };
        let Some(target) = progress.target(&self.graph, view, &self.config) else {
            return HOLD_ON;
        };
        let Balance {
            stands, can_stand, ..
        } = *balance;
        let toward = target.place - view.climber.state().position;
        let up = view.climber.config().up();
        let level = toward - up * toward.dot(up);
        // If the way can be walked, the climber lets go, so that its stamina refills.
        let walks = stands || can_stand && progress.walks() && view.is_level(PLANNED_REST_SLOPE);
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

    /// Waits until the skin is calm. Lets go if the climber cannot pull itself in.
    pub(super) fn hang(&mut self, view: &View<'_>) -> ClimberInput {
        let seconds = view.seconds;
        let state = view.climber.state();
        let grip = view.climber.config().grip;
        let still = grip.map_or(f64::INFINITY, |grip| {
            SHAKEN_HANG_SHARE * grip.hang_acceleration
        });
        if state.shake.length() > still {
            self.hangs = None;
        }
        let since = *self.hangs.get_or_insert(seconds);
        let is_on_ledge = state.mode == ClimberMode::LedgeHanging;
        let most = if is_on_ledge { LEDGE_HANG_FACTOR } else { 1.0 } * self.config.hangs_for;
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
    pub(super) fn over_ledge(&mut self, view: &View<'_>) -> DVec3 {
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
                SHIMMY_DISTANCE * radius / ledge.shimmy_speed.max(1e-3)
            });
            self.shimmies = (aside * 1f64.copysign(toward), seconds + lasts);
        }
        let (way, until) = self.shimmies;
        if seconds < until { way } else { up }
    }
}
