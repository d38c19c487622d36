//! What is fought: the giant, two climbers, and what they do.

use std::error::Error;
use std::sync::Arc;

use clamber::climber::ClimberInput;
use clamber::colossus::{Brain, CreatureConfig, CreatureKind, CreatureParts};
use clamber::fight::actions::{BOW, STAB};
use clamber::fight::{Arena, ArenaConfig, ArenaError, FighterConfig, PlayerInput};
use clamber::world::{HalfSpace, Obstacle, ObstacleId};
use glam::DVec3;

use crate::RATE;

/// An arena, and the ground below it.
pub(crate) struct Fight {
    pub(crate) arena: Arena,
    ground: HalfSpace,
}

impl Fight {
    /// The giant.
    pub(crate) fn kind() -> Result<Arc<CreatureKind>, Box<dyn Error>> {
        let rig = clamber::gltf::load("assets/colossus.glb")?;
        let parts = CreatureParts {
            skeleton: rig.skeleton,
            clips: rig.clips,
            mesh: rig.collider,
            weak_points: rig.weak_points,
        };
        let brain = std::fs::read_to_string("assets/colossus.brain.json")?;
        let brain = Brain::from_json(&brain, 1.0 / RATE as f64)?;
        Ok(Arc::new(CreatureKind::new(parts, brain)?))
    }

    /// One climber above the giant's back, and one before it.
    pub(crate) fn new(kind: &Arc<CreatureKind>) -> Result<Self, Box<dyn Error>> {
        let mut arena = Arena::new(ArenaConfig::default())?;
        arena.add_creature(Arc::clone(kind), CreatureConfig::default())?;
        for place in [DVec3::new(0.0, 36.0, -1.0), DVec3::new(3.0, 1.0, 25.0)] {
            arena.add_fighter(FighterConfig::hero(), place)?;
        }
        Ok(Self {
            arena,
            ground: HalfSpace::below(0.0),
        })
    }

    /// What a player does in a tick: a game reads keyboard and mouse here.
    pub(crate) fn input(player: usize, tick: u64) -> PlayerInput {
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

    /// Steps the arena.
    pub(crate) fn step(
        arena: &mut Arena,
        ground: &HalfSpace,
        inputs: &[ClimberInput],
    ) -> Result<(), ArenaError> {
        let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), ground)];
        arena.step(inputs, &terrain).map(drop)
    }

    pub(crate) fn ground(&self) -> HalfSpace {
        self.ground
    }
}
