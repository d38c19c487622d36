//! Recovery of a body that was pressed into the ground.

use clamber_climber::{Climber, ClimberConfig, ClimberEvent, ClimberInput, ClimberMode};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{Obstacle, ObstacleId};
use glam::{DQuat, DVec3, Vec3};

use crate::scene::{DT, STONE, assert_mode, cuboid, placed, scaled_down};

#[test]
fn a_body_pressed_into_the_ground_comes_out_on_the_side_it_went_in() {
    let mut coarse = cuboid(Vec3::new(4.0, 1.0, 4.0), STONE);
    placed(&mut coarse, DVec3::new(0.0, -1.0, 0.0), DQuat::IDENTITY);
    come_out_of(&coarse);
    // Squares of 0.1 m.
    let mut fine = cuboid(Vec3::new(40.0, 10.0, 40.0), STONE);
    placed(&mut fine, DVec3::new(0.0, -1.0, 0.0), DQuat::IDENTITY);
    scaled_down(&mut fine);
    come_out_of(&fine);
}

/// Starts with the climber's centre on, just above or just below the skin: in faces, on edges and on vertices.
fn come_out_of(ground: &SkinnedSurface) {
    for depth in [-0.3, -0.1, -1e-3, -1e-8, 0.0, 1e-8, 1e-4, 0.01, 0.1, 0.19] {
        for (x, z) in [(0.0, 0.0), (0.5, 0.5), (0.5, 0.0), (0.3, -1.2), (1.0, 0.25)] {
            let start = DVec3::new(x, -depth, z);
            let mut climber = Climber::new(ClimberConfig::walker(), start).unwrap();
            for _ in 0..20 {
                let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), ground)];
                let report = climber
                    .step(&ClimberInput::default(), &obstacles, DT)
                    .unwrap();
                let is_crushed =
                    |event: &ClimberEvent| matches!(event, ClimberEvent::Crushed { .. });
                assert!(
                    !report.events.iter().any(is_crushed),
                    "{depth} {x} {z}: {report:?}"
                );
            }
            assert_mode(&climber, ClimberMode::Standing);
            let off = climber.state().position - DVec3::new(x, 0.4, z);
            assert!(
                off.y.abs() < 0.02 && off.length() < 0.02,
                "{depth} {x} {z}: {off}"
            );
        }
    }
}
