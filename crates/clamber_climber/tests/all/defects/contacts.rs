//! The list of contacts has every contact, told apart by place and face and not by collider.

use std::collections::BTreeMap;

use clamber_climber::{Climber, ClimberConfig, ContactPhase};
use clamber_world::rapier3d::prelude::PhysicsWorld;
use clamber_world::{BodyPoses, Obstacle, RapierTerrain};
use glam::DVec3;

use crate::defects::common::{trimesh, v};
use crate::input::{IDLE, walk};
use crate::scene::{DT, put, tick_among};
use crate::stage::Shape;

/// A floor and two walls that meet in a corner at (5, 0, 5).
fn corner() -> [Shape; 3] {
    [
        Shape::quad([
            v(-5.0, 0.0, -5.0),
            v(-5.0, 0.0, 5.0),
            v(5.0, 0.0, 5.0),
            v(5.0, 0.0, -5.0),
        ]),
        Shape::quad([
            v(5.0, 0.0, -5.0),
            v(5.0, 0.0, 5.0),
            v(5.0, 5.0, 5.0),
            v(5.0, 5.0, -5.0),
        ]),
        Shape::quad([
            v(-5.0, 0.0, 5.0),
            v(-5.0, 5.0, 5.0),
            v(5.0, 5.0, 5.0),
            v(5.0, 0.0, 5.0),
        ]),
    ]
}

#[test]
fn a_corner_of_one_mesh_lists_what_a_corner_of_three_lists() {
    let [floor, right, left] = corner();
    let one = [floor.clone().and(right.clone()).and(left.clone())];
    let three = [floor, right, left];
    for height in [0.0, 1.0] {
        let lists = [&one[..], &three[..]].map(|shapes| {
            let mut world = PhysicsWorld::default();
            for shape in shapes {
                world.insert_collider(trimesh(shape), None);
            }
            world.step();
            let before = BodyPoses::new();
            let terrain = RapierTerrain::of_world(&world, &before);
            let mut config = ClimberConfig::walker();
            config.body.height = height;
            let mut climber = Climber::new(config, v(3.0, 0.4, 3.0)).unwrap();
            let mut listed = BTreeMap::new();
            for k in 0..120 {
                let obstacle: &dyn Obstacle = &terrain;
                tick_among(
                    &mut climber,
                    &[obstacle],
                    &walk(v(1.0, 0.0, 1.0).normalize()),
                );
                for contact in climber.contacts().iter().filter(|_| k >= 90) {
                    let normal = contact.normal.round().to_array().map(|x| x as i32);
                    let phase = format!("{:?}", contact.phase);
                    *listed.entry((phase, normal)).or_insert(0) += 1;
                }
            }
            listed
        });
        assert_eq!(lists[0], lists[1], "height {height}, over {} s", 30.0 * DT);
        for wall in [[-1, 0, 0], [0, 0, -1]] {
            let ticks = lists[0].get(&(format!("{:?}", ContactPhase::Swept), wall));
            let first = &lists[0];
            assert_eq!(ticks, Some(&30), "height {height}, {wall:?}: {first:?}");
        }
    }
}

/// Two pillars of one mesh, side by side: their faces have the same normal.
#[test]
fn two_faces_of_one_mesh_with_one_normal_are_two_contacts() {
    let pillar = |z: f64| Shape::boxed(v(1.0, -1.0, z - 0.2), v(2.0, 3.0, z + 0.2));
    let mut world = PhysicsWorld::default();
    world.insert_collider(trimesh(&pillar(0.35).and(pillar(-0.35))), None);
    world.step();
    let before = BodyPoses::new();
    let terrain = RapierTerrain::of_world(&world, &before);
    let mut config = ClimberConfig::walker();
    config.gravity = DVec3::ZERO;
    let mut climber = Climber::new(config, v(0.0, 0.5, 0.0)).unwrap();
    put(&mut climber, v(0.3, 0.5, 0.0), v(3.0, 0.0, 0.0));
    let mut most = 0;
    for _ in 0..30 {
        tick_among(&mut climber, &[&terrain], &IDLE);
        most = most.max(climber.contacts().len());
    }
    assert!(most >= 2, "{most}");
}
