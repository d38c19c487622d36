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
    /// It has been over it.
    crossed: bool,
    jumped: Option<f64>,
}

impl Crossing {
    /// The input on the way over it, or around it if it was over it before; `None` where it is not in the way. It waits
    /// before it while it is attacked.
    pub(super) fn input(
        &mut self,
        climber: &Climber,
        seconds: f64,
        attacked: bool,
    ) -> Option<ClimberInput> {
        let state = climber.state();
        let is_before = state.position.x < outcrop::END && outcrop::is_in_line(state.position.z);
        self.crossed |= state.position.x >= outcrop::END;
        if !is_before || self.crossed && attacked {
            return None;
        }
        if self.crossed {
            let aside = DVec3::Z * state.position.z.signum();
            return Some(ClimberInput {
                walk: aside,
                grip: state.mode == ClimberMode::Standing,
                ..ClimberInput::IDLE
            });
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
        let is_rested = self
            .jumped
            .is_none_or(|jumped| seconds - jumped > BETWEEN_JUMPS);
        let jump = is_near && is_rested && !attacked;
        if jump {
            self.jumped = Some(seconds);
        }
        let walk = if attacked { -DVec3::X } else { DVec3::X };
        Some(ClimberInput { walk, jump, ..grip })
    }
}
