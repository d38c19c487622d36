//! Creatures that are spawned or placed where rocks lie.

use glam::DVec3;
use rapier3d::prelude::*;

use super::{Does, Stage, shapes};

/// Nine rocks of several shapes on the ground, around the origin.
fn nine(stage: &mut Stage, size: f32) -> Vec<RigidBodyHandle> {
    stage.ground(0.0);
    let shapes = shapes(size);
    let rocks = (0..9).map(|number| {
        let [row, column] = [number / 3, number % 3].map(|one| one as f64 - 1.0);
        let place = DVec3::new(column * 5.0, 1.1, row * 5.0) * f64::from(size);
        let (shape, _) = &shapes[number % shapes.len()];
        let rock = stage.rock(shape, place);
        // So that it comes to rest soon.
        let body = &mut stage.world.bodies[rock];
        body.set_angular_damping(9.0);
        // Rapier lets a body fall for a tick when it wakes.
        body.activation_mut().normalized_linear_threshold = -1.0;
        rock
    });
    rocks.collect()
}

/// How a creature comes to where rocks are.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    Placed,
    /// Placed, and then advanced, before debris sees it.
    PlacedAndMoved,
    /// The creature is new.
    Spawned,
}

/// All ways in which a creature comes.
const WAYS: [Way; 3] = [Way::Placed, Way::PlacedAndMoved, Way::Spawned];

#[test]
fn rocks_on_the_ground_are_let_through_by_a_creature_that_appears_there_and_walks_on() {
    let frames = [DVec3::ZERO, DVec3::Z * 30.0, DVec3::X * -30.0];
    let mut settings = [30, 60, 240].into_iter().zip(frames).cycle();
    for way in WAYS {
        for (size, scale) in [(0.05, 0.1), (0.3, 1.0), (2.0, 10.0)] {
            // The sole is in the ground, on it, and over it.
            for sole in [-0.4, 0.0, 0.4] {
                let (rate, frame) = settings.next().unwrap();
                let case = format!("{way:?}, {size} m, sole at {sole}, {rate} Hz, {frame} m/s");
                let unit = f64::from(size);
                let half = DVec3::new(20.0, 4.0, 20.0) * unit;
                let [far, here] = [120.0, 0.0].map(|x| {
                    let high = half.y + sole * unit;
                    DVec3::new(x * unit, high, 0.0)
                });
                let [(mut stage, rocks), (mut control, same)] = [0, 1].map(|_| {
                    let mut stage = Stage::new(rate, frame);
                    stage.creature(3, half, scale);
                    let rocks = nine(&mut stage, size);
                    stage.pose(&[Does::IsPlaced(far)]);
                    (stage, rocks)
                });
                for _ in 0..2 * rate {
                    let away = way == Way::Spawned;
                    let does = [Does::Moves(far), Does::IsAway][usize::from(away)];
                    stage.tick(&case, &[does]);
                    control.tick(&case, &[Does::IsAway]);
                }
                let mut does = Does::IsPlaced(here);
                if way == Way::PlacedAndMoved {
                    stage.pose(&[does]);
                    does = Does::Moves(here);
                }
                let report = stage.tick(&case, &[does]);
                assert_eq!((report.enclosed, report.caught), (9, 9), "{case}");
                control.tick(&case, &[Does::IsAway]);
                for _ in 0..rate {
                    let report = stage.tick(&case, &[Does::Moves(here)]);
                    assert_eq!((report.enclosed, report.caught), (0, 9), "{case}");
                    control.tick(&case, &[Does::IsAway]);
                }
                // The creature walks on, 30 sizes a second.
                for tick in 0..2 * rate {
                    let along = 30.0 * unit * stage.dt * f64::from(tick);
                    stage.tick(&case, &[Does::Moves(here + DVec3::X * along)]);
                    control.tick(&case, &[Does::IsAway]);
                }
                for (number, (rock, same)) in rocks.iter().zip(same).enumerate() {
                    assert!(!stage.debris.is_let_through(*rock), "{case}");
                    let off = stage.place(*rock) - control.place(same);
                    let is_near = off.length() < 0.1 * unit;
                    assert!(is_near, "{case}: rock {number} carried by {off}");
                }
            }
        }
    }
}

#[test]
fn rocks_under_the_back_of_a_creature_that_appears_come_out_on_it() {
    for way in WAYS {
        for (rate, frame) in [(30, DVec3::ZERO), (60, DVec3::X * 30.0), (240, DVec3::ZERO)] {
            let case = format!("{way:?}, {rate} Hz, {frame} m/s");
            let mut stage = Stage::new(rate, frame);
            stage.creature(3, DVec3::new(6.0, 2.0, 6.0), 1.0);
            stage.creature(1, DVec3::new(5.0, 1.0, 5.0), 1.0);
            let [lower, far, here] = [0.0, 50.0, -1.0].map(|y| DVec3::Y * y);
            stage.pose(&[Does::IsPlaced(far), Does::IsPlaced(lower)]);
            // The rocks rest on one creature. The other appears around it, 20 cm higher.
            let shapes = shapes(0.25);
            let rocks: Vec<_> = (0..8)
                .map(|number| {
                    let x = number as f64 - 3.5;
                    stage.rock(&shapes[number % 4].0, DVec3::new(x, 1.4, 0.0))
                })
                .collect();
            let calm = Does::Moves(lower);
            for _ in 0..2 * rate {
                let away = way == Way::Spawned;
                let does = [Does::Moves(far), Does::IsAway][usize::from(away)];
                stage.tick(&case, &[does, calm]);
            }
            let here = here + DVec3::Y * 0.2;
            if way == Way::PlacedAndMoved {
                stage.pose(&[Does::IsPlaced(here), calm]);
                stage.tick(&case, &[Does::Moves(here), calm]);
            } else {
                stage.tick(&case, &[Does::IsPlaced(here), calm]);
            }
            for _ in 0..3 * rate {
                stage.tick(&case, &[Does::Moves(here), calm]);
            }
            for rock in rocks {
                let place = stage.place(rock);
                assert!(!stage.debris.is_let_through(rock), "{case}");
                assert!(place.y > 1.2 && place.y < 1.5, "{case}: at {place}");
            }
        }
    }
}

#[test]
fn a_creature_that_is_placed_again_and_again_leaves_no_rock_inside() {
    for every in [1, 2, 3, 7, 20] {
        for rate in [30, 60, 240] {
            let case = format!("placed every {every} ticks, {rate} Hz");
            let mut stage = Stage::new(rate, DVec3::ZERO);
            stage.creature(3, DVec3::new(6.0, 1.0, 6.0), 1.0);
            let rocks = nine(&mut stage, 0.3);
            let higher = DVec3::new(0.4, 1.9, 0.3);
            for rock in &rocks {
                let body = &mut stage.world.bodies[*rock];
                let raised = body.translation() + Vector::Y * 1.4;
                if raised.x > 0.5 {
                    body.set_translation(raised, true);
                }
            }
            let places = [
                DVec3::Y,
                DVec3::new(1.0, 1.2, 0.0),
                DVec3::new(-3.0, 0.9, 2.0),
                DVec3::X * 40.0,
                higher,
            ];
            stage.pose(&[Does::IsPlaced(places[3])]);
            for tick in 0..400 {
                let place = places[tick / every % places.len()];
                let does = if tick % every == 0 {
                    Does::IsPlaced(place)
                } else {
                    Does::Moves(place)
                };
                stage.tick(&case, &[does]);
                for rock in &rocks {
                    let (place, velocity) = (stage.place(*rock), stage.velocity(*rock));
                    assert!(place.y > 0.0, "{case}: in the ground at {place}");
                    let slow = velocity.length() < 12.0;
                    assert!(slow, "{case}: {velocity} m/s in tick {tick}");
                }
            }
            for _ in 0..3 * rate {
                stage.tick(&case, &[Does::IsPlaced(places[3])]);
            }
            for rock in &rocks {
                let place = stage.place(*rock);
                assert!(place.y < 0.5, "{case}: it lies at {place}");
                assert!(!stage.debris.is_let_through(*rock), "{case}");
                assert!(!stage.debris.is_put_out(*rock), "{case}");
            }
        }
    }
}

#[test]
fn a_rock_that_sleeps_on_a_creature_falls_when_the_creature_is_placed_around_it() {
    for way in WAYS {
        for (rise, through) in [(0.4, false), (1.5, true)] {
            let case = format!("{way:?}, {rise} m higher");
            let mut stage = Stage::new(60, DVec3::ZERO);
            stage.creature(3, DVec3::new(4.0, 1.5, 4.0), 1.0);
            stage.creature(5, DVec3::new(5.0, 1.0, 5.0), 1.0);
            let [low, high] = [-0.5, -0.5 + rise].map(|y| DVec3::Y * y);
            stage.pose(&[Does::IsPlaced(low), Does::IsAway]);
            let (shape, _) = shapes(0.3).remove(0);
            let rock = stage.rock(&shape, DVec3::Y * 1.31);
            for _ in 0..400 {
                stage.tick(&case, &[Does::Moves(low), Does::IsAway]);
            }
            assert!(stage.world.bodies[rock].is_sleeping(), "{case}");
            match way {
                Way::Placed => stage.tick(&case, &[Does::IsPlaced(high), Does::IsAway]),
                Way::PlacedAndMoved => {
                    stage.pose(&[Does::IsPlaced(high), Does::IsAway]);
                    stage.tick(&case, &[Does::Moves(high), Does::IsAway])
                }
                Way::Spawned => {
                    stage.pose(&[Does::IsAway, Does::IsPlaced(high + DVec3::Y * 0.5)]);
                    stage.creatures.swap(0, 1);
                    let high = high + DVec3::Y * 0.5;
                    stage.tick(&case, &[Does::Moves(high), Does::IsAway])
                }
            };
            let here = high + DVec3::Y * [0.0, 0.5][usize::from(way == Way::Spawned)];
            for _ in 0..180 {
                stage.tick(&case, &[Does::Moves(here), Does::IsAway]);
            }
            let place = stage.place(rock);
            let top = 1.0 + rise;
            assert_eq!(place.y < -2.0, through, "{case}: {place}");
            let on_top = (place.y - top - 0.3).abs() < 0.01;
            assert!(through || on_top, "{case}: {place}");
        }
    }
}

#[test]
fn a_large_rock_and_a_small_creature_come_apart() {
    for way in WAYS {
        for rate in [30, 60, 240] {
            // In the tick in which skin is placed, it counts as standing still for bodies that it touches.
            let frame = DVec3::X * [0.0, 30.0][usize::from(way == Way::PlacedAndMoved)];
            for apart in [0.0, 0.05, 0.3, 0.6, 0.9, 1.05] {
                let case = format!("{way:?}, {rate} Hz, {frame} m/s, {apart} radii apart");
                let radius = 5.0;
                let mut stage = Stage::new(rate, frame);
                stage.world.gravity = Vector::ZERO;
                let half = DVec3::new(0.2, 0.15, 0.3);
                stage.creature(3, half, 0.1);
                let far = DVec3::X * 40.0;
                stage.pose(&[Does::IsPlaced(far)]);
                let rock = stage.rock(&ColliderBuilder::ball(radius), DVec3::ZERO);
                let away = [Does::Moves(far), Does::IsAway][usize::from(way == Way::Spawned)];
                stage.tick(&case, &[away]);
                let here = DVec3::new(0.6, 0.0, 0.8) * (apart * f64::from(radius));
                stage.pose(&[Does::IsPlaced(here)]);
                if way == Way::PlacedAndMoved {
                    stage.tick(&case, &[Does::Moves(here)]);
                } else {
                    stage.tick(&case, &[Does::IsPlaced(here)]);
                }
                for _ in 0..3 * rate {
                    stage.tick(&case, &[Does::Moves(here)]);
                }
                let off = stage.place(rock) - here;
                let gap = (off.abs() - half).max(DVec3::ZERO).length();
                let least = 0.97 * f64::from(radius);
                assert!(gap > least, "{case}: {gap} m from the middle");
                let passes = stage.debris.is_let_through(rock) || stage.debris.is_put_out(rock);
                assert!(!passes, "{case}");
                let speed = stage.velocity(rock).length();
                assert!(speed < 12.0, "{case}: {speed} m/s");
            }
        }
    }
}
