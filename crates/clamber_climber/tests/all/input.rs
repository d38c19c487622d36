//! Inputs of a tick.

use clamber_climber::{ClimberInput, Knockback};
use glam::DVec3;

/// No input.
pub(crate) const IDLE: ClimberInput = ClimberInput::IDLE;

/// Input that only holds the grip.
pub(crate) const HOLD: ClimberInput = ClimberInput { grip: true, ..IDLE };

/// Input that only jumps.
pub(crate) const JUMP: ClimberInput = ClimberInput { jump: true, ..IDLE };

/// Input that holds the button of the jump, which begins if `jump` is true.
pub(crate) const fn high_jump(jump: bool) -> ClimberInput {
    let jump_held = true;
    ClimberInput {
        jump,
        jump_held,
        ..IDLE
    }
}

/// Walks in a direction.
pub(crate) const fn walk(walk: DVec3) -> ClimberInput {
    ClimberInput { walk, ..IDLE }
}

/// Holds the grip, with the stick in a direction.
pub(crate) const fn grip_walk(walk: DVec3) -> ClimberInput {
    ClimberInput { walk, ..HOLD }
}

/// Holds the grip, and climbs in a direction.
pub(crate) const fn grip_climb(climb: DVec3) -> ClimberInput {
    ClimberInput { climb, ..HOLD }
}

/// A blow that changes the velocity and does no damage.
pub(crate) const fn blow(velocity: DVec3) -> Option<Knockback> {
    Some(Knockback {
        velocity,
        damage: 0.0,
        by: None,
    })
}
