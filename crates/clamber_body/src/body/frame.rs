use clamber_climber::{Climber, ClimberConfig, ClimberState};
use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;

use crate::BodyError;

/// The climber and the world in one drawn frame, as a body needs them.
///
/// All fields are as drawn: a game that draws between two ticks passes a state with the drawn position, and obstacles
/// in their drawn poses.
#[derive(Clone, Copy)]
pub struct BodyInput<'a> {
    /// The climber's state.
    pub state: &'a ClimberState,
    /// The climber's configuration.
    pub config: &'a ClimberConfig,
    /// Obstacles that hands and feet can touch; the same as in the climber's step.
    pub obstacles: &'a [(ObstacleId, &'a dyn Obstacle)],
    /// The point that the eyes look at, in world space, metres; `None` for straight ahead.
    pub look_at: Option<DVec3>,
}

impl<'a> BodyInput<'a> {
    /// The input for drawing a climber as it is after its last step, not between two steps, with its eyes straight
    /// ahead. `obstacles` is as in [`BodyInput::obstacles`].
    pub fn new(climber: &'a Climber, obstacles: &'a [(ObstacleId, &'a dyn Obstacle)]) -> Self {
        Self {
            state: climber.state(),
            config: climber.config(),
            obstacles,
            look_at: None,
        }
    }

    pub(crate) fn check(&self, dt: f64) -> Result<(), BodyError> {
        if !(dt.is_finite() && dt >= 0.0) {
            return Err(BodyError::Time(dt));
        }
        let state = self.state;
        let vectors = [
            ("the position", state.position),
            ("the velocity", state.velocity),
            ("the velocity of the support", state.base_velocity),
            ("the heading", state.heading),
            ("the point to look at", self.look_at.unwrap_or_default()),
            ("gravity", self.config.gravity),
        ];
        if let Some((what, _)) = vectors.iter().find(|(_, vector)| !vector.is_finite()) {
            return Err(BodyError::NotFinite(what));
        }
        if state
            .support
            .is_some_and(|support| !(support.attachment.is_finite() && support.normal.is_finite()))
        {
            return Err(BodyError::NotFinite("the support"));
        }
        let numbers = [state.ledge_hanging.pull_up, self.config.body.radius];
        if numbers.iter().any(|number| !number.is_finite()) {
            return Err(BodyError::NotFinite("a number of the climber"));
        }
        Ok(())
    }
}
