//! Two nearly opposite walls that close on the climber: a wedge that it cannot slip out of.

use clamber_climber::ClimberConfig;
use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use glam::DVec3;

use crate::cases::triples;
use crate::events::is_crushed;
use crate::input::IDLE;
use crate::stage::{Run, Shape, Stage, kinds, radians, within};

/// Half of the distance between the walls at a time: finally .15 m less than the ball needs.
fn half_gap(closing: f64, time: f64) -> f64 {
    (0.45 - closing * time).max(0.25)
}

/// Two walls, 1 m thick, above a floor. Each is turned by an angle so that they open along +X, and closes at a speed.
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

/// Checks the result for a climber between the walls at each angle and speed, on each kind of obstacle. Kinds are not
/// compared: rounding of a wall moves the place where both walls touch the ball by a hundred times as much.
fn in_wedges(check: impl Fn(&Pressed)) {
    let angles = [0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 13.0];
    for (closing, degrees, &played) in triples([0.4, 2.0], angles, kinds()) {
        let mut config = ClimberConfig::walker();
        config.ground.throw_acceleration = f64::INFINITY;
        let stage = wedge(Stage::new(played), radians(degrees), closing);
        let mut run = Run::new(stage, config, DVec3::ZERO).settle();
        let mut pressed = Pressed {
            case: format!("{played:?}, {degrees} degrees at {closing} m/s"),
            degrees,
            lacking: config.body.radius - half_gap(closing, 1.0),
            crushed: false,
            longest: 0.0,
        };
        for _ in 0..60 {
            let before = run.position();
            let report = run.step(&IDLE);
            pressed.crushed |= report.events.iter().any(is_crushed);
            pressed.longest = pressed.longest.max(run.position().distance(before));
        }
        check(&pressed);
    }
}

/// The result of a run between two walls.
struct Pressed {
    case: String,
    degrees: f64,
    /// Room that each wall finally takes from the ball, metres.
    lacking: f64,
    crushed: bool,
    /// Longest displacement of the climber in a tick, metres.
    longest: f64,
}

pub(crate) fn a_closing_wedge_crushes_alike_in_every_frame() {
    in_wedges(|pressed| {
        let Pressed { case, crushed, .. } = pressed;
        assert!(*crushed || pressed.degrees > 2.0, "{case}: not reported");
    });
}

pub(crate) fn a_closing_wedge_does_not_fling_the_climber_out() {
    in_wedges(|pressed| {
        let Pressed { case, longest, .. } = pressed;
        // More than four times the missing room would be a fling, not a push.
        within!(
            *longest,
            4.0 * pressed.lacking,
            "{case}: {longest} m in a tick"
        );
    });
}
