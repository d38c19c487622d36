use clamber_world::Contact;
use glam::DVec3;

use crate::surroundings::Surroundings;
use crate::{ClimberConfig, ClimberError, ClimberMode, ClimberState};

/// What a player wants of a climber this tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClimberInput {
    /// Direction to walk in, in world space; its length, at most 1, is the share of full speed.
    /// The part along up does not count.
    pub walk: DVec3,
    /// True to jump off what the climber stands on.
    pub jump: bool,
}

/// A kinematic character: configuration, state, and the memory that a step needs.
#[derive(Clone, Debug)]
pub struct Climber {
    pub(crate) config: ClimberConfig,
    pub(crate) state: ClimberState,
    /// Contacts of the current query; kept for its memory.
    pub(crate) contacts: Vec<Contact>,
    /// Direction away from each contact, and its velocity; kept for its memory.
    pub(crate) planes: Vec<(DVec3, DVec3)>,
    /// Obstacles of the current step; kept for its memory.
    pub(crate) surroundings: Surroundings,
}

impl Climber {
    /// A climber in the air, its centre at `position`, in world space, at rest.
    ///
    /// # Errors
    /// [`ClimberError`] for a configuration outside its ranges or a position that is not finite.
    pub fn new(config: ClimberConfig, position: DVec3) -> Result<Self, ClimberError> {
        config.validate()?;
        let state = ClimberState {
            position,
            velocity: DVec3::ZERO,
            heading: config.up().any_orthonormal_vector(),
            mode: ClimberMode::Falling,
            footing: None,
        };
        if !state.is_finite() {
            return Err(ClimberError::NotFinite("position"));
        }
        Ok(Self {
            config,
            state,
            contacts: Vec::new(),
            planes: Vec::new(),
            surroundings: Surroundings::default(),
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

    /// Puts it back into a state, of this or another run.
    ///
    /// # Errors
    /// [`ClimberError::NotFinite`] if the state is not finite, [`ClimberError::Footing`] if it
    /// stands on nothing or falls with a footing.
    pub fn restore(&mut self, state: ClimberState) -> Result<(), ClimberError> {
        if !state.is_finite() {
            return Err(ClimberError::NotFinite("state"));
        }
        if (state.mode == ClimberMode::Standing) != state.footing.is_some() {
            return Err(ClimberError::Footing);
        }
        self.state = state;
        Ok(())
    }
}
