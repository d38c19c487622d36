//! The way over the outcrop.

use clamber_climber::{Climber, ClimberInput, ClimberMode};
use glam::DVec3;

use super::outcrop;

/// It jumps within this distance of the outcrop's wall, metres.
const JUMP: f64 = 0.9;

/// Least time between two jumps, seconds.
const BETWEEN_JUMPS: f64 = 1.2;

/// A climber on its way over the outcrop.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Crossing {
    jumped: Option<f64>,
}

impl Crossing {
    /// The input on the way; `None` where the outcrop is not before it. It runs from attacks.
    pub(super) fn input(&mut self, climber: &Climber, seconds: f64, attacked: bool) -> Option<ClimberInput> {
        let state = climber.state();
        let is_before = state.position.x < outcrop::END && outcrop::is_in_line(state.position.z);
        if !is_before {
            return None;
        }
        if state.mode == ClimberMode::Tumbling {
            return Some(ClimberInput::IDLE);
        }
        let grip = ClimberInput {
            grip: true,
            ..ClimberInput::IDLE
        };
        if state.mode == ClimberMode::LedgeHanging {
            return Some(ClimberInput {
                climb: climber.config().up(),
                ..grip
            });
        }
        let gap = outcrop::WALL - climber.config().body.radius - state.position.x;
        let is_near = (0.0..JUMP).contains(&gap) && state.mode == ClimberMode::Standing;
        let is_rested = self.jumped.is_none_or(|jumped| seconds - jumped > BETWEEN_JUMPS);
        let jump = is_near && is_rested && !attacked;
        if jump {
            self.jumped = Some(seconds);
        }
        let walk = if attacked { -DVec3::X } else { DVec3::X };
        Some(ClimberInput { walk, jump, ..grip })
    }
}
