//! Where somebody who flies comes down.

use clamber_climber::{Climber, ClimberInput, ClimberState, StepRules};
use clamber_world::{Obstacle, ObstacleId};

use crate::NavigationError;
use crate::future::{Future, FutureSkin, check_step};

/// Where a climber that flies touches something.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Landing {
    /// After so many seconds.
    pub seconds: f64,
    /// The climber then: its support is what it stands on, holds or hangs from.
    pub state: ClimberState,
}

/// Somebody who flies, and what is around.
#[derive(Clone, Copy)]
pub struct Flight<'a> {
    /// The climber that flies.
    pub climber: &'a Climber,
    /// Its input in every tick: one that steers or grips counts.
    pub input: &'a ClimberInput,
    /// Its rules for contacts, and its modes, as in its own steps.
    pub rules: &'a StepRules<'a>,
    /// The creature's obstacle id.
    pub creature: ObstacleId,
    /// Everything else that it can touch. It is taken to stay as it is.
    pub others: &'a [(ObstacleId, &'a dyn Obstacle)],
}

impl FutureSkin {
    /// Where a climber that falls or jumps comes down, on a creature as it will be then: the climber is stepped, tick
    /// by tick, until it stands, holds on or hangs. `None` if it does not within `most` seconds, or for as long as the
    /// future is known. `dt` is the length of a tick, seconds.
    ///
    /// # Errors
    /// [`NavigationError::Climber`] if the climber refuses the input, [`NavigationError::Surface`] if a pose does not fit the
    /// skin, [`NavigationError::OutOfRange`] if `dt` is not positive.
    pub fn landing(
        &mut self,
        flight: &Flight<'_>,
        future: &mut dyn Future,
        dt: f64,
        most: f64,
    ) -> Result<Option<Landing>, NavigationError> {
        check_step(dt)?;
        let mut flies = flight.climber.clone();
        if !self.place(future, 0.0)? {
            return Ok(None);
        }
        let ticks = (most / dt).clamp(0.0, 1e6) as u64;
        for tick in 1..=ticks {
            let seconds = tick as f64 * dt;
            if !self.advance(future, seconds)? {
                return Ok(None);
            }
            let mut around: Vec<(ObstacleId, &dyn Obstacle)> = flight.others.to_vec();
            around.push((flight.creature, self.surface()));
            flies.step_with(flight.input, &around, flight.rules, dt)?;
            let state = flies.state();
            if state.support.is_some() {
                let state = *state;
                return Ok(Some(Landing { seconds, state }));
            }
        }
        Ok(None)
    }
}
