//! One tick, in this order: blow, timers, carrying by the support, modes until one of them has moved the body, standing
//! up, stamina, weight on the support, contacts.
//!
//! [`Tick::run`] reads the same way. Each mode has a handler, which returns whether the mode stays or which mode comes
//! next. One bounded loop runs the handlers; no handler calls another.

mod air;
mod carrying;
mod custom;
mod effort;
mod flying;
mod friends;
mod ground;
mod hanging;
mod hitting;
mod holding;
mod judge;
mod ledge;
mod moving;
mod pushing;
mod standing;

pub use custom::{CustomMode, ModeContext, NextMode};
pub(crate) use flying::slow_speed;
pub use flying::{FlyingMemory, TumblingMemory};
pub(crate) use friends::among_others;
pub use hanging::HangingMemory;
pub use holding::HoldingMemory;
pub(crate) use judge::Judge;
pub use ledge::LedgeHangingMemory;
pub use standing::StandingMemory;

use clamber_mover::{ContactFilters, Mover, MoverBody, MoverMemory};
use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;

use crate::{
    ClimberConfig, ClimberContact, ClimberError, ClimberEvent, ClimberInput, ClimberMode,
    ClimberState, ContactRule, StepReport,
};
pub(crate) use carrying::CONTINUOUS_GAP;
use carrying::Carried;

/// Maximum number of mode changes in a tick. Further changes follow in the next tick.
const MOST_CHANGES: u32 = 4;

/// Smallest level part of a direction, as a fraction of its length, for the climber to turn to it. A smaller part is
/// rounding, for example of the normal of level skin.
const LEAST_LEVEL_PART: f64 = 1e-6;

/// Memory that a climber reuses from tick to tick. Only the contacts of the last tick are read later.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    mover: MoverMemory,
    pub(crate) contacts: Vec<ClimberContact>,
}

impl Scratch {
    pub(crate) fn mover_memory(&mut self) -> &mut MoverMemory {
        &mut self.mover
    }
}

/// Number of contacts for which memory is reserved from the first tick on.
const RESERVED_CONTACTS: usize = 64;

/// The arguments of a tick.
#[derive(Clone, Copy)]
pub(crate) struct Asked<'a> {
    pub(crate) input: &'a ClimberInput,
    pub(crate) judge: Judge<'a>,
    pub(crate) filters: ContactFilters<'a>,
    pub(crate) obstacles: &'a [(ObstacleId, &'a dyn Obstacle)],
    /// Length of the tick, seconds.
    pub(crate) dt: f64,
}

/// One tick of one climber: the data that its phases read and write.
pub(crate) struct Tick<'a> {
    config: &'a ClimberConfig,
    input: &'a ClimberInput,
    judge: Judge<'a>,
    obstacles: &'a [(ObstacleId, &'a dyn Obstacle)],
    state: &'a mut ClimberState,
    mover: Mover<'a>,
    report: StepReport,
    contacts: &'a mut Vec<ClimberContact>,
    before: Before,
    motion: Motion,
    /// Position to which the support, or the velocity in the air, takes the climber in this tick.
    expected: DVec3,
    /// Displacement by which the climber gives way to climbers that it overlaps.
    parting: DVec3,
    /// Velocity at which the climber's own momentum is the same as before: a difference from it has a reaction on the
    /// support.
    rides: DVec3,
    /// Velocity of a blow that does not end the mode by itself: the climber stays on its feet or its hold. Zero without
    /// such a blow.
    struck: DVec3,
    /// How the support has carried the climber in this tick.
    carried: Option<Carried>,
    /// The rule for the support that has carried the climber. Without a support, everything is allowed.
    on: ContactRule,
    /// Distance by which the arms have drawn the body upwards in this tick, metres.
    drawn_up: f64,
    /// Change of the support's velocity since the last tick, beyond the change by the climber's own recoil; `None` if
    /// it is not known.
    support_change: Option<DVec3>,
    /// Impulse of the arms on the body, if the climber hangs by them.
    pull: Option<DVec3>,
    /// True if the current mode began in this tick.
    has_entered: bool,
}

/// The climber's shape in a state.
pub(crate) fn body(config: &ClimberConfig, state: &ClimberState) -> MoverBody {
    let is_upright = !state.mode.is_holding() && !state.crouched;
    let height = if is_upright { config.body.height } else { 0.0 };
    MoverBody::capsule(config.up() * height, config.body.radius, config.body.margin)
}

/// The climber at the tick's beginning.
#[derive(Clone, Copy, Debug)]
struct Before {
    position: DVec3,
    /// Velocity, including a blow.
    velocity: DVec3,
    /// Velocity of the support, or of the frame in the air.
    base_velocity: DVec3,
    /// True if the climber was crushed in the last tick.
    crushed: bool,
    /// Displacement by which contacts changed the climber's way in the last tick, if it had no support and touched an
    /// obstacle then; otherwise zero.
    pressed: DVec3,
}

/// The body's own movement in this tick.
#[derive(Clone, Copy, Debug, Default)]
struct Motion {
    /// True if the target of a movement was not finite.
    is_lost: bool,
    /// True if the body has made its movement.
    is_done: bool,
    /// True if this movement was through the air.
    has_flown: bool,
    /// Change of the climber's velocity by the hits of the last movement. Zero if it hit no obstacle that gives way.
    recoil: DVec3,
    /// Velocity that this movement would have had without contacts.
    wanted: DVec3,
    /// Velocity of the movement through the air before contacts clipped it.
    flew_at: Option<DVec3>,
}

impl<'a> Tick<'a> {
    // Inlined, since a tick is large and would be copied.
    #[inline]
    pub(crate) fn new(
        config: &'a ClimberConfig,
        state: &'a mut ClimberState,
        asked: Asked<'a>,
        scratch: &'a mut Scratch,
    ) -> Result<Self, ClimberError> {
        let Asked {
            input,
            judge,
            filters,
            obstacles,
            dt,
        } = asked;
        input.validate()?;
        let mover = Mover::new(obstacles, dt, &mut scratch.mover)?
            .with_filters(filters)
            .with_character(among_others(config));
        let pressed = if state.support.is_none() && state.untouched == 0.0 {
            state.own_way
        } else {
            DVec3::ZERO
        };
        scratch.contacts.clear();
        scratch.contacts.reserve(RESERVED_CONTACTS);
        Ok(Self {
            config,
            input,
            judge,
            obstacles,
            mover,
            report: StepReport {
                is_clear: true,
                ..StepReport::default()
            },
            contacts: &mut scratch.contacts,
            before: Before {
                position: state.position,
                velocity: state.velocity,
                base_velocity: state.base_velocity,
                crushed: state.crushed,
                pressed,
            },
            motion: Motion::default(),
            expected: state.position + state.own_displacement(config, dt),
            parting: DVec3::ZERO,
            rides: state.velocity,
            state,
            struck: DVec3::ZERO,
            carried: None,
            on: ContactRule::GRIP,
            drawn_up: 0.0,
            support_change: None,
            pull: None,
            has_entered: false,
        })
    }

    /// Brings the state to the end of the tick. `None` if the state is not finite then.
    pub(crate) fn run(&mut self) -> Option<StepReport> {
        let shake = self.state.shake;
        self.be_struck();
        self.count_down();
        self.be_carried();
        if let Some(carried) = &self.carried {
            self.expected = carried.position;
        }
        self.parting = self.parting();
        self.rides = self.carried_velocity();
        self.run_modes();
        self.stand_up();
        self.update_stamina(shake);
        self.weigh_down();
        self.list_support();
        self.state.own_way = self.state.position - self.expected;
        let is_sound = !self.motion.is_lost && self.state.is_finite();
        is_sound.then(|| std::mem::take(&mut self.report))
    }

    /// Counts down the timers of late jumps, early jumps and open hands.
    fn count_down(&mut self) {
        let dt = self.dt();
        let ground = &self.config.ground;
        self.state.coyote = if self.state.mode == ClimberMode::Standing {
            ground.coyote_time
        } else {
            (self.state.coyote - dt).max(0.0)
        };
        self.state.jump_buffer = if self.input.jump {
            ground.jump_buffer.max(dt)
        } else {
            (self.state.jump_buffer - dt).max(0.0)
        };
        self.state.grip_cooldown = (self.state.grip_cooldown - dt).max(0.0);
    }

    /// Runs handlers until a mode stays or the body has been moved.
    fn run_modes(&mut self) {
        self.start_custom_mode();
        for _ in 0..MOST_CHANGES {
            let next = match self.state.mode {
                ClimberMode::Standing => self.stand(),
                ClimberMode::Holding => self.hold(),
                ClimberMode::Hanging => self.hang(),
                ClimberMode::LedgeHanging => self.hang_from_ledge(),
                ClimberMode::Sliding | ClimberMode::Falling => self.fly(),
                ClimberMode::Tumbling => self.tumble(),
                ClimberMode::Custom(id) => self.run_custom_mode(id),
            };
            let NextMode::Change(mode) = next else {
                break;
            };
            if mode == self.state.mode {
                // Otherwise the handler would run again and again.
                self.event(ClimberEvent::AlreadyInMode { mode });
                break;
            }
            let is_last = self.report.mode_changes + 1 >= MOST_CHANGES;
            self.change_to(mode);
            if self.motion.is_done {
                break;
            }
            if is_last {
                self.report.changes_left = true;
                break;
            }
        }
        if !self.motion.is_done {
            self.coast();
        }
        self.keep_consistent();
    }

    /// Changes the mode.
    fn change_to(&mut self, mode: ClimberMode) {
        let from = self.state.mode;
        if mode != from {
            debug_assert!(from.may_become(mode), "{from:?} became {mode:?}");
            self.state.mode = mode;
            self.forget(from);
            self.has_entered = true;
            self.report.mode_changes += 1;
            self.event(ClimberEvent::Changed { from, to: mode });
        }
    }

    /// Clears the memory of the mode that was left.
    fn forget(&mut self, left: ClimberMode) {
        let state = &mut *self.state;
        match left {
            ClimberMode::Standing => state.standing = StandingMemory::default(),
            ClimberMode::Hanging => state.hanging = HangingMemory::default(),
            ClimberMode::LedgeHanging => state.ledge_hanging = LedgeHangingMemory::default(),
            ClimberMode::Tumbling => state.tumbling = TumblingMemory::default(),
            ClimberMode::Falling | ClimberMode::Sliding => {
                let flies_on = matches!(state.mode, ClimberMode::Falling | ClimberMode::Sliding);
                state.flying.jumping &= flies_on;
            }
            ClimberMode::Holding => state.holding = HoldingMemory::default(),
            ClimberMode::Custom(_) => {}
        }
    }

    /// Makes `support` consistent with `mode`, which a custom mode may have left inconsistent: a mode that needs a
    /// support falls without one, and the other modes of this crate drop theirs.
    fn keep_consistent(&mut self) {
        let mode = self.state.mode;
        if mode.is_supported() && self.state.support.is_none() {
            self.change_to(ClimberMode::Falling);
        } else if !mode.is_supported() && !mode.is_custom() && self.state.support.is_some() {
            self.detach();
        }
    }

    /// Crouches while the climber holds on or is asked to crouch, and stands up where there is room.
    fn stand_up(&mut self) {
        let height = self.config.body.height;
        if height == 0.0 {
            return;
        }
        if self.state.mode.is_holding() || self.input.crouch {
            self.state.crouched = true;
        } else if self.state.crouched {
            let up = self.config.up();
            let ball = self.body().crouched().core_at(self.state.position);
            self.state.crouched = !self.mover.is_free(&ball, up * height);
        }
    }

    fn dt(&self) -> f64 {
        self.mover.dt()
    }

    fn body(&self) -> MoverBody {
        body(self.config, self.state)
    }

    fn event(&mut self, event: ClimberEvent) {
        self.report.events.push(event);
    }

    /// Turns to face the level component of a direction; no change if that component is mere rounding.
    fn face(&mut self, direction: DVec3) {
        let up = self.config.up();
        let level = direction - up * direction.dot(up);
        if level.length() > LEAST_LEVEL_PART * direction.length() {
            self.state.heading = level.normalize_or(self.state.heading);
        }
    }
}

#[cfg(test)]
mod tests;
