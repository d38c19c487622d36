//! Two climbers against the giant on level ground: what a network fight is shown and tested with.

#[cfg(feature = "record")]
mod record;

use std::error::Error;
use std::sync::Arc;

use clamber_climber::{ClimberInput, StepRules};
use clamber_colossus::{Brain, CreatureConfig, CreatureKind};
use clamber_fight::actions::{BOW, STAB};
use clamber_fight::{Arena, ArenaConfig, ArenaError, FighterConfig, Order, PlayerInput};
use clamber_world::{HalfSpace, Obstacle, ObstacleId};
use glam::DVec3;

#[cfg(feature = "record")]
pub use record::{record, replay};

use crate::giant;

/// Ticks a second.
pub const RATE: u64 = 60;

/// An arena, and the ground below it.
#[derive(Clone, Debug)]
pub struct Duel {
    /// The arena.
    pub arena: Arena,
    /// The ground.
    pub ground: HalfSpace,
}

impl Duel {
    /// The giant.
    pub fn kind() -> Result<Arc<CreatureKind>, Box<dyn Error>> {
        let brain = std::fs::read_to_string(giant::brain_path())?;
        let brain = Brain::from_json(&brain, 1.0 / RATE as f64)?;
        Ok(Arc::new(CreatureKind::new(&giant::model()?.rig, brain)?))
    }

    /// One climber above the giant's back, and one before it.
    pub fn new(kind: &Arc<CreatureKind>) -> Result<Self, ArenaError> {
        let mut arena = Arena::new(ArenaConfig::default())?;
        arena.add_creature(Arc::clone(kind), CreatureConfig::default())?;
        for place in [DVec3::new(0.0, 36.0, -1.0), DVec3::new(3.0, 1.0, 25.0)] {
            arena.add_fighter(FighterConfig::hero(), place)?;
        }
        let ground = HalfSpace::below(0.0);
        Ok(Self { arena, ground })
    }

    /// What a player does in a tick: a game reads keyboard and mouse here.
    pub fn input(player: usize, tick: u64) -> PlayerInput {
        let seconds = tick as f64 / RATE as f64;
        let wave = |period: f64| libm::sin(seconds / period * core::f64::consts::TAU);
        let input = if player == 0 {
            // Rides, climbs about and stabs.
            let climbs = tick / RATE % 6 < 2;
            ClimberInput {
                grip: true,
                climb: if climbs {
                    DVec3::new(wave(3.0), wave(4.0), wave(5.0))
                } else {
                    DVec3::ZERO
                },
                actions: if tick % 180 < 150 { STAB } else { 0 },
                ..ClimberInput::default()
            }
        } else {
            // Runs to and fro, jumps and shoots.
            ClimberInput {
                walk: DVec3::new(wave(5.0), 0.0, 0.4 * wave(7.0)),
                jump: tick % 150 == 140,
                actions: if tick % 120 < 90 { BOW } else { 0 },
                aim: DVec3::new(-0.1, 0.8 + 0.2 * wave(6.0), -1.0),
                ..ClimberInput::default()
            }
        };
        PlayerInput::from_input(&input)
    }

    /// Steps the arena over the ground.
    pub fn step(
        arena: &mut Arena,
        ground: &HalfSpace,
        inputs: &[ClimberInput],
        orders: &[Order],
    ) -> Result<(), ArenaError> {
        let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, ground)];
        let rules = StepRules::default();
        arena.step_with(inputs, orders, &terrain, &rules).map(drop)
    }
}

/// The ground.
const GROUND: ObstacleId = ObstacleId(0);
