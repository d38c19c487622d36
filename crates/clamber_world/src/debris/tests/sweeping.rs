use glam::{DVec3, Vec3};
use rapier3d::prelude::*;

use super::scene::{DT, Scene, at, lifted, slab};

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
        let palette = lifted(1, |_| 0.0);
        // The bodies have landed when the arm comes.
        let wait = 60;
        let start = -3.0;
        scene
            .surface
            .place(&palette, at(DVec3::new(start, 0.55, 0.0), DVec3::Y, 0.0))
            .unwrap();
        let ticks = (12.0 / (speed * DT)) as u32;
        for tick in 0..wait + ticks {
            let x = start + speed * DT * f64::from(tick.saturating_sub(wait));
            scene.tick(&palette, at(DVec3::new(x, 0.55, 0.0), DVec3::Y, 0.0));
            for (index, body) in all.iter().enumerate() {
                let place = scene.in_model(*body);
                let beside = place.z.abs() > 3.9 || place.y > 0.4;
                assert!(
                    place.x > 0.25 || beside,
                    "{speed} m/s, tick {tick}, body {index}: {place} behind the skin"
                );
            }
        }
        for body in &all {
            let moved = scene.world.bodies[*body].linvel().x;
            let ahead = scene.in_model(*body);
            assert!(
                f64::from(moved) > 0.5 * speed || ahead.y > 0.4,
                "{speed}: {moved} {ahead}"
            );
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
            let palette = lifted(1, |_| 0.0);
            let start = at(DVec3::new(-1.0, 0.0, 0.0), DVec3::Y, 0.0);
            scene.surface.place(&palette, start).unwrap();
            for tick in 1..20 {
                let x = -1.0 + speed * DT * f64::from(tick);
                let report = scene.tick(&palette, at(DVec3::new(x, 0.0, 0.0), DVec3::Y, 0.0));
                if report.put_back > 0 {
                    put_back += report.put_back;
                    let moved = f64::from(scene.world.bodies[body].linvel().x);
                    assert!(
                        moved > speed * 0.99,
                        "{speed} m/s, body {index}, tick {tick}: {moved}"
                    );
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
            all.push(
                scene
                    .drop(shape.clone(), Vector::new(x as f32, 0.0, z as f32))
                    .0,
            );
        }
    }
    let palette = lifted(1, |_| 0.0);
    for tick in 0..40 {
        let angle = (spin * DT * f64::from(tick)).min(3.0);
        let middle = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle)) * 4.0;
        scene.tick(&palette, at(middle, DVec3::Y, angle));
        for (index, body) in all.iter().enumerate() {
            let place = scene.in_model(*body);
            let beside = place.z.abs() > 3.9;
            assert!(
                place.x > 0.25 || beside,
                "tick {tick}, body {index}: {place}"
            );
        }
    }
    let flung = all
        .iter()
        .filter(|body| scene.world.bodies[**body].linvel().length() > 10.0)
        .count();
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
            let place = Vector::new(
                0.0,
                0.2 + 0.4 * layer as f32,
                stone as f32 * 0.8 - 2.0 + shift,
            );
            wall.push(scene.drop(ColliderBuilder::cuboid(0.25, 0.2, 0.4), place).0);
        }
    }
    let palette = lifted(1, |_| 0.0);
    // The arm is so low that nothing passes under it.
    let stand = at(DVec3::new(-4.0, 0.55, 0.0), DVec3::Y, 0.0);
    scene.surface.place(&palette, stand).unwrap();
    for _ in 0..120 {
        scene.tick(&palette, stand);
    }
    let height = |scene: &Scene| {
        let heights = wall.iter().map(|b| scene.world.bodies[*b].translation().y);
        heights.fold(0.0, f32::max)
    };
    assert!((height(&scene) - 1.8).abs() < 0.05, "{}", height(&scene));
    for tick in 0..180 {
        let x = (-4.0 + 60.0 * DT * f64::from(tick)).min(4.0);
        let before: Vec<DVec3> = wall.iter().map(|stone| scene.in_model(*stone)).collect();
        scene.tick(&palette, at(DVec3::new(x, 0.55, 0.0), DVec3::Y, 0.0));
        for (stone, before) in wall.iter().zip(before) {
            let place = scene.in_model(*stone);
            let through = scene.went_through(*stone, before, ARM);
            assert!(!through, "tick {tick}: from {before} to {place}");
        }
    }
    let swept = wall
        .iter()
        .filter(|stone| scene.world.bodies[**stone].translation().x > 3.0)
        .count();
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
        let palette = lifted(1, |_| 0.0);
        let still = at(DVec3::ZERO, DVec3::Y, 0.0);
        scene.tick(&palette, still);
        let mut all = Vec::new();
        for (index, shape) in shapes.into_iter().enumerate() {
            let (stone, _) = scene.drop(shape, Vector::new(index as f32 - 1.0, 5.0, 0.2));
            scene.world.bodies[stone].set_linvel(Vector::new(0.3, -speed, 0.0), true);
            all.push(stone);
        }
        for tick in 0..180 {
            scene.tick(&palette, still);
            for stone in &all {
                let place = scene.in_model(*stone);
                assert!(
                    place.y > 0.1 || place.x > 4.0,
                    "{speed} m/s, tick {tick}: {place}"
                );
            }
        }
        for stone in &all {
            let depth = scene.depth(*stone, Vec3::new(4.0, 0.1, 4.0));
            assert!(depth < 0.02, "{speed}: {depth}");
        }
    }
}
