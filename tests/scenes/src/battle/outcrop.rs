//! An outcrop on the way to the creature: a wall with an edge to hang from, and a slope behind it that is too steep to
//! stand on; and the bot's way over it.

use clamber_climber::{Climber, ClimberInput, ClimberMode};
use clamber_world::rapier3d::prelude::*;
use glam::DVec3;

use super::rockfall::Triangles;
use super::{GRIP, SceneError};
use crate::valley;

/// X of its wall, metres: it is climbed along +X.
pub(super) const WALL: f64 = 33.0;
/// Z of its middle, metres.
const MIDDLE: f64 = 0.0;

/// Height of its top above the ground at the wall, metres. A climber cannot reach the top from the ground, but can with
/// a jump.
const HEIGHT: f64 = 2.3;
/// Length of the top along X, metres.
const TOP: f64 = 2.5;

/// Length of the slope behind the top along X, metres.
const SLOPE: f64 = 2.2;
/// Fall of the slope for each metre: 60 degrees.
const STEEPNESS: f64 = 1.732;

/// Half of its width along Z, metres.
const HALF_WIDTH: f64 = 3.5;

/// Width of the way around it on either side, metres.
const BESIDE: f64 = 1.0;

/// X of the end of its slope, metres.
const END: f64 = WALL + TOP + SLOPE;

/// The outcrop's corners, in the world, and its triangles.
pub fn mesh() -> Triangles {
    let top = valley::height(WALL, MIDDLE) + HEIGHT;
    let behind = top - SLOPE * STEEPNESS;
    let profile = [
        (WALL, behind),
        (WALL, top),
        (WALL + TOP, top),
        (END, behind),
    ];
    let sides = [MIDDLE - HALF_WIDTH, MIDDLE + HALF_WIDTH].into_iter();
    let corners = sides.flat_map(|z| profile.map(|(x, y)| DVec3::new(x, y, z).as_vec3()));
    // Wall, top, slope and below, and then both ends.
    let around = (0..4).flat_map(|a: u32| {
        let b = (a + 1) % 4;
        [[a, a + 4, b + 4], [a, b + 4, b]]
    });
    let ends = [[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]];
    (corners.collect(), around.chain(ends).collect())
}

/// Adds the outcrop to the valley.
pub(super) fn insert(world: &mut PhysicsWorld) -> Result<(), SceneError> {
    let (corners, triangles) = mesh();
    let collider = ColliderBuilder::trimesh(corners, triangles);
    let collider =
        collider.map_err(|error| format!("the outcrop cannot be added to the valley: {error}"))?;
    world.insert_collider(collider, None);
    world.detect_collisions(&(), &());
    Ok(())
}

/// The bot jumps within this distance of the wall, metres.
const JUMP: f64 = 0.9;

/// Least time between two jumps, seconds.
const BETWEEN_JUMPS: f64 = 1.2;

/// What the bot remembers of its way over the outcrop.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Crossing {
    /// The climber has been behind it.
    crossed: bool,
    /// Time of the last jump, seconds.
    jumped: Option<f64>,
}

impl Crossing {
    /// The input on the way over the outcrop, or around it once the climber has crossed it; `None` where it is not in
    /// the way. An attacked climber steps back from the wall.
    pub(super) fn input(
        &mut self,
        climber: &Climber,
        seconds: f64,
        attacked: bool,
    ) -> Option<ClimberInput> {
        let state = climber.state();
        let is_before =
            state.position.x < END && (state.position.z - MIDDLE).abs() < HALF_WIDTH + BESIDE;
        self.crossed |= state.position.x >= END;
        if !is_before || self.crossed && attacked {
            return None;
        }
        if self.crossed {
            return Some(ClimberInput {
                walk: DVec3::Z * state.position.z.signum(),
                grip: state.mode == ClimberMode::Standing,
                ..ClimberInput::IDLE
            });
        }
        if state.mode == ClimberMode::Tumbling {
            return Some(ClimberInput::IDLE);
        }
        if state.mode == ClimberMode::LedgeHanging {
            let climb = climber.config().up();
            return Some(ClimberInput { climb, ..GRIP });
        }
        let gap = WALL - climber.config().body.radius - state.position.x;
        let is_near = (0.0..JUMP).contains(&gap) && state.mode == ClimberMode::Standing;
        let rests = |jumped: f64| seconds - jumped > BETWEEN_JUMPS;
        let is_rested = self.jumped.is_none_or(rests);
        let jump = is_near && is_rested && !attacked;
        if jump {
            self.jumped = Some(seconds);
        }
        let walk = if attacked { -DVec3::X } else { DVec3::X };
        Some(ClimberInput { walk, jump, ..GRIP })
    }
}
