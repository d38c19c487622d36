//! Recovery of a body that was pressed into the ground.

use clamber_climber::ClimberMode;
use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, Vec3};

use crate::cases::pairs;
use crate::events::is_crushed;
use crate::input::IDLE;
use crate::scene::{STONE, assert_mode, cuboid_at, scaled_down, tick_among, walker};

#[test]
fn a_body_pressed_into_the_ground_comes_out_on_the_side_it_went_in() {
    come_out_of(&cuboid_at(Vec3::new(4.0, 1.0, 4.0), STONE, DVec3::NEG_Y));
    // Squares of 0.1 m.
    let mut fine = cuboid_at(Vec3::new(40.0, 10.0, 40.0), STONE, DVec3::NEG_Y);
    scaled_down(&mut fine);
    come_out_of(&fine);
}

/// Starts with the climber's centre on, just above or just below the skin: in faces, on edges and on vertices.
fn come_out_of(ground: &SkinnedSurface) {
    let depths = [-0.3, -0.1, -1e-3, -1e-8, 0.0, 1e-8, 1e-4, 0.01, 0.1, 0.19];
    let places = [(0.0, 0.0), (0.5, 0.5), (0.5, 0.0), (0.3, -1.2), (1.0, 0.25)];
    for (depth, (x, z)) in pairs(depths, places) {
        let start = DVec3::new(x, -depth, z);
        let mut climber = walker(start);
        for _ in 0..20 {
            let report = tick_among(&mut climber, &[ground], &IDLE);
            let crushed = report.events.iter().any(is_crushed);
            assert!(!crushed, "{depth} {x} {z}: {report:?}");
        }
        assert_mode(&climber, ClimberMode::Standing);
        let off = climber.state().position - DVec3::new(x, 0.4, z);
        assert!(
            off.y.abs() < 0.02 && off.length() < 0.02,
            "{depth} {x} {z}: {off}"
        );
    }
}
