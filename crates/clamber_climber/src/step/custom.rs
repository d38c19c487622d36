//! Custom modes: modes of the game's own.

use clamber_mover::{Ground, Moved, Mover, MoverBody, MoverContact};
use glam::DVec3;

use super::Tick;
use super::moving::Intent;
use crate::state::CUSTOM_SLOTS;
use crate::{
    ClimberConfig, ClimberEvent, ClimberInput, ClimberMode, ClimberState, ContactRule, Knockback,
};

/// The mode after a handler has run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NextMode {
    /// The mode goes on.
    Stay,
    /// Change to another mode. Its handler runs in the same tick, or in the next one if the body has already moved. A
    /// change to the current mode counts as [`NextMode::Stay`], with [`ClimberEvent::AlreadyInMode`].
    Change(ClimberMode),
}

/// A custom mode: a mode of the game's own, such as a dash, a vault, a wall run or swimming.
///
/// Handlers are given to every [`Climber::step_with`](crate::Climber::step_with), and keep no state of their own. A
/// mode keeps its numbers in [`ModeContext::custom_slots`]. These slots are part of the climber's state, so they are
/// recorded, saved and rolled back with it.
pub trait CustomMode {
    /// Id of the mode, unique among the game's modes. The climber's mode is [`ClimberMode::Custom`] with this id.
    fn id(&self) -> u16;

    /// Whether the mode begins now. If it does, [`CustomMode::step`] runs in the same tick.
    ///
    /// Called once in a tick while the climber is in any other mode, after its support has carried it and before it
    /// moves. Modes are asked in the order in which they are given; after one begins, the rest are not asked in that
    /// tick.
    ///
    /// This is also the place to count down a timer such as a cooldown, kept in [`ModeContext::custom_slots`]. The
    /// timer misses the ticks in which an earlier mode in the list begins. While the mode itself runs, count in
    /// [`CustomMode::step`].
    fn begins(&self, context: &mut ModeContext<'_, '_>) -> bool;

    /// Runs one tick of the mode, and returns the next mode.
    ///
    /// Move the body at most once, by [`ModeContext::move_to`] or [`ModeContext::move_by`]. A second movement is not
    /// refused, but sweeps the body against the obstacles' motion of this tick a second time. Without a movement, the
    /// climber is carried by its support; without a support, it goes on at its velocity.
    fn step(&self, context: &mut ModeContext<'_, '_>) -> NextMode;
}

/// The tick as a custom mode sees it, and the actions that it can take.
pub struct ModeContext<'t, 'a> {
    tick: &'t mut Tick<'a>,
}

impl Tick<'_> {
    /// Starts the first of the game's modes that begins, if one does.
    pub(super) fn start_custom_mode(&mut self) {
        let modes = self.judge.rules.modes;
        for mode in modes {
            let own = ClimberMode::Custom(mode.id());
            if self.state.mode != own && mode.begins(&mut ModeContext { tick: self }) {
                self.change_to(own);
                return;
            }
        }
    }

    pub(super) fn run_custom_mode(&mut self, id: u16) -> NextMode {
        let modes = self.judge.rules.modes;
        match modes.iter().find(|mode| mode.id() == id) {
            Some(mode) => mode.step(&mut ModeContext { tick: self }),
            // A step without this mode's handler ends the mode: the climber falls at its velocity.
            None => ModeContext { tick: self }.let_go(),
        }
    }
}

impl<'a> ModeContext<'_, 'a> {
    /// The player's input.
    pub fn input(&self) -> &ClimberInput {
        self.tick.input
    }

    /// The blow that struck the climber since the last tick.
    pub fn knockback(&self) -> Option<&Knockback> {
        self.tick.judge.rules.knockback.as_ref()
    }

    /// The climber's configuration.
    pub fn config(&self) -> &ClimberConfig {
        self.tick.config
    }

    /// The state at this point of the tick.
    pub fn state(&self) -> &ClimberState {
        self.tick.state
    }

    /// Length of the tick, seconds.
    pub fn dt(&self) -> f64 {
        self.tick.dt()
    }

    /// Unit vector opposite to gravity, in world space; +Y if gravity is zero.
    pub fn up(&self) -> DVec3 {
        self.tick.config.up()
    }

    /// True if the climber's current mode began in this tick.
    pub fn has_entered(&self) -> bool {
        self.tick.has_entered
    }

    /// The numbers that the game's modes remember. All modes share them. After a value that is not finite, the whole
    /// tick is undone and [`ClimberEvent::NotFinite`] is reported.
    pub fn custom_slots(&mut self) -> &mut [f64; CUSTOM_SLOTS] {
        &mut self.tick.state.custom_slots
    }

    /// The body's shape at this point of the tick.
    pub fn body(&self) -> MoverBody {
        self.tick.body()
    }

    /// Queries of the world: casts, overlaps, and probes for ground, grips and ledges.
    pub fn mover(&mut self) -> &mut Mover<'a> {
        &mut self.tick.mover
    }

    /// The climber's position at the tick's end before its own movement, in world space: after the motion of its
    /// support or, without a support, after a tick at [`ModeContext::base_velocity`]. Obstacles are at their positions
    /// of the same time. [`ModeContext::state`] has the position after the movement.
    pub fn position(&self) -> DVec3 {
        let tick = &self.tick;
        match &tick.carried {
            Some(carried) => carried.position,
            None if tick.motion.is_done => tick.state.position,
            None => tick.state.position + tick.state.base_velocity * tick.dt(),
        }
    }

    /// The climber's velocity before its own movement, in world space, metres a second. It is the sum of its support's
    /// velocity and its own, including a blow.
    pub fn velocity(&self) -> DVec3 {
        self.tick.carried_velocity()
    }

    /// Velocity of the climber's support, in world space, metres a second; without a support, velocity of its frame in
    /// the air ([`ClimberState::base_velocity`]). The climber's own motion is measured against it.
    pub fn base_velocity(&self) -> DVec3 {
        let carried = self.tick.carried;
        carried.map_or(self.tick.state.base_velocity, |carried| carried.velocity())
    }

    /// Velocity of the air, in world space, metres a second ([`StepRules::air_velocity`](crate::StepRules)).
    pub fn air_velocity(&self) -> DVec3 {
        self.tick.judge.rules.air_velocity
    }

    /// Sets the velocity that the climber's own motion is measured against from now on, in world space, metres a
    /// second, for example the velocity of water. The call counts as a touch: without a later touch, the velocity
    /// changes to the air's between one and two seconds after this call. While the climber has a support, the support's
    /// velocity is used instead, and replaces this one.
    pub fn set_base_velocity(&mut self, velocity: DVec3) {
        self.tick.state.base_velocity = velocity;
        self.tick.state.untouched = 0.0;
    }

    /// Sweeps the body to `target`, a position in world space at the tick's end, and returns the result.
    ///
    /// `velocity` is the velocity that the climber would have without contacts, in world space, metres a second. The
    /// state gets this velocity, clipped by the contacts. A support is kept.
    pub fn move_to(&mut self, target: DVec3, velocity: DVec3) -> Moved {
        let path = self.tick.path(target);
        let moved = self.tick.slide(&path, Intent::Go);
        if let Some(carried) = self.tick.carried {
            self.tick.keep_support(&carried, moved.position);
        }
        self.tick.state.position = moved.position;
        self.tick.state.velocity = self.tick.clipped_after_hits(velocity);
        moved
    }

    /// [`ModeContext::move_to`] for one tick at a velocity in world space, metres a second, the support's velocity
    /// included.
    pub fn move_by(&mut self, velocity: DVec3) -> Moved {
        // The position already includes the motion by the support.
        let own = velocity - self.base_velocity();
        self.move_to(self.position() + own * self.dt(), velocity)
    }

    /// Contacts of the last movement.
    pub fn touched(&self) -> &[MoverContact] {
        self.tick.mover.touched()
    }

    /// Ground up to `reach` metres below the climber's feet, at its position after its movement, or before it if it has
    /// not moved yet. `None` if no ground is found, or the ground reports no motion.
    pub fn ground_below(&mut self, reach: f64) -> Option<Ground> {
        let position = self.here();
        self.tick.ground_below(position, reach)
    }

    fn here(&self) -> DVec3 {
        if self.tick.motion.is_done {
            self.tick.state.position
        } else {
            self.position()
        }
    }

    /// Ground among the contacts of the last movement, if one of them holds the climber up.
    pub fn held_up(&mut self) -> Option<Ground> {
        let slope = self.tick.config.ground.max_slope;
        let position = self.tick.state.position;
        self.tick.held_up(position, slope)
    }

    /// The rule for a contact: whether it may be stood on, gripped and so on
    /// ([`StepRules::contact`](crate::StepRules)). [`ModeContext::mover`] does not find contacts that are not solid.
    /// The mode itself has to keep the rest of the rule.
    pub fn rule(&self, touch: &MoverContact) -> ContactRule {
        self.tick.judge.rule_of(touch)
    }

    /// Attaches the climber to a contact, for example on a wall that it runs along. The contact carries it from now on.
    /// Call it before a change to a mode that needs a support.
    pub fn attach(&mut self, touch: &MoverContact) {
        let place = self.here();
        self.tick.attach(touch, place);
    }

    /// Attaches the climber to ground and puts it there, without a change of mode.
    pub fn attach_to_ground(&mut self, ground: &Ground) {
        self.tick.state.position = ground.position;
        self.tick.attach(&ground.touch, ground.position);
    }

    /// Attaches the climber to ground, and puts it there without a sweep. Return the result from [`CustomMode::step`]
    /// to stand. If `step` returns another value, the climber is only attached, as by
    /// [`ModeContext::attach_to_ground`].
    pub fn stand_on(&mut self, ground: &Ground) -> NextMode {
        self.attach_to_ground(ground);
        NextMode::Change(ClimberMode::Standing)
    }

    /// Drops the support and sets the velocity, in world space, metres a second. Return the result from
    /// [`CustomMode::step`] to fall.
    pub fn fall(&mut self, velocity: DVec3) -> NextMode {
        self.tick.state.velocity = velocity;
        self.tick.leave(ClimberMode::Falling)
    }

    /// [`ModeContext::fall`] with the climber's current velocity.
    pub fn let_go(&mut self) -> NextMode {
        self.detach();
        NextMode::Change(ClimberMode::Falling)
    }

    /// Drops the support, and keeps the mode and the climber's current velocity.
    pub fn detach(&mut self) {
        let moved = self.tick.motion.is_done;
        let velocity = if moved {
            self.tick.state.velocity
        } else {
            self.velocity()
        };
        self.tick.detach();
        self.tick.state.velocity = velocity;
    }

    /// Turns the climber to face the level component of a direction. No change if that is zero.
    pub fn face(&mut self, direction: DVec3) {
        self.tick.face(direction);
    }

    /// Reports [`ClimberEvent::Custom`]. `mode` is the id of the reporting mode, which may differ from the climber's
    /// current mode: [`CustomMode::begins`] is called in other modes.
    pub fn report(&mut self, mode: u16, what: u32, value: f64) {
        self.tick.event(ClimberEvent::Custom { mode, what, value });
    }
}
