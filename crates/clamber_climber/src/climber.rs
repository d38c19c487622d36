use clamber_world::{Contact, Obstacle, ObstacleId, SurfaceTag, WorldCapsule};
use glam::DVec3;

use crate::step::{Asked, Scratch, Tick};
use crate::{
    ClimberConfig, ClimberContact, ClimberError, ClimberInput, ClimberMode, ClimberState,
    CustomMode, StepReport,
};

/// Whether a climber may grip something, and hold on to it.
pub type CanGrip<'a> = dyn Fn(ObstacleId, &Contact) -> bool + 'a;

/// What a game adds to a step: [`Climber::step_with`].
#[derive(Clone, Copy)]
pub struct StepRules<'a> {
    /// What can be gripped. Fur, unless said otherwise.
    pub can_grip: &'a CanGrip<'a>,
    /// Handlers of the game's own modes, in the order in which they are asked whether they begin. None, unless given.
    pub modes: &'a [&'a dyn CustomMode],
}

impl<'a> StepRules<'a> {
    /// Grips what a function says can be gripped.
    pub const fn gripping(can_grip: &'a CanGrip<'a>) -> Self {
        Self {
            can_grip,
            modes: &[],
        }
    }

    /// Grips fur, and has modes of its own.
    pub fn with_modes(modes: &'a [&'a dyn CustomMode]) -> Self {
        Self {
            modes,
            ..Self::default()
        }
    }
}

impl Default for StepRules<'_> {
    fn default() -> Self {
        Self {
            can_grip: &|_, contact| is_fur(&contact.tag),
            modes: &[],
        }
    }
}

/// A kinematic character: configuration, state, and the memory that a step needs.
#[derive(Clone, Debug)]
pub struct Climber {
    config: ClimberConfig,
    state: ClimberState,
    /// Kept for its memory; holds the contacts of the last step.
    scratch: Scratch,
}

impl Climber {
    /// A climber in the air, the centre of its ball at `position`, in world space, at rest.
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

    /// Its configuration.
    pub fn config(&self) -> &ClimberConfig {
        &self.config
    }

    /// Changes the configuration: another gravity, a faster walk, a mode switched on or off. The state stays; a body that
    /// has grown is pushed out of what it overlaps in the next step.
    ///
    /// # Errors
    /// [`ClimberError`] for a configuration outside its ranges, and [`ClimberError::ModeInUse`] for one without the mode
    /// that the climber is in. Nothing is changed then.
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

    /// Its state after the last step.
    pub fn state(&self) -> &ClimberState {
        &self.state
    }

    /// What touched it in the last step: first what was met on the way, in the order in which it was met, then its
    /// support. Empty before the first step and after [`Climber::restore`].
    pub fn contacts(&self) -> &[ClimberContact] {
        &self.scratch.contacts
    }

    /// What it is to the world: where it stands after the last step.
    pub fn body(&self) -> WorldCapsule {
        crate::step::body(&self.config, &self.state).at(self.state.position)
    }

    /// Puts it back into a state, of this or another run.
    ///
    /// # Errors
    /// [`ClimberError::NotFinite`] if the state is not finite, [`ClimberError::Support`] if it stands, holds or hangs
    /// from nothing, or falls with a support, [`ClimberError::OutOfRange`] for shares that are none, lengths and times below
    /// zero, and a heading that is no unit vector.
    pub fn restore(&mut self, state: ClimberState) -> Result<(), ClimberError> {
        state.validate()?;
        self.state = state;
        self.scratch.contacts.clear();
        Ok(())
    }

    /// One tick of `dt` seconds. Obstacles must already stand where they stand at its end. Fur can be gripped.
    ///
    /// Obstacles may come in any order; of two with the same id the first counts.
    ///
    /// # Errors
    /// [`ClimberError`] if `dt` is not positive, the input is not finite, or a blow's damage is no share; the climber is
    /// unchanged then.
    pub fn step(
        &mut self,
        input: &ClimberInput,
        obstacles: &[(ObstacleId, &dyn Obstacle)],
        dt: f64,
    ) -> Result<StepReport, ClimberError> {
        self.step_with(input, obstacles, &StepRules::default(), dt)
    }

    /// [`Climber::step`] by a game's own rules: what can be gripped, and modes of its own.
    ///
    /// # Errors
    /// As [`Climber::step`], and [`ClimberError::SameMode`] if two of the modes have one number.
    pub fn step_with(
        &mut self,
        input: &ClimberInput,
        obstacles: &[(ObstacleId, &dyn Obstacle)],
        rules: &StepRules<'_>,
        dt: f64,
    ) -> Result<StepReport, ClimberError> {
        for (index, mode) in rules.modes.iter().enumerate() {
            if rules.modes[..index]
                .iter()
                .any(|other| other.id() == mode.id())
            {
                return Err(ClimberError::SameMode(mode.id()));
            }
        }
        let asked = Asked {
            input,
            rules,
            obstacles,
            dt,
        };
        let tick = Tick::new(&self.config, self.state, asked, &mut self.scratch)?;
        let (state, report) = tick.run();
        self.state = state;
        Ok(report)
    }
}

fn is_fur(tag: &SurfaceTag) -> bool {
    tag.kind == clamber_world::SurfaceKind::Fur
}
