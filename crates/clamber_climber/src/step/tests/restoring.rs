//! The same bits with obstacles in any order, with other obstacles far away, and after a restore at any tick.

use clamber_surface::geometry::rotation_from_axis_angle;
use clamber_world::{
    Contact, MaterialPoint, Obstacle, ObstacleId, PointMotion, SweepContact, TargetMotion,
    WorldCapsule,
};
use glam::{DAffine3, DVec3};

use super::*;

/// An obstacle that must not be queried, since its bounds are far away.
struct Elsewhere(DVec3);

impl Obstacle for Elsewhere {
    fn bounds(&self) -> Option<(DVec3, f64)> {
        Some((self.0, 20.0))
    }

    fn cast_ray(&self, _: DVec3, _: DVec3, _: f64) -> Option<Contact> {
        panic!("asked for a ray at {}", self.0)
    }

    fn closest_point(&self, _: DVec3, _: f64) -> Option<Contact> {
        panic!("asked for the nearest point at {}", self.0)
    }

    fn overlap_capsule(&self, _: &WorldCapsule, _: &mut Vec<Contact>) {
        panic!("asked for contacts at {}", self.0)
    }

    fn cast_capsule(
        &self,
        _: &WorldCapsule,
        _: [DVec3; 2],
        _: TargetMotion,
    ) -> Option<SweepContact> {
        panic!("asked for a cast at {}", self.0)
    }

    fn motion(&self, _: &MaterialPoint, _: f64) -> Option<PointMotion> {
        panic!("asked for motion at {}", self.0)
    }
}

#[test]
fn order_of_obstacles_and_a_restored_state_change_no_bit() {
    // Two troughs that cross each other; in the pit between them the climber touches both.
    let (mut one, mut other) = (trough(20.0), trough(25.0));
    let across = rotation_from_axis_angle(DVec3::Y, core::f64::consts::FRAC_PI_2);
    let mut forward = climber_at(0.5, 3.0, 0.2);
    let mut backward = forward.clone();
    let mut stood_on = std::collections::BTreeSet::new();
    for tick in 0..600 {
        let t = f64::from(tick) * DT;
        let lift = DVec3::Y * (0.3 * libm::sin(3.0 * t));
        pose(&mut one, &DAffine3::from_rotation_translation(across, lift));
        pose(
            &mut other,
            &DAffine3::from_translation(DVec3::Y * (0.3 * libm::cos(2.0 * t))),
        );
        let input = ClimberInput {
            walk: DVec3::new(libm::sin(t), 0.0, libm::cos(1.7 * t)),
            jump: tick % 70 == 69,
            ..IDLE
        };
        let ids = (ObstacleId(4), ObstacleId(9));
        let in_order: [(_, &dyn Obstacle); 2] = [(ids.0, &one), (ids.1, &other)];
        let reversed: [(_, &dyn Obstacle); 2] = [(ids.1, &other), (ids.0, &one)];
        if tick == 100 {
            let state = *backward.state();
            backward = climber_at(-5.0, 50.0, 3.0);
            backward.restore(state).unwrap();
        }
        let a = forward.step(&input, &in_order, DT).unwrap();
        let b = backward.step(&input, &reversed, DT).unwrap();
        assert_eq!(a, b, "tick {tick}");
        let (a, b) = (forward.state(), backward.state());
        assert_eq!(a.fingerprint(), b.fingerprint(), "tick {tick}: {a:?} {b:?}");
        stood_on.extend(a.support.map(|support| support.attachment.obstacle));
    }
    assert_eq!(stood_on.len(), 2, "only ever stood on {stood_on:?}");
}

#[test]
fn obstacles_out_of_reach_are_not_queried_and_change_no_bit() {
    let ground = level();
    let far: Vec<Elsewhere> = (0..40)
        .map(|k| Elsewhere(DVec3::new(60.0 + 50.0 * f64::from(k), 0.0, 0.0)))
        .collect();
    let mut crowd: Vec<(ObstacleId, &dyn Obstacle)> = vec![(ObstacleId(20), &ground)];
    for (k, one) in far.iter().enumerate() {
        let id = if k < 20 { 39 - k } else { k + 1 };
        crowd.push((ObstacleId(id as u64), one as &dyn Obstacle));
    }
    // If two obstacles have the same id, the first counts: for one id it is the ground, for the other an obstacle far
    // away.
    crowd.push((ObstacleId(20), &far[0]));
    crowd.push((ObstacleId(30), &ground));
    let (mut alone, mut among) = (climber_at(0.0, 1.0, 0.0), climber_at(0.0, 1.0, 0.0));
    for tick in 0..240 {
        let input = ClimberInput {
            walk: DVec3::new(1.0, 0.0, 0.3),
            jump: tick % 50 == 49,
            ..IDLE
        };
        alone
            .step(&input, &[(ObstacleId(20), &ground)], DT)
            .unwrap();
        among.step(&input, &crowd, DT).unwrap();
        assert_eq!(alone.state(), among.state(), "tick {tick}");
    }
    assert!(alone.state().position.x > 5.0, "{:?}", alone.state());
}
