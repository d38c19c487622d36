//! What becomes of a body that was pressed into something.

use clamber_climber::{Climber, ClimberConfig, ClimberInput, ClimberMode};
use clamber_world::{Obstacle, ObstacleId};
use glam::{DQuat, DVec3, Vec3};

use crate::scene::{DT, STONE, assert_mode, cuboid, placed};

/// Its centre at, just above or just below the skin, in faces, on edges and on vertices.
#[test]
fn who_was_pressed_into_the_ground_comes_out_where_it_went_in() {
    let mut ground = cuboid(Vec3::new(4.0, 1.0, 4.0), STONE);
    placed(&mut ground, DVec3::new(0.0, -1.0, 0.0), DQuat::IDENTITY);
    for depth in [-0.3, -0.1, -1e-3, -1e-8, 0.0, 1e-8, 1e-4, 0.01, 0.1, 0.19] {
        for (x, z) in [(0.0, 0.0), (0.5, 0.5), (0.5, 0.0), (0.3, -1.2), (1.0, 0.25)] {
            let start = DVec3::new(x, -depth, z);
            let mut climber = Climber::new(ClimberConfig::walker(), start).unwrap();
            for _ in 0..20 {
                let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &ground)];
                climber
                    .step(&ClimberInput::default(), &obstacles, DT)
                    .unwrap();
            }
            assert_mode(&climber, ClimberMode::Standing);
            let off = climber.state().position - DVec3::new(x, 0.4, z);
            assert!(
                off.y.abs() < 0.02 && off.length() < 0.4,
                "{depth} {x} {z}: {off}"
            );
        }
    }
}
