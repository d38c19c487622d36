//! An outcrop on the way to the creature: a wall with an edge to hang from, and a slope behind it that is too steep to
//! stand on.

use clamber_world::rapier3d::prelude::*;
use glam::{DVec3, Vec3};

use super::BattleError;
use crate::valley;

/// X of its wall, and z of its middle, metres: it is climbed along +X.
pub(super) const WALL: f64 = 33.0;
const MIDDLE: f64 = 0.0;

/// Height of its top above the ground at the wall, and length of the top along X, metres. A climber cannot reach the
/// top from the ground, but can with a jump.
const HEIGHT: f64 = 2.3;
const TOP: f64 = 2.5;

/// Length of the slope behind the top along X, metres, and its fall for each metre: 60 degrees.
const SLOPE: f64 = 2.2;
const STEEPNESS: f64 = 1.732;

/// Half of its width along Z, metres.
const HALF_WIDTH: f64 = 3.5;

/// Room beside it, metres.
const BESIDE: f64 = 1.0;

/// X of the end of its slope, metres.
pub(super) const END: f64 = WALL + TOP + SLOPE;

/// True if whoever walks along +X at this z comes to the outcrop, or near it.
pub(super) fn is_in_line(z: f64) -> bool {
    (z - MIDDLE).abs() < HALF_WIDTH + BESIDE
}

/// The outcrop's corners, in the world, and its triangles.
pub fn mesh() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let top = valley::height(WALL, MIDDLE) + HEIGHT;
    let behind = top - SLOPE * STEEPNESS;
    let profile = [
        (WALL, behind),
        (WALL, top),
        (WALL + TOP, top),
        (END, behind),
    ];
    let sides = [MIDDLE - HALF_WIDTH, MIDDLE + HALF_WIDTH];
    let corners = sides
        .iter()
        .flat_map(|z| profile.map(|(x, y)| DVec3::new(x, y, *z).as_vec3()));
    let triangles = vec![
        // Wall, top and slope.
        [0, 4, 5],
        [0, 5, 1],
        [1, 5, 6],
        [1, 6, 2],
        [2, 6, 7],
        [2, 7, 3],
        // Below, and both sides.
        [3, 7, 4],
        [3, 4, 0],
        [0, 1, 2],
        [0, 2, 3],
        [4, 6, 5],
        [4, 7, 6],
    ];
    (corners.collect(), triangles)
}

/// Adds the outcrop to the valley.
pub(super) fn insert(world: &mut PhysicsWorld) -> Result<(), BattleError> {
    let (corners, triangles) = mesh();
    let collider = ColliderBuilder::trimesh(corners, triangles);
    let collider = collider.map_err(|error| BattleError::Outcrop(error.to_string()))?;
    world.insert_collider(collider, None);
    world.detect_collisions(&(), &());
    Ok(())
}
