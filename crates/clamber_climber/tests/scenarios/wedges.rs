//! Walls that close on the climber, all but opposite: a wedge from which it cannot slip.

use clamber_climber::{ClimberConfig, ClimberEvent};
use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use glam::DVec3;

use crate::stage::{IDLE, Run, Shape, Stage, every, radians, within};

/// Half the way between the walls, at a time: in the end .15 m less than the ball needs.
fn half_gap(closing: f64, time: f64) -> f64 {
    (0.45 - closing * time).max(0.25)
}

/// Two walls of 1 m above a floor, each turned by an angle so that they open along +X; they close by a speed each.
fn wedge(stage: Stage, angle: f64, closing: f64) -> Stage {
    let wall = Shape::boxed(DVec3::new(-3.0, 0.05, -0.5), DVec3::new(3.0, 6.05, 0.5));
    let stage = stage.with_still(&Shape::floor(6.0));
    [-1.0, 1.0].into_iter().fold(stage, |stage, side| {
        stage.with(&wall, move |time| {
            let rotation = rotation_from_axis_angle(DVec3::Y, -side * angle);
            let inward = rotation * DVec3::Z * -side;
            let face = DVec3::Z * (side * half_gap(closing, time));
            Similarity {
                rotation,
                scale: 1.0,
                translation: face - inward * 0.5,
            }
        })
    })
}

pub(crate) fn a_wedge_that_closes_crushes_and_throws_nobody_out() {
    for closing in [0.4, 2.0] {
        for degrees in [0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 13.0] {
            // What rounds a wall moves the place where both touch the ball by so much more.
            every(1e-4 / libm::sin(radians(degrees)), |played| {
                let mut config = ClimberConfig::walker();
                config.ground.throw_acceleration = f64::INFINITY;
                let stage = wedge(Stage::new(played), radians(degrees), closing);
                let mut run = Run::new(stage, config, DVec3::ZERO).settle();
                let case = format!("{played:?}, {degrees} degrees at {closing} m/s");
                let (mut crushed, mut longest) = (false, 0.0f64);
                for _ in 0..60 {
                    let before = run.position();
                    let report = run.step(&IDLE);
                    let is_crushed =
                        |event: &ClimberEvent| matches!(event, ClimberEvent::Crushed { .. });
                    crushed |= report.events.iter().any(is_crushed);
                    let moved = run.position().distance(before);
                    longest = longest.max(moved);
                }
                assert!(crushed || degrees > 3.0, "{case}: not told as crushed");
                // Of the deepest overlap that the walls leave. Farther is thrown, not pushed.
                let most = 4.0 * (config.body.radius - half_gap(closing, 1.0));
                within!(longest, most, "{case}: by {longest} m in a tick");
                run.trace.clone()
            });
        }
    }
}
