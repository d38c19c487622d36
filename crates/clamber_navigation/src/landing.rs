//! Predicts where an airborne climber comes down.

use clamber_climber::{Climber, ClimberInput, ClimberState, StepRules};
use clamber_world::{Obstacle, ObstacleId};

use crate::NavigationError;
use crate::future::{FutureSkin, PoseForecast, check_step};

/// A prediction of [`FutureSkin::landing`]: when and how a falling or jumping climber first gets a support, which is
/// the creature or any other obstacle that it stands on, holds on to or hangs from.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Landing {
    /// Seconds from now until the landing: a whole number of ticks.
    pub seconds: f64,
    /// The climber's predicted state at the landing, with the support that it stands on, holds or hangs from.
    pub state: ClimberState,
}

/// An airborne climber, and the obstacles around it.
#[derive(Clone, Copy)]
pub struct Airborne<'a> {
    /// The airborne climber.
    pub climber: &'a Climber,
    /// The climber's input, the same in each tick of the prediction. It has the same effect as in the climber's own
    /// steps: `walk` steers in the air, and with `grip` the hands catch holds. `jump` asks for a jump in each tick, so
    /// leave it false.
    pub input: &'a ClimberInput,
    /// The climber's contact rules and modes, as in its own steps. Their knockback is ignored.
    pub rules: &'a StepRules<'a>,
    /// The creature's obstacle id.
    pub creature: ObstacleId,
    /// All other obstacles that the climber can touch. The prediction keeps them as they are.
    pub others: &'a [(ObstacleId, &'a dyn Obstacle)],
}

impl FutureSkin {
    /// Predicts where a falling or jumping climber comes down, on the creature as it moves or on another obstacle:
    /// steps the climber, tick by tick, until it stands, holds on or hangs. `None` if it does not do so within `most`
    /// seconds, or before the future is no longer known. `dt` is the length of a tick, seconds. A million ticks at most
    /// are stepped.
    ///
    /// # Errors
    /// [`NavigationError::Climber`] if the climber refuses the input, [`NavigationError::Surface`] if a pose does not
    /// fit the skin, [`NavigationError::OutOfRange`] if `dt` is not positive and finite.
    pub fn landing(
        &mut self,
        airborne: &Airborne<'_>,
        forecast: &mut dyn PoseForecast,
        dt: f64,
        most: f64,
    ) -> Result<Option<Landing>, NavigationError> {
        check_step(dt)?;
        let mut flies = airborne.climber.clone();
        // A blow has already struck the climber.
        let rules = StepRules {
            knockback: None,
            ..*airborne.rules
        };
        if !self.place(forecast, 0.0)? {
            return Ok(None);
        }
        let ticks = (most / dt).clamp(0.0, 1e6) as u64;
        for tick in 1..=ticks {
            let seconds = tick as f64 * dt;
            if !self.advance(forecast, seconds)? {
                return Ok(None);
            }
            let mut around: Vec<(ObstacleId, &dyn Obstacle)> = airborne.others.to_vec();
            around.push((airborne.creature, self.surface()));
            flies.step_with(airborne.input, &around, &rules, dt)?;
            let state = flies.state();
            if state.support.is_some() {
                let state = *state;
                return Ok(Some(Landing { seconds, state }));
            }
        }
        Ok(None)
    }
}
