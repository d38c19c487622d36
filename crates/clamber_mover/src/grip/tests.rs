use clamber_surface::glam::Vec3;
use clamber_world::{Obstacle, ObstacleId, TriangleTerrain};
use fastrand::Rng;

use super::*;
use crate::MoverMemory;

/// Rough ground of 6 m by 6 m, in cells of 0.2 m, at a level. Only one of `every` triangles is kept; the rest are
/// holes.
fn rough(rng: &mut Rng, height: f32, level: f32, every: usize) -> TriangleTerrain {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for row in 0..=30 {
        for column in 0..=30 {
            let place = Vec3::new(column as f32, 0.0, row as f32) * 0.2 - Vec3::new(3.0, 0.0, 3.0);
            positions.push(place + Vec3::Y * (level + height * rng.f32()));
        }
    }
    for row in 0..30 {
        for column in 0..30 {
            let a = row * 31 + column;
            triangles.extend([[a, a + 31, a + 32], [a, a + 32, a + 1]]);
        }
    }
    let triangles: Vec<[u32; 3]> = triangles.into_iter().step_by(every).collect();
    TriangleTerrain::new(&positions, &triangles, &[], DVec3::ZERO).unwrap()
}

#[test]
fn a_grip_at_the_body_is_the_grip_of_the_whole_reach_and_nothing_is_before_it() {
    let mut rng = Rng::with_seed(3);
    let (mut found, mut at_body, mut none) = (0, 0, 0);
    let (mut seen, mut farther) = (0, 0);
    for case in 0..400 {
        let height = [0.0, 0.1, 0.5, 1.5][case % 4];
        let ground = rough(&mut rng, height, 0.0, 1);
        // In some cases, a grate above the ground that hands cannot grip.
        let grate = rough(&mut rng, 0.0, height + 0.03, 3);
        let obstacles: [(ObstacleId, &dyn Obstacle); 2] =
            [(ObstacleId(1), &ground), (ObstacleId(2), &grate)];
        let obstacles = &obstacles[..1 + case / 4 % 2];
        let mut memory = MoverMemory::default();
        let mut mover = Mover::new(obstacles, 1.0 / 60.0, &mut memory).unwrap();
        let radius = [0.4, 0.2, 1.0][case % 3];
        let body = MoverBody::capsule(DVec3::ZERO, radius, radius * 0.025);
        for _ in 0..20 {
            let mut lot = |size: f64| (2.0 * rng.f64() - 1.0) * size;
            let above = radius * (1.0 + lot(0.4)) + f64::from(height) * lot(0.5).abs();
            let position = DVec3::new(lot(2.0), above, lot(2.0));
            let (every, salt) = (1 + rng.u64(0..4), rng.u64(0..9));
            let can_grip = |touch: &MoverContact| {
                let is_ground = touch.obstacle == ObstacleId(1);
                is_ground && (touch.contact.material.key + salt).is_multiple_of(every)
            };
            let merit = |touch: &MoverContact| touch.normal.x.max(0.0);
            let reach = radius * [0.05, 0.5, 1.5][rng.usize(0..3)];
            let wanted = mover.grip_within(&body, position, reach, &can_grip, &merit);
            let grip = mover.find_grip(&body, position, reach, can_grip, merit);
            assert_eq!(grip, wanted, "case {case}, {position}, reach {reach}");
            if let Some(touch) = grip {
                let overlaps = mover.overlap(&body.crouched(), position, reach).iter();
                let distances = overlaps.map(|touch| touch.contact.distance);
                let nearest = distances.fold(f64::INFINITY, f64::min);
                // Otherwise the ground is within the core.
                if nearest > body.core_radius() {
                    let is_reached = mover.can_reach(position, &touch, AT_HAND * radius);
                    assert!(is_reached, "case {case}, {position}, reach {reach}");
                    seen += 1;
                    farther += usize::from(touch.contact.distance - AT_HAND * radius > nearest);
                }
            }
            found += usize::from(grip.is_some());
            none += usize::from(grip.is_none());
            at_body += usize::from(grip.is_some_and(|grip| grip.contact.distance < radius * 1.05));
        }
    }
    assert!(
        found > 1_000 && none > 100 && at_body > 500 && at_body < found,
        "{found} {none} {at_body}"
    );
    assert!(seen > 500 && farther > 100, "{seen} {farther}");
}
