//! Rocks that are spawned below the skin, as pieces that break off.

use glam::DVec3;
use rapier3d::prelude::*;

use super::{Does, Setting, Stage, settings, shapes};

/// A scene's name in messages.
fn told(shape: &ColliderBuilder, size: f32, depth: f64, (rate, frame, scale): Setting) -> String {
    let kind = shape.shape.shape_type();
    format!("{kind:?} of {size} m, {depth} radii deep, {rate} Hz, {frame} m/s, scale {scale}")
}

/// A creature on which rocks of a size lie.
fn stage(rate: u32, frame: DVec3, size: f32, scale: f64) -> Stage {
    let mut stage = Stage::new(rate, frame);
    let size = f64::from(size);
    stage.creature(7, DVec3::new(8.0, 4.0, 8.0) * size, scale);
    stage.pose(&[Does::IsPlaced(DVec3::ZERO)]);
    stage
}

#[test]
fn a_rock_of_which_something_shows_comes_out_and_lies_on_the_skin() {
    let mut settings = settings();
    for size in [0.02, 0.05, 0.3, 1.0, 5.0, 30.0] {
        for (shape, radius) in shapes(size) {
            for depth in [0.0, 0.02, 0.1, 0.3, 0.49, 0.51, 0.7, 0.97] {
                let setting @ (rate, frame, scale) = settings.next().unwrap();
                let case = told(&shape, size, depth, setting);
                let mut stage = stage(rate, frame, size, scale);
                let top = stage.creatures[0].half.y;
                let start = DVec3::new(0.3, 0.0, -0.4) * f64::from(size);
                // Skin has moved before the rock comes.
                for _ in 0..3 {
                    stage.tick(&case, &[Does::Moves(DVec3::ZERO)]);
                }
                let rock = stage.rock(&shape, start + DVec3::Y * (top - depth * radius));
                let (mut highest, mut last) = (f64::NEG_INFINITY, stage.place(rock));
                for tick in 0..3 * rate {
                    stage.tick(&case, &[Does::Moves(DVec3::ZERO)]);
                    let place = stage.place(rock);
                    let out = tick as f64 * stage.dt > 0.45;
                    let is_out = !stage.debris.is_put_out(rock) && place.y > top;
                    assert!(!out || is_out, "{case}: at {place} in tick {tick}");
                    if depth > 0.5 {
                        // A body that the skin reaches less deep into is put back in front of the skin at once.
                        let risen = (place.y - last.y) / stage.dt;
                        let most = radius / 0.2 * 1.2 + 1.0;
                        assert!(risen < most, "{case}: rises at {risen} m/s in tick {tick}");
                    }
                    highest = highest.max(place.y);
                    last = place;
                }
                let tall = f64::from(size) * 1.1 + 0.02;
                let [was, lies] = [highest, last.y].map(|y| y - top);
                assert!(was < 1.5 * tall, "{case}: was {was} over the skin");
                assert!(lies > 0.0 && lies < tall, "{case}: lies at {lies}");
                assert!(!stage.debris.is_let_through(rock), "{case}");
            }
        }
    }
}

#[test]
fn a_rock_of_which_nothing_shows_falls_through_the_creature() {
    let mut settings = settings();
    for size in [0.02, 0.05, 0.3, 5.0, 30.0] {
        for (shape, radius) in shapes(size) {
            for depth in [1.1, 2.0, 3.0] {
                let setting @ (rate, frame, scale) = settings.next().unwrap();
                let case = told(&shape, size, depth, setting);
                let mut stage = stage(rate, frame, size, scale);
                let top = stage.creatures[0].half.y;
                for _ in 0..3 {
                    stage.tick(&case, &[Does::Moves(DVec3::ZERO)]);
                }
                let rock = stage.rock(&shape, DVec3::Y * (top - depth * radius));
                let report = stage.tick(&case, &[Does::Moves(DVec3::ZERO)]);
                assert_eq!((report.enclosed, report.caught), (1, 1), "{case}");
                assert!(stage.debris.is_let_through(rock), "{case}");
                // The rock falls freely: through the creature, and then as far again.
                let seconds = (2.0 * 16.0 * f64::from(size) / 9.81).sqrt();
                for _ in 0..(seconds / stage.dt) as u32 {
                    let report = stage.tick(&case, &[Does::Moves(DVec3::ZERO)]);
                    assert_eq!(report.enclosed, 0, "{case}");
                }
                let place = stage.place(rock);
                assert!(place.y < -top - radius, "{case}: it is at {place}");
                assert!(!stage.debris.is_let_through(rock), "{case}");
            }
        }
    }
}

#[test]
fn a_rock_comes_out_of_the_side_that_is_nearest() {
    for (rate, frame, scale) in settings().take(12) {
        for way in [DVec3::X, DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z] {
            let case = format!("towards {way}, {rate} Hz, {frame} m/s, scale {scale}");
            let mut stage = stage(rate, frame, 0.4, scale);
            let half = stage.creatures[0].half;
            let (shape, radius) = shapes(0.4).remove(0);
            let start = way * (half.dot(way.abs()) - 0.8 * radius);
            let rock = stage.rock(&shape, start);
            for _ in 0..rate {
                stage.tick(&case, &[Does::Moves(DVec3::ZERO)]);
            }
            // The rock has fallen beside or below the creature.
            let place = stage.place(rock);
            let ahead = place.dot(way);
            let is_out = ahead > half.dot(way.abs()) + 0.9 * radius;
            assert!(is_out, "{case}: at {place}");
            let aside = (place - start).with_y(0.0) - way * (place - start).with_y(0.0).dot(way);
            assert!(aside.length() < 0.01, "{case}: at {place}");
        }
    }
}

#[test]
fn a_rock_with_a_velocity_of_its_own_keeps_it() {
    for rate in [30, 60, 240] {
        let case = format!("{rate} Hz");
        let mut stage = stage(rate, DVec3::X * 30.0, 0.3, 1.0);
        let top = stage.creatures[0].half.y;
        let (shape, radius) = shapes(0.3).remove(0);
        let rock = stage.rock(&shape, DVec3::Y * (top - 0.8 * radius));
        let own = stage.frame + DVec3::new(1.0, 6.0, 0.5);
        stage.world.bodies[rock].set_linvel(own.as_vec3(), true);
        let mut highest = f64::NEG_INFINITY;
        for _ in 0..rate {
            stage.tick(&case, &[Does::Moves(DVec3::ZERO)]);
            highest = highest.max(stage.place(rock).y - top);
        }
        // As high as a throw takes it: v^2 / 2 g, less its depth at the start.
        assert!((1.4..1.7).contains(&highest), "{case}: {highest} m high");
    }
}

#[test]
fn several_rocks_come_out_together() {
    for rate in [30, 60, 240] {
        let case = format!("{rate} Hz");
        let mut stage = stage(rate, DVec3::ZERO, 0.5, 1.0);
        let top = stage.creatures[0].half.y;
        let shapes = shapes(0.3);
        let rocks: Vec<_> = (0..12)
            .map(|number| {
                let (shape, radius) = &shapes[number % shapes.len()];
                let [row, column] = [number / 4, number % 4].map(|one| one as f64);
                let place = DVec3::new(0.62 * column - 0.9, 0.0, 0.62 * row - 0.6);
                let depth = 0.08 * number as f64;
                stage.rock(shape, place + DVec3::Y * (top - depth * radius))
            })
            .collect();
        for _ in 0..4 * rate {
            stage.tick(&case, &[Does::Moves(DVec3::ZERO)]);
            for rock in &rocks {
                let velocity = stage.velocity(*rock);
                assert!(velocity.length() < 4.0, "{case}: {velocity} m/s");
            }
        }
        for rock in rocks {
            let place = stage.place(rock);
            assert!(place.y > top && place.y < top + 0.7, "{case}: {place}");
        }
    }
}
