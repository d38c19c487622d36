use clamber_world::{Contact, Obstacle, ObstacleId, SurfaceTag, WorldCapsule};
use glam::DVec3;

use crate::mover::Scratch;
use crate::step::Step;
use crate::{ClimberConfig, ClimberError, ClimberInput, ClimberState, StepReport};

/// Whether a climber may grip something, and hold on to it.
pub type CanGrip<'a> = dyn Fn(ObstacleId, &Contact) -> bool + 'a;

/// A kinematic character: configuration, state, and the memory that a step needs.
#[derive(Clone, Debug)]
pub struct Climber {
    config: ClimberConfig,
    state: ClimberState,
    /// Kept for its memory.
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

    /// Its state after the last step.
    pub fn state(&self) -> &ClimberState {
        &self.state
    }

    /// What it is to the world: where it stands after the last step.
    pub fn body(&self) -> WorldCapsule {
        crate::step::body(&self.config, &self.state)
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
        Ok(())
    }

    /// One tick of `dt` seconds. Obstacles must already stand where they stand at its end. Fur can be gripped.
    ///
    /// Obstacles may come in any order; of two with the same id the first counts.
    ///
    /// # Errors
    /// [`ClimberError`] if `dt` is not positive or the input is not finite; the climber is
    /// unchanged then.
    pub fn step(
        &mut self,
        input: &ClimberInput,
        obstacles: &[(ObstacleId, &dyn Obstacle)],
        dt: f64,
    ) -> Result<StepReport, ClimberError> {
        self.step_where(input, obstacles, &|_, contact| is_fur(&contact.tag), dt)
    }

    /// [`Climber::step`], gripping what a function says can be gripped.
    ///
    /// # Errors
    /// As [`Climber::step`].
    pub fn step_where(
        &mut self,
        input: &ClimberInput,
        obstacles: &[(ObstacleId, &dyn Obstacle)],
        can_grip: &CanGrip<'_>,
        dt: f64,
    ) -> Result<StepReport, ClimberError> {
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(ClimberError::OutOfRange {
                name: "dt",
                range: "positive",
                found: dt,
            });
        }
        if !input.is_finite() {
            return Err(ClimberError::NotFinite("input"));
        }
        let (state, report) = Step::new(
            &self.config,
            self.state,
            input,
            (obstacles, can_grip, dt),
            &mut self.scratch,
        )
        .run();
        self.state = state;
        Ok(report)
    }
}

fn is_fur(tag: &SurfaceTag) -> bool {
    tag.kind == clamber_world::SurfaceKind::Fur
}
