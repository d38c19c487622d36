//! A valley: a height field of rolling ground with hills around it, in a rapier world.

use clamber_world::rapier3d::parry::utils::Array2;
use clamber_world::rapier3d::prelude::*;
use glam::{DVec3, Vec3};

/// Length of each side, metres. The valley is centred on the origin.
pub const SIZE: f64 = 320.0;

/// Number of cells along each side.
const CELLS: usize = 160;

/// Height of the ground at (x, z), metres.
pub fn height(x: f64, z: f64) -> f64 {
    let rolling = 0.6 * libm::sin(x * 0.05) * libm::cos(z * 0.043)
        + 0.25 * libm::sin(x * 0.13 + 1.0) * libm::sin(z * 0.11);
    let beyond = ((x * x + z * z).sqrt() - 90.0).max(0.0);
    rolling + beyond * beyond * 0.008
}

/// True if (x, z) is within the valley. Outside it there is no ground, and bodies fall for ever.
pub fn contains(x: f64, z: f64) -> bool {
    x.abs() <= 0.5 * SIZE && z.abs() <= 0.5 * SIZE
}

/// Corners and triangles of the ground, with this distance between neighbouring corners, metres.
pub fn mesh(cell: f64) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let cells = (SIZE / cell) as u32;
    let place = |index: u32| f64::from(index) * cell - SIZE / 2.0;
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for row in 0..=cells {
        for column in 0..=cells {
            let (x, z) = (place(column), place(row));
            positions.push(DVec3::new(x, height(x, z), z).as_vec3());
            if row < cells && column < cells {
                let [a, b] = [row, row + 1].map(|row| row * (cells + 1) + column);
                triangles.extend([[a, b, a + 1], [a + 1, b, b + 1]]);
            }
        }
    }
    (positions, triangles)
}

/// A rapier world with the valley as its only collider, ready for queries.
pub fn world() -> PhysicsWorld {
    let mut world = PhysicsWorld::default();
    let samples = CELLS + 1;
    let place = |index: usize| (index as f64 / CELLS as f64 - 0.5) * SIZE;
    // Rows run along z, columns along x; column-major.
    let heights: Vec<Real> = (0..samples * samples)
        .map(|index| height(place(index / samples), place(index % samples)) as Real)
        .collect();
    let scale = Vector::new(SIZE as Real, 1.0, SIZE as Real);
    let ground = ColliderBuilder::heightfield(Array2::new(samples, samples, heights), scale);
    world.insert_collider(ground, None);
    world.detect_collisions(&(), &());
    world
}

#[cfg(test)]
mod tests {
    use super::*;
    use clamber_world::{BodyPoses, Obstacle, RapierTerrain};

    #[test]
    fn the_height_field_follows_the_height_function() {
        let world = world();
        let before = BodyPoses::default();
        let terrain = RapierTerrain::of_world(&world, &before);
        // Off the grid's lines: a ray that meets an edge exactly can slip between rapier's triangles.
        for (x, z) in [(0.3, 0.4), (37.1, -12.3), (-80.5, 60.25), (120.0, 100.0)] {
            let from = DVec3::new(x, 500.0, z);
            let hit = terrain.cast_ray(from, -DVec3::Y, 1000.0).unwrap();
            // The height field has cells of 2 m, the function is curved.
            assert!(
                (hit.point.y - height(x, z)).abs() < 0.05,
                "at {x} {z}: {hit:?}"
            );
        }
    }
}
