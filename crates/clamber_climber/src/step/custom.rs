//! Modes of a game's own.

use clamber_mover::{Ground, Moved, Mover, MoverBody, Touch};
use glam::DVec3;

use super::Tick;
use super::moving::Intent;
use crate::state::MEMORY;
use crate::{ClimberConfig, ClimberEvent, ClimberInput, ClimberMode, ClimberState};

/// What a mode's handler answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NextMode {
    /// The mode stays.
    Stay,
    /// Another mode comes next: in the same tick, unless the body has made its movement.
    Change(ClimberMode),
}

/// A mode of a game's own: a dash, a vault, a wall run, swimming.
///
/// Handlers are given to [`Climber::step_with`](crate::Climber::step_with) with every step. They keep nothing: what a mode
/// remembers is in [`ModeContext::memory`], which is part of the climber's state, so that it is recorded, saved and
/// rolled back with it.
pub trait CustomMode {
    /// Its number: the climber is in [`ClimberMode::Custom`] of it. No two modes of a game have the same.
    fn id(&self) -> u16;

    /// Whether the mode begins now. Asked in ticks in which the climber is in another mode, after its support has carried
    /// it and before it moves; modes are asked in the order in which they are given, and those after one that begins are
    /// not asked in that tick. Also the place to count down a timer such as a cooldown; while the mode itself runs,
    /// [`CustomMode::step`] is.
    fn begins(&self, context: &mut ModeContext<'_, '_>) -> bool;

    /// One tick of the mode: moves the body at most once, by one of the context's movements, and says what comes next.
    /// A tick without a movement leaves the climber to its support, or to its velocity.
    fn step(&self, context: &mut ModeContext<'_, '_>) -> NextMode;
}

/// What a mode of a game's own sees of a tick, and can do in it.
pub struct ModeContext<'t, 'a> {
    tick: &'t mut Tick<'a>,
}

impl Tick<'_> {
    /// Asks the game's modes whether one of them begins.
    pub(super) fn start_custom_mode(&mut self) {
        let modes = self.rules.modes;
        for mode in modes {
            let own = ClimberMode::Custom(mode.id());
            if self.state.mode != own && mode.begins(&mut ModeContext { tick: self }) {
                self.change_to(own);
                return;
            }
        }
    }

    pub(super) fn run_custom_mode(&mut self, id: u16) -> NextMode {
        let modes = self.rules.modes;
        match modes.iter().find(|mode| mode.id() == id) {
            Some(mode) => mode.step(&mut ModeContext { tick: self }),
            // A step without the handler knows no such mode: the climber goes on through the air as fast as it was.
            None => ModeContext { tick: self }.let_go(),
        }
    }
}

impl<'a> ModeContext<'_, 'a> {
    /// What the player wants.
    pub fn input(&self) -> &ClimberInput {
        self.tick.input
    }

    /// The climber's configuration.
    pub fn config(&self) -> &ClimberConfig {
        self.tick.config
    }

    /// The state as it is at this point of the tick.
    pub fn state(&self) -> &ClimberState {
        &self.tick.state
    }

    /// Length of the tick, seconds.
    pub fn dt(&self) -> f64 {
        self.tick.dt()
    }

    /// Unit vector, against gravity.
    pub fn up(&self) -> DVec3 {
        self.tick.config.up()
    }

    /// The mode began in this tick.
    pub fn has_entered(&self) -> bool {
        self.tick.has_entered
    }

    /// The numbers that a game's modes remember; all modes share them. A value that is not finite ends the tick with
    /// [`ClimberEvent::NotFinite`], and nothing happens.
    pub fn memory(&mut self) -> &mut [f64; MEMORY] {
        &mut self.tick.state.memory
    }

    /// The shape that is moved.
    pub fn body(&self) -> MoverBody {
        self.tick.body()
    }

    /// The world: casts, overlaps, probes for ground, grips and ledges.
    pub fn mover(&mut self) -> &mut Mover<'a> {
        &mut self.tick.mover
    }

    /// Where the climber is before its own movement, in world space, as of the tick's end: where its support has carried
    /// it, else where [`ModeContext::base_velocity`] has. Obstacles stand there at that time, too. What it is after its
    /// movement is in [`ModeContext::state`].
    pub fn position(&self) -> DVec3 {
        let tick = &self.tick;
        match &tick.carried {
            Some(carried) => carried.position,
            None if tick.has_moved => tick.state.position,
            None => tick.state.position + tick.state.base_velocity * tick.dt(),
        }
    }

    /// Its velocity before its own movement, in world space, metres a second, a blow included: of its support, and its own.
    pub fn velocity(&self) -> DVec3 {
        let tick = &self.tick;
        match &tick.carried {
            Some(carried) => carried.velocity() + tick.own_velocity(),
            None => tick.state.velocity,
        }
    }

    /// Velocity of what supports it, or supported it last: what its own motion is measured against.
    pub fn base_velocity(&self) -> DVec3 {
        let carried = self.tick.carried;
        carried.map_or(self.tick.state.base_velocity, |carried| carried.velocity())
    }

    /// Measures its own motion against another velocity from now on, in world space, metres a second: of the water that
    /// it swims in, of the wind. A support that it has, or gets, counts in its place.
    pub fn set_base_velocity(&mut self, velocity: DVec3) {
        self.tick.state.base_velocity = velocity;
    }

    /// Sweeps the body to a target at the tick's end, in world space, and says where it came. `velocity` is what it
    /// meant to have, in world space; it keeps what the contacts let it. A climber with a support keeps that.
    pub fn move_to(&mut self, target: DVec3, velocity: DVec3) -> Moved {
        let path = self.tick.path(target);
        let moved = self.tick.slide(&path, Intent::Go);
        if let Some(carried) = self.tick.carried {
            self.tick.keep_support(&carried, moved.position);
        }
        self.tick.state.position = moved.position;
        self.tick.state.velocity = self.tick.clipped(velocity);
        moved
    }

    /// [`ModeContext::move_to`] where a velocity leads in this tick: in world space, that of the support included.
    pub fn move_by(&mut self, velocity: DVec3) -> Moved {
        // Where it is carried is in the position already.
        let own = velocity - self.base_velocity();
        self.move_to(self.position() + own * self.dt(), velocity)
    }

    /// What the last movement touched.
    pub fn touched(&self) -> &[Touch] {
        self.tick.mover.touched()
    }

    /// Ground below the climber, up to `reach` metres below its feet: where its movement has led, else where it is before
    /// that.
    pub fn ground_below(&mut self, reach: f64) -> Option<Ground> {
        let position = self.here();
        self.tick.ground_below(position, reach)
    }

    fn here(&self) -> DVec3 {
        if self.tick.has_moved {
            self.tick.state.position
        } else {
            self.position()
        }
    }

    /// The contact of the last movement that holds the climber up, if one does.
    pub fn held_up(&mut self) -> Option<Ground> {
        let slope = self.tick.config.ground.max_slope;
        let position = self.tick.state.position;
        self.tick.held_up(position, slope)
    }

    /// Attaches the climber to a contact, which carries it from now on: to a wall that it runs along, or before it stands
    /// or holds.
    pub fn attach(&mut self, touch: &Touch) {
        let place = self.here();
        self.tick.attach(touch, place);
    }

    /// Attaches the climber to ground and puts it there, in the mode that it is in.
    pub fn attach_to_ground(&mut self, ground: &Ground) {
        self.tick.state.position = ground.position;
        self.tick.attach(&ground.touch, ground.position);
    }

    /// Attaches the climber to ground and puts it there; answer with this to stand.
    pub fn stand_on(&mut self, ground: &Ground) -> NextMode {
        self.attach_to_ground(ground);
        NextMode::Change(ClimberMode::Standing)
    }

    /// Lets go of what supports the climber; answer with this to fall, with a velocity in world space.
    pub fn fall(&mut self, velocity: DVec3) -> NextMode {
        self.tick.state.velocity = velocity;
        self.tick.leave(ClimberMode::Falling)
    }

    /// [`ModeContext::fall`] with the velocity that it has.
    pub fn let_go(&mut self) -> NextMode {
        self.detach();
        NextMode::Change(ClimberMode::Falling)
    }

    /// Lets go of what supports the climber, and goes on in this mode, with the velocity that it has.
    pub fn detach(&mut self) {
        let moved = self.tick.has_moved;
        let velocity = if moved {
            self.tick.state.velocity
        } else {
            self.velocity()
        };
        self.tick.detach();
        self.tick.state.velocity = velocity;
    }

    /// Turns the climber to face a direction, as far as it is level.
    pub fn face(&mut self, direction: DVec3) {
        self.tick.face(direction);
    }

    /// Reports [`ClimberEvent::Custom`]. `mode` is the number of the mode that reports: [`CustomMode::begins`] runs while
    /// the climber is in another one.
    pub fn report(&mut self, mode: u16, what: u32, value: f64) {
        self.tick.event(ClimberEvent::Custom { mode, what, value });
    }
}
