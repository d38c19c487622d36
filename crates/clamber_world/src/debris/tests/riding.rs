use glam::{DVec3, Vec3};
use rapier3d::prelude::*;

use super::scene::{DT, Scene, at, lifted, slab};
use crate::testing::rest;

/// Half the size of the back, metres.
const HALF: Vec3 = Vec3::new(6.0, 0.5, 3.0);

/// Time of a tick, seconds.
fn seconds(tick: u32) -> f64 {
    f64::from(tick) * DT
}

#[test]
fn a_stone_laid_on_a_walking_back_rides_by_friction() {
    let joints = 5;
    let mut scene = Scene::new(slab(HALF, 0.6, joints));
    let shape = ColliderBuilder::cuboid(0.4, 0.3, 0.5);
    let (stone, _) = scene.drop(shape, Vector::new(1.0, 0.81, 0.3));
    let mut laid = None;
    for tick in 0..480 {
        let t = seconds(tick);
        // The back starts to walk and turn, and heaves in a wave of 10 cm.
        let way = t - (1.0 - libm::exp(-t));
        let palette = lifted(joints, |joint| {
            0.1 * (1.0 - libm::exp(-t)) * libm::sin(2.0 * t - 0.8 * joint as f64)
        });
        let root = at(DVec3::new(1.5 * way, 0.0, 0.0), DVec3::Y, 0.2 * way);
        scene.tick(&palette, root);
        let place = scene.in_model(stone);
        if tick == 30 {
            laid = Some(place);
        }
        if let Some(laid) = laid {
            let drift = (place - laid).with_y(0.0).length();
            assert!(drift < 0.05, "tick {tick}: {drift} m off its place");
            // The stone turns with the back.
            let ahead = scene.world.bodies[stone].rotation().as_dquat() * DVec3::X;
            let ahead = scene.surface.world_from_model().rotation.conjugate() * ahead;
            assert!(ahead.with_y(0.0).z.abs() < 0.05, "tick {tick}: {ahead}");
        }
    }
    let travelled = scene.world.bodies[stone].translation().x;
    assert!(travelled > 8.0, "{travelled}");
    assert_eq!((scene.put_back, scene.caught), (0, 0));
}

#[test]
fn a_stone_slides_off_when_the_back_tilts_and_not_before() {
    let mut scene = Scene::new(slab(HALF, 0.6, 1));
    scene.ground(-12.0);
    let shape = ColliderBuilder::cuboid(0.4, 0.3, 0.5);
    let (stone, _) = scene.drop(shape, Vector::new(1.0, 0.81, 0.0));
    let mut slid_at = None;
    for tick in 0..900 {
        // The back tilts by 8 degrees a second up to 60; friction of 0.8 holds up to 38.7.
        let angle = (seconds(tick) * 8.0).min(60.0).to_radians();
        scene.tick(&rest(), at(DVec3::ZERO, DVec3::Z, angle));
        let off = (scene.in_model(stone) - DVec3::new(1.0, 0.8, 0.0)).length();
        if off > 0.1 && slid_at.is_none() {
            slid_at = Some(angle.to_degrees());
        }
    }
    let slid_at = slid_at.unwrap();
    assert!((34.0..45.0).contains(&slid_at), "{slid_at} degrees");
    let place = scene.world.bodies[stone].translation();
    assert!(place.y < -11.0, "{place}");
}

#[test]
fn settled_bodies_are_not_deep_in_the_skin() {
    let joints = 4;
    let mut scene = Scene::new(slab(Vec3::new(8.0, 1.0, 8.0), 0.7, joints));
    let mut rng = fastrand::Rng::with_seed(4);
    let mut all = Vec::new();
    for index in 0..24 {
        let size = 0.15 + rng.f32() * 0.4;
        let shape = match index % 4 {
            0 => ColliderBuilder::ball(size),
            1 => ColliderBuilder::cuboid(size, size * 0.6, size * 1.2),
            2 => ColliderBuilder::capsule_x(size * 2.0, size * 0.5),
            _ => ColliderBuilder::cylinder(size, size * 0.7),
        };
        let place = Vector::new(
            rng.f32() * 8.0 - 4.0,
            2.0 + rng.f32() * 6.0,
            rng.f32() * 8.0 - 4.0,
        );
        all.push(scene.drop(shape, place).0);
    }
    let palette = lifted(joints, |_| 0.0);
    for tick in 0..600 {
        // The back heaves for six seconds, then stands still.
        let t = seconds(tick).min(6.0);
        let heave = 0.3 * (1.0 - libm::cos(t * core::f64::consts::PI));
        scene.tick(&palette, at(DVec3::Y * heave, DVec3::Y, 0.0));
        for body in &all {
            let inside = scene.in_model(*body);
            let under = inside.y < 1.0 && inside.abs().with_y(0.0).max_element() < 8.0;
            assert!(!under, "tick {tick}: {inside}");
        }
    }
    let mut on_top = 0;
    for body in &all {
        let depth = scene.depth(*body, Vec3::new(8.0, 1.0, 8.0));
        assert!(depth < 0.02, "{depth} m deep");
        on_top += usize::from(depth > -0.02);
    }
    assert!(on_top >= 12, "{on_top} touch the skin");
}
