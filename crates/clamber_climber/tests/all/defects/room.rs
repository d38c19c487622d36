//! Resizes of bodies that turn, and of bodies among contacts that a rule makes passable.

use clamber_climber::{Climber, ClimberConfig, ClimberError, ContactQuery, ContactRule, StepRules};
use clamber_world::{Obstacle, ObstacleId, SurfaceTag, TriangleTerrain};
use glam::DVec3;

use crate::cases::pairs;

/// Sizes of the bodies, relative to a radius of 0.4 m.
const SIZES: [f64; 4] = [1.0, 0.02, 10.0, 100.0];

/// Two level sheets, the lower one at height 0.
fn corridor(height: f64, size: f64) -> TriangleTerrain {
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for y in [0.0, height * size] {
        let first = points.len() as u32;
        let corner = |x: f64, z: f64| DVec3::new(x * 9.0 * size, y, z * 9.0 * size);
        points.extend([
            corner(-1.0, -1.0),
            corner(-1.0, 1.0),
            corner(1.0, 1.0),
            corner(1.0, -1.0),
        ]);
        triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    let points: Vec<_> = points.iter().map(|point: &DVec3| point.as_vec3()).collect();
    let tags = vec![SurfaceTag::default(); triangles.len()];
    TriangleTerrain::new(&points, &triangles, &tags, DVec3::ZERO).unwrap()
}

fn tall(size: f64, gravity: DVec3) -> ClimberConfig {
    let mut config = ClimberConfig::walker().scaled(size);
    config.gravity = gravity;
    config.body.height = size;
    config
}

#[test]
fn a_body_turns_only_where_it_has_room() {
    for (size, (height, fits)) in pairs(SIZES, [(1.0, false), (1.7, false), (2.0, true)]) {
        let terrain = corridor(height, size);
        let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &terrain)];
        let lying = tall(size, DVec3::X * -9.81);
        let start = DVec3::Y * (0.41 * size);
        let mut climber = Climber::new(lying, start).unwrap();
        let before = *climber.state();
        let upright = tall(size, DVec3::Y * -9.81);
        let turned = climber.try_resize(upright, &obstacles);
        let told = format!("size {size}, corridor of {height}: {turned:?}");
        if fits {
            assert_eq!(turned, Ok(()), "{told}");
        } else {
            assert!(matches!(turned, Err(ClimberError::NoRoom { .. })), "{told}");
            assert_eq!(*climber.state(), before, "{told}");
            assert_eq!(*climber.config(), lying, "{told}");
        }
    }
}

#[test]
fn what_a_rule_lets_pass_takes_no_room() {
    let ghost = |_: &ContactQuery<'_>| ContactRule::PASS;
    for size in SIZES {
        let terrain = corridor(0.9, size);
        let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &terrain)];
        let mut climber = Climber::new(
            ClimberConfig::walker().scaled(size),
            DVec3::Y * (0.2 * size),
        )
        .unwrap();
        let place = climber.state().position;
        // The same size does not move the climber, even where it overlaps an obstacle.
        let same = *climber.config();
        assert_eq!(climber.try_resize(same, &obstacles), Ok(()));
        assert_eq!(climber.state().position, place);
        let large = ClimberConfig::walker().scaled(size * 3.0);
        let refused = climber.try_resize(large, &obstacles);
        assert!(matches!(refused, Err(ClimberError::NoRoom { .. })));
        let rules = StepRules::by(&ghost);
        assert_eq!(climber.try_resize_with(large, &obstacles, &rules), Ok(()));
        assert_eq!(climber.state().position, place);
        assert_eq!(climber.config().body.radius, large.body.radius);
    }
}
