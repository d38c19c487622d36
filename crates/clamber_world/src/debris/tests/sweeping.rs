use glam::{DVec3, Vec3};
use rapier3d::prelude::*;

use super::scene::{DT, Scene, at, slab};
use crate::testing::rest;

/// Half the size of an arm, metres: the arm is 8 m long and 60 cm thick.
const ARM: Vec3 = Vec3::new(0.3, 0.5, 4.0);

fn shapes() -> [ColliderBuilder; 4] {
    [
        ColliderBuilder::ball(0.3),
        ColliderBuilder::ball(0.12),
        ColliderBuilder::cuboid(0.4, 0.25, 0.3),
        ColliderBuilder::capsule_z(1.5, 0.2),
    ]
}

#[test]
fn nothing_passes_through_an_arm_that_sweeps_at_up_to_60_metres_a_second() {
    for speed in [5.0, 12.0, 25.0, 40.0, 60.0] {
        let mut scene = Scene::new(slab(ARM, 0.4, 1));
        scene.ground(0.0);
        let mut all = Vec::new();
        for (row, shape) in shapes().into_iter().enumerate() {
            for place in 0..3 {
                let x = place as f32 * 1.7;
                let z = row as f32 * 1.6 - 2.4;
                let shape = shape.clone();
                all.push(scene.drop(shape, Vector::new(x, 0.5, z)).0);
            }
        }
        let place = |x: f64| at(DVec3::new(x, 0.55, 0.0), DVec3::Y, 0.0);
        // The bodies have landed when the arm comes.
        let wait = 60;
        let start = -3.0;
        scene.surface.teleport(&rest(), place(start)).unwrap();
        let ticks = (12.0 / (speed * DT)) as u32;
        for tick in 0..wait + ticks {
            let x = start + speed * DT * f64::from(tick.saturating_sub(wait));
            scene.tick(&rest(), place(x));
            for (index, body) in all.iter().enumerate() {
                let place = scene.in_model(*body);
                let beside = place.z.abs() > 3.9 || place.y > 0.4;
                let told = format!("{speed} m/s, tick {tick}, body {index}");
                assert!(place.x > 0.25 || beside, "{told}: {place} behind the skin");
            }
        }
        for body in &all {
            let moved = f64::from(scene.world.bodies[*body].linvel().x);
            let ahead = scene.in_model(*body);
            let swept = moved > 0.5 * speed || ahead.y > 0.4;
            assert!(swept, "{speed}: {moved} {ahead}");
        }
        assert_eq!(scene.caught, 0, "{speed}");
    }
}

#[test]
fn a_body_that_is_put_back_leaves_at_least_as_fast_as_the_skin() {
    let mut put_back = 0;
    for speed in [25.0, 40.0, 60.0] {
        for (index, shape) in shapes().into_iter().enumerate() {
            let mut scene = Scene::new(slab(ARM, 0.4, 1));
            scene.world.gravity = Vector::ZERO;
            let (body, _) = scene.drop(shape, Vector::new(2.0, 0.0, 0.2));
            let place = |x: f64| at(DVec3::new(x, 0.0, 0.0), DVec3::Y, 0.0);
            scene.surface.teleport(&rest(), place(-1.0)).unwrap();
            for tick in 1..20 {
                let x = -1.0 + speed * DT * f64::from(tick);
                let report = scene.tick(&rest(), place(x));
                if report.put_back > 0 {
                    put_back += report.put_back;
                    let moved = f64::from(scene.world.bodies[body].linvel().x);
                    let told = format!("{speed} m/s, body {index}, tick {tick}");
                    assert!(moved > speed * 0.99, "{told}: {moved}");
                }
            }
        }
    }
    assert!(put_back > 0);
}

#[test]
fn an_arm_that_swings_about_its_shoulder_lets_nothing_through() {
    // The far end, 8 m from the shoulder, moves at 60 m/s.
    let spin = 60.0 / 8.0;
    let mut scene = Scene::new(slab(ARM, 0.4, 1));
    scene.world.gravity = Vector::ZERO;
    let mut all = Vec::new();
    for (index, shape) in shapes().into_iter().enumerate() {
        for place in 0..4 {
            let radius = 2.0 + place as f64 * 1.6;
            let angle = 0.6 + index as f64 * 0.5;
            let (x, z) = (radius * libm::sin(angle), radius * libm::cos(angle));
            let place = Vector::new(x as f32, 0.0, z as f32);
            all.push(scene.drop(shape.clone(), place).0);
        }
    }
    for tick in 0..40 {
        let angle = (spin * DT * f64::from(tick)).min(3.0);
        let middle = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle)) * 4.0;
        scene.tick(&rest(), at(middle, DVec3::Y, angle));
        for (index, body) in all.iter().enumerate() {
            let place = scene.in_model(*body);
            let in_front = place.x > 0.25 || place.z.abs() > 3.9;
            assert!(in_front, "tick {tick}, body {index}: {place}");
        }
    }
    let speeds = all.iter().map(|b| scene.world.bodies[*b].linvel().length());
    let flung = speeds.filter(|speed| *speed > 10.0).count();
    assert!(flung >= 12, "{flung}");
}

#[test]
fn a_stacked_wall_stands_until_the_arm_comes() {
    let mut scene = Scene::new(slab(ARM, 0.4, 1));
    scene.ground(0.0);
    let mut wall = Vec::new();
    for layer in 0..5 {
        for stone in 0..5 {
            let shift = if layer % 2 == 0 { 0.0 } else { 0.4 };
            let (y, z) = (0.2 + 0.4 * layer as f32, stone as f32 * 0.8 - 2.0 + shift);
            let place = Vector::new(0.0, y, z);
            wall.push(scene.drop(ColliderBuilder::cuboid(0.25, 0.2, 0.4), place).0);
        }
    }
    // The arm is so low that nothing passes under it.
    let place = |x: f64| at(DVec3::new(x, 0.55, 0.0), DVec3::Y, 0.0);
    scene.surface.teleport(&rest(), place(-4.0)).unwrap();
    for _ in 0..120 {
        scene.tick(&rest(), place(-4.0));
    }
    let height = |scene: &Scene| {
        let heights = wall.iter().map(|b| scene.world.bodies[*b].translation().y);
        heights.fold(0.0, f32::max)
    };
    assert!((height(&scene) - 1.8).abs() < 0.05, "{}", height(&scene));
    for tick in 0..180 {
        let x = (-4.0 + 60.0 * DT * f64::from(tick)).min(4.0);
        let before: Vec<DVec3> = wall.iter().map(|stone| scene.in_model(*stone)).collect();
        scene.tick(&rest(), place(x));
        for (stone, before) in wall.iter().zip(before) {
            let place = scene.in_model(*stone);
            let through = scene.went_through(*stone, before, ARM);
            assert!(!through, "tick {tick}: from {before} to {place}");
        }
    }
    let places = wall.iter().map(|b| scene.world.bodies[*b].translation().x);
    let swept = places.filter(|x| *x > 3.0).count();
    assert!(swept >= 10, "{swept}");
}

#[test]
fn a_stone_that_falls_fast_stops_on_the_skin() {
    for speed in [5.0, 20.0, 60.0, 120.0] {
        let mut scene = Scene::new(slab(Vec3::new(4.0, 0.1, 4.0), 0.5, 1));
        let shapes = [
            ColliderBuilder::ball(0.1),
            ColliderBuilder::cuboid(0.1, 0.1, 0.3),
            ColliderBuilder::capsule_z(0.4, 0.08),
        ];
        let still = at(DVec3::ZERO, DVec3::Y, 0.0);
        scene.tick(&rest(), still);
        let mut all = Vec::new();
        for (index, shape) in shapes.into_iter().enumerate() {
            let (stone, _) = scene.drop(shape, Vector::new(index as f32 - 1.0, 5.0, 0.2));
            scene.world.bodies[stone].set_linvel(Vector::new(0.3, -speed, 0.0), true);
            all.push(stone);
        }
        for tick in 0..180 {
            scene.tick(&rest(), still);
            for stone in &all {
                let place = scene.in_model(*stone);
                let outside = place.y > 0.1 || place.x > 4.0;
                assert!(outside, "{speed} m/s, tick {tick}: {place}");
            }
        }
        for stone in &all {
            let depth = scene.depth(*stone, Vec3::new(4.0, 0.1, 4.0));
            assert!(depth < 0.02, "{speed}: {depth}");
        }
    }
}
