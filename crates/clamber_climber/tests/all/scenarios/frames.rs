//! Invariance: results do not depend on the world's place, on its motion as a whole, or on the numbering of its
//! triangles.

use core::f64::consts::{PI, TAU};

use clamber_climber::ClimberMode::{Falling, Standing};
use clamber_climber::{ClimberConfig, ClimberInput};
use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use glam::DVec3;

use crate::cases::pairs;
use crate::input::{IDLE, JUMP, walk};
use crate::scenarios::platforms::{chord, drift};
use crate::stage::{
    Played, Run, Shape, Stage, TICK, every, jolt, kinds, one_kind, shifted, turned, walker_at,
    within,
};

/// Hills with a wall on them.
pub(crate) fn hills() -> Shape {
    let field = Shape::field(DVec3::new(-8.0, 0.0, -8.0), 0.5, [32, 32], |x, z| {
        0.3 * libm::sin(1.3 * x) * libm::cos(0.9 * z)
    });
    field.and(Shape::boxed(
        DVec3::new(3.0, -1.0, -8.0),
        DVec3::new(3.5, 2.0, 8.0),
    ))
}

/// A walk around the hills, into the wall and along it, with jumps.
pub(crate) fn tour(tick: u32) -> ClimberInput {
    let direction = match tick / 60 {
        0 => DVec3::new(1.0, 0.0, 0.3),
        1 => DVec3::new(0.8, 0.0, -0.6),
        2 => DVec3::new(-0.5, 0.0, -1.0),
        3 => DVec3::ZERO,
        _ => DVec3::new(-0.3, 0.0, 1.0),
    };
    ClimberInput {
        jump: tick % 80 == 50,
        ..walk(direction)
    }
}

/// Length of the tour, ticks.
const TOUR: u32 = 300;

fn tour_of(stage: Stage) -> Run {
    let mut run = Run::new(stage, walker_at(3.0), DVec3::new(0.1, 0.4, -0.2)).settle();
    for tick in 0..TOUR {
        run.step(&tour(tick));
    }
    run
}

pub(crate) fn a_run_far_from_the_origin_matches_one_at_the_origin() {
    let origin = DVec3::new(1e7, -1e7, 1e7);
    for &played in kinds() {
        let tour = |origin: DVec3| {
            let motion = |time: f64| {
                let mut pose = turned(DVec3::Y, 0.5 * time);
                pose.translation = DVec3::Y * libm::sin(2.0 * time);
                pose
            };
            tour_of(Stage::at(played, TICK, origin).with(&hills(), motion)).sound()
        };
        let (apart, tick) = tour(origin).apart(&tour(DVec3::ZERO));
        within!(apart, 1e-3, "{played:?}: {apart} at tick {tick}");
    }
}

pub(crate) fn motion_of_the_whole_world_changes_nothing() {
    let still = tour_of(Stage::new(one_kind()).with_still(&hills())).sound();
    // Positions far from their origin are rounded more coarsely: a root has f64 and is not affected, a joint and a body
    // have f32 and are affected after some seconds.
    let (fast, slow) = (DVec3::new(7.0, 3.0, -11.0), DVec3::new(1.0, 0.5, -1.5));
    for (played, velocity) in [
        (Played::Root, fast),
        (Played::Root, slow),
        (Played::Joint, slow),
        (Played::Body, slow),
        (Played::Own, fast),
        (Played::Own, slow),
    ] {
        if !kinds().contains(&played) {
            continue;
        }
        let stage = Stage::new(played).with(&hills(), move |time| shifted(velocity * time));
        let mut moving = tour_of(stage).sound();
        for (tick, position) in moving.positions.iter_mut().enumerate() {
            *position -= velocity * (TICK * (tick as f64 + 1.0));
        }
        let (apart, tick) = moving.apart(&still);
        within!(apart, 1e-4, "{played:?}: {apart} at tick {tick}");
        assert_eq!(moving.modes, still.modes, "{played:?}");
    }
}

pub(crate) fn stairs_in_steady_motion_are_walked_like_stairs_at_rest() {
    let climb = |played: Played, velocity: DVec3| {
        let stairs = Shape::stairs(10, 0.3, 0.3, 2.0);
        let stage = Stage::new(played).with(&stairs, move |time| shifted(velocity * time));
        let mut run = Run::new(stage, walker_at(3.0), -DVec3::Z).settle();
        // The climber walks up, down a little, and up diagonally.
        run.steps(90, &walk(DVec3::Z));
        run.steps(30, &walk(-DVec3::Z));
        run.steps(60, &walk(DVec3::new(0.4, 0.0, 1.0)));
        let mut trace = run.sound();
        for (tick, position) in trace.positions.iter_mut().enumerate() {
            *position -= velocity * (TICK * (tick as f64 + 1.0));
        }
        trace
    };
    let still = climb(one_kind(), DVec3::ZERO);
    assert!(still.always(Standing));
    let velocities = [DVec3::new(1.0, 0.5, -1.5), DVec3::new(0.0, -2.0, 0.0)];
    for (&played, velocity) in pairs(kinds(), velocities) {
        let moving = climb(played, velocity);
        let (apart, tick) = moving.apart(&still);
        within!(
            apart,
            1e-4,
            "{played:?} at {velocity}: {apart} at tick {tick}"
        );
        assert_eq!(moving.modes, still.modes, "{played:?} at {velocity}");
    }
}

pub(crate) fn a_world_turned_by_any_angle_changes_nothing() {
    let still = tour_of(Stage::new(one_kind()).with_still(&hills())).sound();
    let axis = DVec3::new(1.0, 2.0, 3.0).normalize();
    for eighth in 1..=8 {
        let angle = TAU / 8.0 * f64::from(eighth);
        let turn = rotation_from_axis_angle(axis, angle);
        let config = ClimberConfig {
            gravity: turn * walker_at(3.0).gravity,
            ..walker_at(3.0)
        };
        for &played in kinds() {
            let stage = Stage::new(played).with(&hills(), move |_| turned(axis, angle));
            let up = turn * DVec3::Y;
            let start = turn * (DVec3::new(0.1, 0.4, -0.2) + DVec3::Y * 0.32) - up * 0.32;
            let mut run = Run::new(stage, config, start).settle();
            for tick in 0..TOUR {
                let input = tour(tick);
                run.step(&ClimberInput {
                    walk: turn * input.walk,
                    ..input
                });
            }
            let mut there = run.sound();
            for position in &mut there.positions {
                *position = turn.conjugate() * *position;
            }
            let (apart, tick) = there.apart(&still);
            within!(apart, 1e-4, "{played:?} at {angle}: {apart} at tick {tick}");
        }
    }
}

pub(crate) fn the_numbering_of_triangles_and_vertices_does_not_matter() {
    let plain = tour_of(Stage::new(one_kind()).with_still(&hills())).sound();
    let others = [
        ("renumbered", hills().renumbered(50)),
        ("renumbered anew", hills().renumbered(51)),
        ("split", hills().split()),
        ("split and renumbered", hills().split().renumbered(52)),
    ];
    for (name, shape) in others {
        for &played in kinds() {
            let other = tour_of(Stage::new(played).with_still(&shape)).sound();
            let (apart, tick) = other.apart(&plain);
            // A cast against a body may stop 0.1 mm before contact, and at another triangle.
            let allowed = if played == Played::Body { 1e-4 } else { 1e-6 };
            within!(apart, allowed, "{name}, {played:?}: {apart} at tick {tick}");
        }
    }
}

/// A motion in all six degrees of freedom.
fn storm(time: f64) -> Similarity {
    let pitch = rotation_from_axis_angle(DVec3::X, 0.2 * libm::sin(2.0 * time));
    let roll = rotation_from_axis_angle(DVec3::Z, 0.25 * libm::sin(1.7 * time));
    let yaw = rotation_from_axis_angle(DVec3::Y, 0.8 * time);
    Similarity {
        rotation: (yaw * pitch * roll).normalize(),
        scale: 1.0,
        translation: DVec3::new(
            3.0 * libm::sin(time),
            1.5 * libm::sin(2.3 * time),
            2.0 * libm::cos(0.7 * time),
        ),
    }
}

pub(crate) fn root_joint_and_body_carry_alike_through_a_storm() {
    // A rider is up to 8 m from the centre of rotation, at up to 1.3 rad/s.
    every(chord(8.0, 1.3), |played| {
        let stage = Stage::new(played).with(&Shape::floor(12.0), storm);
        let start = storm(0.0).translation + DVec3::new(2.0, 0.2, 1.0);
        let mut run = Run::new(stage, jolt(), start).settle();
        let start = run.position();
        run.steps(600, &IDLE);
        assert!(run.trace.always(Standing), "{played:?}");
        // Being alike is not enough: the carried position must also be right.
        let off = drift(&run.trace, start, storm);
        within!(off, 1e-3, "{played:?}");
        run.sound()
    });
}

/// A tour without jumps, and a run with a single jump. A joint's positions are rounded by 5e-7 m some metres from the
/// origin, which is 3e-5 m/s in the velocity of a jump. Each second in the air adds that to the difference between both
/// runs.
pub(crate) fn root_and_joint_carry_a_walker_alike_through_a_storm() {
    for (ticks, jump) in [(TOUR, None), (120, Some(50))] {
        let play = |played: Played| {
            let stage = Stage::new(played).with(&hills(), storm);
            let start = storm(0.0).translation + DVec3::new(0.1, 0.5, -0.2);
            let mut run = Run::new(stage, walker_at(3.0), start).settle();
            for tick in 0..ticks {
                run.step(&ClimberInput {
                    jump: jump == Some(tick),
                    ..tour(tick)
                });
            }
            assert_eq!(run.mode(), Standing, "{played:?}");
            assert_eq!(run.trace.always(Standing), jump.is_none(), "{played:?}");
            run.sound()
        };
        let first = play(one_kind());
        for &played in &kinds()[1..] {
            let tolerance = match played {
                Played::Body => 1e-4 + chord(8.0, 1.3),
                _ => 1e-4,
            };
            let (apart, tick) = first.apart(&play(played));
            within!(apart, tolerance, "{played:?}: {apart} at tick {tick}");
        }
    }
}

pub(crate) fn a_jump_on_steadily_moving_ground_lands_where_it_began() {
    for velocity in [DVec3::X * 30.0, DVec3::new(5.0, -8.0, 2.0)] {
        every(0.0, |played| {
            let motion = move |time: f64| shifted(velocity * time);
            let stage = Stage::new(played).with(&Shape::floor(5.0), motion);
            let mut run = Run::new(stage, jolt(), DVec3::X).settle();
            run.steps(30, &IDLE);
            run.step(&JUMP);
            assert_eq!(run.mode(), Falling);
            run.steps(90, &IDLE);
            assert_eq!(run.mode(), Standing);
            let local = run.feet() - velocity * run.stage.time();
            let off = local.distance(DVec3::X);
            within!(off, 1e-4, "{played:?} at {velocity}: {off}");
            run.sound()
        });
    }
}

pub(crate) fn a_full_turn_of_the_ground_ends_where_it_began() {
    every(chord(3.0, PI), |played| {
        let stage = Stage::new(played).with(&Shape::floor(5.0), |time| turned(DVec3::Y, PI * time));
        let mut run = Run::new(stage, jolt(), DVec3::X * 3.0).settle();
        let (position, heading) = (run.position(), run.state().heading);
        for tick in 0..120 {
            run.step(&IDLE);
            let turn = turned(DVec3::Y, PI * run.stage.time()).rotation;
            let off = run.state().heading.distance(turn * heading);
            within!(off, 1e-4, "{played:?}, tick {tick}: heading");
        }
        let off = run.position().distance(position);
        within!(off, 1e-4, "{played:?}: {off}");
        run.sound()
    });
}
