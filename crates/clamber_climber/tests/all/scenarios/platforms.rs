//! Moving ground.

use core::f64::consts::{PI, TAU};

use clamber_climber::ClimberMode::{Falling, Standing};
use clamber_surface::geometry::Similarity;
use glam::DVec3;

use crate::input::{IDLE, JUMP, walk};
use crate::scenarios::belt::Belt;
use crate::stage::{
    Played, Run, Shape, Stage, TICK, Trace, every, jolt, kinds, shifted, turned, walker_at, within,
};

/// Distance between the chord of one tick and the arc of a circle with a radius, at an angular speed.
pub(crate) fn chord(radius: f64, speed: f64) -> f64 {
    radius * (1.0 - libm::cos(speed * TICK * 0.5))
}

/// A climber that stands on a moving floor.
pub(crate) fn on(
    played: Played,
    half: f64,
    feet: DVec3,
    motion: impl Fn(f64) -> Similarity + 'static,
) -> Run {
    let stage = Stage::new(played).with(&Shape::floor(half), motion);
    Run::new(stage, jolt(), feet).settle()
}

/// The largest distance between a climber and its start position after the motion has moved that position.
pub(crate) fn drift(trace: &Trace, start: DVec3, motion: impl Fn(f64) -> Similarity) -> f64 {
    let local = motion(0.0).inverse_transform_point(start);
    let off = trace.positions.iter().enumerate().map(|(tick, p)| {
        let time = TICK * (tick as f64 + 1.0);
        motion(time).transform_point(local).distance(*p)
    });
    off.fold(0.0, f64::max)
}

/// Rides a platform without input. The climber stands all the time, and stays where it stood on the platform.
#[track_caller]
fn rides(
    mut run: Run,
    ticks: u32,
    allowed: f64,
    motion: impl Fn(f64) -> Similarity,
    told: &str,
) -> Trace {
    let (start, played) = (run.position(), run.stage.played());
    run.steps(ticks, &IDLE);
    assert!(run.trace.always(Standing), "{played:?}, {told}");
    let off = drift(&run.trace, start, motion);
    within!(off, allowed, "{played:?}, {told}: {off}");
    run.sound()
}

pub(crate) fn a_turning_platform_carries_without_lag() {
    let motion = |time: f64| turned(DVec3::Y, TAU * time);
    every(chord(9.0, TAU), |played| {
        let run = on(played, 10.0, DVec3::X * 9.0, motion);
        rides(run, 60, 1e-3, motion, "turns")
    });
}

/// A lift that goes up for a second, stops for half a second, and goes down for a second.
fn lift(speed: f64) -> impl Fn(f64) -> Similarity + Copy {
    move |time| {
        let up = time.min(1.0);
        let down = (time - 1.5).clamp(0.0, 1.0);
        shifted(DVec3::Y * (speed * (up - down)))
    }
}

pub(crate) fn a_lift_carries_up_and_down_at_any_speed() {
    for speed in [0.5, 5.0, 20.0] {
        let motion = lift(speed);
        every(0.0, |played| {
            let run = on(played, 5.0, DVec3::new(1.0, 0.0, 0.5), motion);
            rides(run, 180, 1e-4, motion, &format!("{speed} m/s"))
        });
    }
}

pub(crate) fn a_lift_that_reverses_in_one_tick_keeps_a_rider_with_sticky_feet() {
    for speed in [0.5, 5.0, 20.0] {
        let motion = move |time: f64| shifted(DVec3::Y * (speed * wave(time)));
        every(0.0, |played| {
            let run = on(played, 5.0, DVec3::X, motion);
            rides(run, 240, 1e-4, motion, &format!("{speed} m/s"))
        });
    }
}

/// Height of a lift that goes up for a second and down for a second, at 1 m/s.
fn wave(time: f64) -> f64 {
    let phase = time.rem_euclid(2.0);
    phase.min(2.0 - phase)
}

pub(crate) fn a_movable_platform_at_rest_is_like_ground() {
    let path = |played: Played, fixed: bool| {
        let floor = Shape::field(DVec3::new(-10.0, 0.0, -10.0), 1.0, [20, 20], |x, z| {
            0.1 * libm::sin(x) * libm::cos(z)
        });
        let stage = Stage::new(played);
        let stage = if fixed && played == Played::Body {
            stage.with_ground(&floor)
        } else {
            stage.with_still(&floor)
        };
        let mut run = Run::new(stage, walker_at(3.0), DVec3::Y * 0.2).settle();
        for tick in 0..240u32 {
            let angle = f64::from(tick / 40) * 1.3;
            let direction = DVec3::new(libm::cos(angle), 0.0, libm::sin(angle));
            // A held stage does not move the surface at all.
            if fixed {
                run.step_held(&walk(direction));
            } else {
                run.step(&walk(direction));
            }
        }
        run.sound()
    };
    for &played in kinds() {
        let (apart, tick) = path(played, true).apart(&path(played, false));
        within!(apart, 1e-5, "{played:?}: {apart} at tick {tick}");
    }
}

pub(crate) fn an_idle_rider_of_a_lift_stays_on_it() {
    let motion = |time: f64| shifted(DVec3::Y * (2.0 * libm::sin(3.0 * time)));
    every(0.0, |played| {
        let run = on(played, 3.0, DVec3::X, motion);
        rides(run, 600, 1e-4, motion, "goes up and down")
    });
}

type Platform = (&'static str, f64, fn(f64) -> Similarity);

/// Jolt's sample platforms. Each has a name, the difference between chord and arc at the rider, and a motion.
fn samples() -> Vec<Platform> {
    let radius = libm::sqrt(5.0);
    vec![
        ("turns to and fro", chord(radius, PI), |time| {
            turned(DVec3::Y, PI * libm::sin(time))
        }),
        ("goes in a circle and turns", chord(radius, PI), |time| {
            let mut pose = turned(DVec3::Y, PI * time);
            let angle = PI * time;
            pose.translation = DVec3::new(libm::cos(angle), 0.0, libm::sin(angle)) * 5.0;
            pose
        }),
        ("goes up and down", 0.0, |time| {
            shifted(DVec3::Y * (1.75 * libm::sin(time)))
        }),
        ("reverses", 0.0, |time| {
            let phase = (3.0 * time).rem_euclid(10.0);
            shifted(DVec3::X * phase.min(10.0 - phase))
        }),
    ]
}

pub(crate) fn a_minute_on_each_of_jolts_platforms() {
    for (name, chord, motion) in samples() {
        every(chord, |played| {
            let start = motion(0.0).transform_point(DVec3::new(2.0, 0.0, 1.0));
            rides(on(played, 5.0, start, motion), 3600, 1e-3, motion, name)
        });
    }
}

pub(crate) fn a_wall_that_comes_and_goes_pushes_but_does_not_pull() {
    every(0.0, |played| {
        let wall = Shape::boxed(DVec3::new(-2.0, 0.0, -3.0), DVec3::new(-1.0, 3.0, 3.0));
        let front = |time: f64| -1.0 + 3.0 * libm::sin(time);
        let stage = Stage::new(played)
            .with_still(&Shape::floor(20.0))
            .with(&wall, move |time| {
                shifted(DVec3::X * (3.0 * libm::sin(time)))
            });
        let mut run = Run::new(stage, jolt(), DVec3::ZERO).settle();
        let mut farthest = 0.0f64;
        for _ in 0..3600 {
            run.step(&IDLE);
            let p = run.position();
            let face = front(run.stage.time());
            let told = format!("{played:?}: {p} before a wall at {face}");
            assert!(p.x - face >= 0.32 - 1e-3, "{told}: in the wall");
            farthest = farthest.max(face);
            let ahead = (farthest + 0.32).max(0.0);
            assert!(p.x <= ahead + 1e-3, "{told}: flung");
            assert!((p.y - 0.32).abs() <= 1e-3 && p.z.abs() <= 1e-3, "{told}");
        }
        assert!(run.trace.always(Standing));
        run.sound()
    });
}

pub(crate) fn a_belt_carries_at_its_speed() {
    for &played in kinds() {
        let stage = Stage::new(played).with_still(&Shape::floor(20.0));
        let mut run = Run::new(stage, walker_at(1.0), DVec3::ZERO);
        let mut belt = Belt::new(DVec3::Z * 2.0);
        belt.rides(&mut run, &IDLE, 10);
        assert_eq!(run.mode(), Standing);
        let before = run.feet();
        belt.rides(&mut run, &IDLE, 60);
        let off = (run.feet() - before).distance(DVec3::Z * 2.0);
        within!(off, 1e-4, "{played:?}: off by {off}");
        let off = run.state().velocity.distance(DVec3::Z * 2.0);
        within!(off, 1e-4, "{played:?}: velocity off by {off}");
        // The climber walks on the belt.
        let before = run.feet();
        belt.rides(&mut run, &walk(DVec3::X), 60);
        let off = (run.feet() - before).distance(DVec3::new(1.0, 0.0, 2.0));
        within!(off, 1e-4, "{played:?}: off by {off}");
    }
}

pub(crate) fn a_diagonally_descending_platform_does_not_jitter() {
    let motion = |time: f64| shifted(DVec3::new(0.0, -3.0, -3.0) * time);
    every(0.0, |played| {
        let run = on(played, 5.0, DVec3::ZERO, motion);
        rides(run, 300, 1e-3, motion, "goes down")
    });
}

pub(crate) fn a_jump_off_a_lift_that_goes_down_leaves_it() {
    every(0.0, |played| {
        let mut config = jolt();
        config.ground.jump_speed = 3.0;
        let motion = |time: f64| shifted(DVec3::Y * (-3.0 * time));
        let stage = Stage::new(played).with(&Shape::floor(5.0), motion);
        let mut run = Run::new(stage, config, DVec3::ZERO).settle();
        run.steps(30, &IDLE);
        let height = run.position().y;
        run.step(&JUMP);
        assert_eq!(run.mode(), Falling);
        let speed = run.state().velocity.y;
        assert!((speed + 9.81 * TICK).abs() <= 1e-4, "{speed}");
        let mut ticks = 1;
        while run.mode() == Falling {
            run.step(&IDLE);
            ticks += 1;
            assert!(ticks < 60);
        }
        // At 3 m/s relative to the lift, the flight takes 2 v / g: 36.7 ticks.
        assert!(
            (36..=37).contains(&ticks),
            "{played:?}: {ticks} ticks in the air"
        );
        assert!(run.position().y < height);
        run.sound()
    });
}

/// A lift that goes up at a speed for a second, then down.
fn reverses(speed: f64) -> impl Fn(f64) -> Similarity + Copy {
    move |time| shifted(DVec3::Y * (speed * (time.min(1.0) - (time - 1.0).max(0.0))))
}

pub(crate) fn a_reversal_throws_a_free_rider_and_keeps_one_with_sticky_feet() {
    let speed = 2.4;
    every(0.0, |played| {
        let run = on(played, 5.0, DVec3::X, reverses(speed));
        rides(run, 150, 1e-4, reverses(speed), "reverses")
    });
    every(0.0, |played| {
        let mut config = jolt();
        config.ground.throw_acceleration = 20.0;
        let stage = Stage::new(played).with(&Shape::floor(5.0), reverses(speed));
        let mut run = Run::new(stage, config, DVec3::X).settle();
        run.steps(60, &IDLE);
        assert_eq!(run.mode(), Standing);
        let height = run.position().y;
        // The flight is ballistic from the tick of the reversal on.
        for tick in 1..=57u32 {
            run.step(&IDLE);
            assert_eq!(run.mode(), Falling, "{played:?}, tick {tick}");
            let ticks = f64::from(tick);
            let way = TICK * ticks * (speed - 9.81 * TICK * ticks * 0.5);
            let off = run.position().y - (height + way);
            within!(off.abs(), 1e-4, "{played:?}, tick {tick}: {off}");
        }
        // At 4.8 m/s relative to the platform, the flight takes 58.7 ticks.
        run.steps(2, &IDLE);
        assert_eq!(run.mode(), Standing, "{played:?}");
        run.sound()
    });
}

pub(crate) fn the_edge_of_a_fast_lift_does_not_push_sideways() {
    for (beyond, speed) in [(-0.05, 10.0), (0.0, 10.0), (0.1, 10.0), (0.1, 30.0)] {
        let motion = move |time: f64| shifted(DVec3::Y * (speed * time));
        every(0.0, |played| {
            // A ball that rests on the edge itself is a little lower.
            let run = on(played, 5.0, DVec3::new(5.0 + beyond, 0.0, 0.3), motion);
            rides(run, 120, 1e-3, motion, &format!("{beyond} m beyond"))
        });
    }
}

pub(crate) fn a_platform_that_starts_in_one_tick_takes_its_rider_along() {
    let motion = |time: f64| shifted(DVec3::X * (4.0 * (time - 0.5).max(0.0)));
    every(0.0, |played| {
        let run = on(played, 5.0, DVec3::ZERO, motion);
        rides(run, 120, 1e-5, motion, "starts")
    });
}
