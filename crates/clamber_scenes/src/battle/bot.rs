//! The scripted climber on the creature's back.

use clamber_climber::{ClimberInput, ClimberState};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{MaterialPoint, Obstacle};
use glam::DVec3;

/// What the script asks for at a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Intent {
    /// No input at all.
    Stand,
    /// Walk along the back, up and down around the perch.
    Patrol,
    /// Jump.
    Jump,
    /// Come over the ground and climb to the top.
    Climb,
}

/// Seconds in one direction.
const LEG: f64 = 2.5;

/// How far from the perch a patrol turns round, as a share of the creature's height.
const REACH: f64 = 0.06;

/// Where a patrol has arrived, metres from its target.
const ARRIVED: f64 = 0.2;

/// The input that carries out an intent. `perch` is the material point that the bot keeps near.
pub(super) fn input(
    intent: Intent,
    state: &ClimberState,
    surface: &SkinnedSurface,
    perch: &MaterialPoint,
    seconds: f64,
    height: f64,
) -> ClimberInput {
    match intent {
        Intent::Stand | Intent::Climb => ClimberInput::default(),
        Intent::Jump => ClimberInput {
            jump: true,
            ..ClimberInput::default()
        },
        Intent::Patrol => {
            let Some(middle) = Obstacle::motion(surface, perch, 1.0) else {
                return ClimberInput::default();
            };
            let forward = surface.world_from_model().rotation * DVec3::Z;
            let ahead = if (seconds / LEG).rem_euclid(2.0) < 1.0 {
                1.0
            } else {
                -1.0
            };
            let target = middle.position + forward * (ahead * REACH * height);
            let level = (target - state.position) * DVec3::new(1.0, 0.0, 1.0);
            let walk = if level.length() > ARRIVED {
                level.normalize_or_zero() * 0.6
            } else {
                DVec3::ZERO
            };
            ClimberInput {
                walk,
                ..ClimberInput::default()
            }
        }
    }
}
