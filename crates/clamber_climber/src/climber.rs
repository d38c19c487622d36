use std::cell::OnceCell;

use clamber_mover::ContactFilters;
use clamber_world::{Contact, Obstacle, ObstacleId, WorldCapsule};
use glam::DVec3;

use crate::step::{Asked, Judge, Scratch, Tick};
use crate::{
    ClimberConfig, ClimberContact, ClimberError, ClimberEvent, ClimberInput, ClimberMode,
    ClimberState, ContactRuleFn, CustomMode, Knockback, StepReport,
};

/// A game's own rules for a step, passed to [`Climber::step_with`].
#[derive(Clone, Copy, Default)]
pub struct StepRules<'a> {
    /// Decides which contacts may be stood on, stepped onto, hung from, gripped, and passed through, and with which
    /// friction. By default [`ContactQuery::usual`](crate::ContactQuery::usual).
    pub contact: Option<&'a ContactRuleFn<'a>>,
    /// Handlers of the game's custom modes. In each tick, every handler but the current mode's is asked, in this order,
    /// whether its mode begins, until one does. A climber in a custom mode whose handler is missing falls. By default
    /// none.
    pub modes: &'a [&'a dyn CustomMode],
    /// Velocity of the air, in world space, metres a second, for example of wind. A climber that has touched nothing
    /// for a second takes it as its frame ([`ClimberState::base_velocity`]): steering in the air is measured against
    /// it. The terminal speed is always measured against it. It does not move a climber that does not steer: for a wind
    /// that pushes, use a [`Knockback`] in each tick, as in the [guide](crate::guide#ground-that-moves). By
    /// default zero.
    pub air_velocity: DVec3,
    /// The blow that struck the climber since the last tick. By default none.
    pub knockback: Option<Knockback>,
    /// Id of this climber among the obstacles of others ([`ClimberGroup`](crate::ClimberGroup)). If two climbers are at
    /// one place, their ids decide to which side each parts; without ids they stay there. `contact` gets the id with
    /// each query, so that one rule can tell climbers apart. By default `None`.
    pub id: Option<ObstacleId>,
}

impl<'a> StepRules<'a> {
    /// Checks the rules as each step does. A game that steps several climbers with the same rules can so refuse them
    /// before the first step.
    ///
    /// # Errors
    /// [`ClimberError::SameMode`] if two of the modes have the same id, [`ClimberError::NotFinite`] if the air's
    /// velocity or a number of the knockback is not finite, and [`ClimberError::OutOfRange`] if the knockback's damage is
    /// not from 0 to 1.
    pub fn check(&self) -> Result<(), ClimberError> {
        for (index, mode) in self.modes.iter().enumerate() {
            let mut before = self.modes[..index].iter();
            if before.any(|other| other.id() == mode.id()) {
                return Err(ClimberError::SameMode(mode.id()));
            }
        }
        if !self.air_velocity.is_finite() {
            return Err(ClimberError::NotFinite("air_velocity"));
        }
        self.knockback.as_ref().map_or(Ok(()), Knockback::check)
    }

    /// Rules with a function that decides about contacts, without custom modes.
    pub const fn by(contact: &'a ContactRuleFn<'a>) -> Self {
        Self {
            contact: Some(contact),
            modes: &[],
            air_velocity: DVec3::ZERO,
            knockback: None,
            id: None,
        }
    }

    /// Rules with custom modes, and the usual rule for contacts.
    pub fn with_modes(modes: &'a [&'a dyn CustomMode]) -> Self {
        Self {
            modes,
            ..Self::default()
        }
    }
}

/// A kinematic character: its configuration, its state, and the contacts of its last step.
#[derive(Clone, Debug)]
pub struct Climber {
    config: ClimberConfig,
    state: ClimberState,
    /// Memory that is reused from step to step. Holds the contacts of the last step.
    scratch: Scratch,
}

impl Climber {
    /// A climber at rest in the air. `position` is the centre of its ball, in world space.
    ///
    /// # Errors
    /// [`ClimberError`] for a configuration outside its ranges or a position that is not finite.
    pub fn new(config: ClimberConfig, position: DVec3) -> Result<Self, ClimberError> {
        config.validate()?;
        if !position.is_finite() {
            return Err(ClimberError::NotFinite("position"));
        }
        Ok(Self {
            config,
            state: ClimberState::new(position, config.up()),
            scratch: Scratch::default(),
        })
    }

    /// The configuration.
    pub fn config(&self) -> &ClimberConfig {
        &self.config
    }

    /// Replaces the configuration: another gravity, a faster walk, a mode switched on or off.
    ///
    /// The state stays, except that the heading is made level with the new up. In the next step, a body that has grown
    /// is pushed out of the obstacles that it overlaps; [`Climber::try_resize`] lets it grow only where it has room.
    ///
    /// # Errors
    /// [`ClimberError`] for a configuration outside its ranges, and [`ClimberError::ModeInUse`] for one that switches
    /// off the climber's current mode. The climber is unchanged then.
    pub fn set_config(&mut self, config: ClimberConfig) -> Result<(), ClimberError> {
        config.validate()?;
        let mode = self.state.mode;
        let is_missing = match mode {
            ClimberMode::Holding | ClimberMode::Hanging => config.grip.is_none(),
            ClimberMode::LedgeHanging => config.ledge.is_none(),
            ClimberMode::Tumbling => config.tumble.is_none(),
            _ => false,
        };
        if is_missing {
            return Err(ClimberError::ModeInUse(mode));
        }
        let up = config.up();
        let heading = self.state.heading;
        let level = heading - up * heading.dot(up);
        self.state.heading = level.normalize_or(up.any_orthonormal_vector());
        self.config = config;
        Ok(())
    }

    /// Sets a state that is known to be valid.
    pub(crate) fn replace_state(&mut self, state: ClimberState) {
        self.state = state;
    }

    pub(crate) fn mover_memory(&mut self) -> &mut clamber_mover::MoverMemory {
        self.scratch.mover_memory()
    }

    /// The state after the last step.
    pub fn state(&self) -> &ClimberState {
        &self.state
    }

    /// Contacts of the last step: first the contacts of its movements, in the order in which they were found, then its
    /// support. Empty before the first step and after [`Climber::restore`].
    pub fn contacts(&self) -> &[ClimberContact] {
        &self.scratch.contacts
    }

    /// The body's capsule after the last step, in world space, margin included.
    pub fn body(&self) -> WorldCapsule {
        crate::step::body(&self.config, &self.state).at(self.state.position)
    }

    /// Sets the state to a state from this or another run.
    ///
    /// # Errors
    /// [`ClimberError::NotFinite`] if the state is not finite. [`ClimberError::Support`] if it stands, grips or hangs
    /// without a support, or has a support in another mode of this crate. [`ClimberError::OutOfRange`] if stamina, hit
    /// points or the progress of a pull-up are not from 0 to 1, a length or time is negative, or the heading is not a
    /// unit vector. The climber is unchanged then.
    pub fn restore(&mut self, state: ClimberState) -> Result<(), ClimberError> {
        state.validate()?;
        self.state = state;
        self.scratch.contacts.clear();
        Ok(())
    }

    /// Steps the climber by one tick of `dt` seconds. Fur can be gripped.
    ///
    /// Pose and move obstacles first: the step expects them where they are at the tick's end. They may come in any
    /// order. If two have the same id, the first counts.
    ///
    /// # Errors
    /// [`ClimberError`] if `dt` is not positive and finite, or the input is not finite. The climber is unchanged then.
    pub fn step(
        &mut self,
        input: &ClimberInput,
        obstacles: &[(ObstacleId, &dyn Obstacle)],
        dt: f64,
    ) -> Result<StepReport, ClimberError> {
        self.step_with(input, obstacles, &StepRules::default(), dt)
    }

    /// [`Climber::step`] with a game's own rules for contacts, its custom modes, and the blow that struck the climber.
    ///
    /// # Errors
    /// As [`Climber::step`] and [`StepRules::check`].
    pub fn step_with(
        &mut self,
        input: &ClimberInput,
        obstacles: &[(ObstacleId, &dyn Obstacle)],
        rules: &StepRules<'_>,
        dt: f64,
    ) -> Result<StepReport, ClimberError> {
        rules.check()?;
        let judge = Judge {
            rules,
            config: &self.config,
            state: &self.state,
            obstacles,
            dt,
        };
        let rule =
            |id: ObstacleId, of: &dyn Obstacle, contact: &Contact| judge.rule(id, of, contact);
        let is_solid = |id: ObstacleId, of: &dyn Obstacle, at: &Contact| rule(id, of, at).solid;
        let is_ground = |id: ObstacleId, of: &dyn Obstacle, at: &Contact| rule(id, of, at).stand;
        let has_rule = rules.contact.is_some();
        // Evaluated at the first query only: few ticks query steps.
        let keeps_off = OnceCell::new();
        let is_step = |id: ObstacleId, of: &dyn Obstacle, at: &Contact| {
            !*keeps_off.get_or_init(|| judge.keeps_off_curbs()) || rule(id, of, at).step
        };
        let filters = if has_rule {
            ContactFilters {
                solid: Some(&is_solid),
                ground: Some(&is_ground),
                step: Some(&is_step),
            }
        } else {
            ContactFilters::default()
        };
        let asked = Asked {
            input,
            judge,
            filters,
            obstacles,
            dt,
        };
        // A copy, so that the climber is unchanged if the tick is refused, or if an obstacle panics.
        let mut state = self.state;
        let mut tick = Tick::new(&self.config, &mut state, asked, &mut self.scratch)?;
        let Some(report) = tick.run() else {
            // An obstacle of the game's own may return numbers that are not finite. The climber then waits where it is.
            self.scratch.contacts.clear();
            return Ok(StepReport {
                events: vec![ClimberEvent::NotFinite],
                ..StepReport::default()
            });
        };
        self.state = state;
        Ok(report)
    }
}
