//! Falling, walking, slopes.

use std::cell::RefCell;

use clamber_climber::ClimberConfig;
use clamber_climber::ClimberMode::{Falling, Sliding, Standing};
use clamber_surface::geometry::rotation_from_axis_angle;
use glam::DVec3;

use crate::events::{count, is_landed};
use crate::input::{IDLE, JUMP, walk};
use crate::stage::{
    Run, Shape, Stage, TICK, every, jolt, kinds, one_kind, radians, shifted, walker_at, within,
};

pub(crate) fn falls_lands_and_jumps() {
    every(0.0, |played| {
        let mut config = jolt();
        config.ground.jump_speed = 1.0;
        let stage = Stage::new(played).with_still(&Shape::floor(10.0));
        let mut run = Run::new(stage, config, DVec3::Y * 2.0);
        run.step(&IDLE);
        assert_eq!(run.mode(), Falling);
        run.steps(59, &IDLE);
        let landed = run.feet();
        assert_eq!(run.mode(), Standing);
        assert!(landed.length() <= 1e-6, "{played:?}: landed at {landed}");
        assert_eq!(run.state().velocity, DVec3::ZERO);
        run.step(&JUMP);
        assert_eq!(run.mode(), Falling);
        let off = run.state().velocity.y - (1.0 - 9.81 / 60.0);
        within!(off.abs(), 1e-12, "{off}");
        run.steps(59, &IDLE);
        let landed = run.feet();
        assert_eq!(run.mode(), Standing);
        assert!(landed.length() <= 1e-6, "{played:?}: landed at {landed}");
        run.sound()
    });
}

/// The climber is above the point that it stands on, as after a push or after letting go of a hold. The distance is too
/// small for it to look for new ground.
pub(crate) fn who_stands_above_its_point_goes_down_to_it() {
    for degrees in [0.0, 20.0, 40.0] {
        let angle = radians(degrees);
        every(0.0, |played| {
            let normal = DVec3::new(-libm::sin(angle), libm::cos(angle), 0.0);
            let stage = Stage::new(played).with_still(&slope(angle));
            let config = walker_at(2.0);
            let start = normal * config.body.radius - DVec3::Y * config.body.radius;
            let mut run = Run::new(stage, config, start).settle();
            let stood = run.position();
            let mut state = *run.state();
            state.position += normal * (0.095 * config.body.radius);
            let support = state.support.as_mut().unwrap();
            support.attachment = support.attachment.moved_to(state.position);
            run.put(state);
            let mut off = run.position().distance(stood);
            for tick in 0..30 {
                let report = run.step(&IDLE);
                let pushed = report.pushed_out.length();
                let told = format!("{degrees}, {played:?}, tick {tick}");
                assert!(pushed < 1e-6, "{told}: {pushed}");
                let now = run.position().distance(stood);
                assert_eq!(run.mode(), Standing, "{told}");
                assert!(now <= off + 1e-6, "{told}: {off} then {now}");
                off = now;
            }
            let told = format!("{degrees}, {played:?}: {off}");
            within!(off, config.body.margin + 1e-6, "{told}");
            run.sound()
        });
    }
}

/// A slope that rises along +X at an angle.
fn slope(angle: f64) -> Shape {
    Shape::floor(40.0).turned(DVec3::Z, angle)
}

pub(crate) fn slopes_are_stood_on_to_the_limit_and_slid_down_beyond() {
    for degrees in (5..=75).step_by(10) {
        let angle = radians(f64::from(degrees));
        every(0.0, |played| {
            let uphill = DVec3::new(libm::cos(angle), libm::sin(angle), 0.0);
            let normal = DVec3::new(-uphill.y, uphill.x, 0.0);
            let stage = Stage::new(played).with_still(&slope(angle));
            let config = walker_at(2.0);
            let start = normal * config.body.radius - DVec3::Y * config.body.radius;
            let mut run = Run::new(stage, config, start);
            if degrees > 50 {
                slides(&mut run, uphill, angle);
                return run.sound();
            }
            run.step(&IDLE);
            assert_eq!(run.mode(), Standing, "{degrees} degrees");
            let before = run.position();
            run.step(&IDLE);
            let slip = run.position().distance(before);
            within!(slip, 1e-5, "{degrees} degrees: slips {slip}");
            for along in [uphill, -uphill, DVec3::Z, (uphill + DVec3::Z).normalize()] {
                let before = run.position();
                let level = DVec3::new(along.x, 0.0, along.z).normalize();
                run.steps(90, &walk(level));
                let made = run.position() - before;
                // The way is along the slope, in the input's direction as seen from above.
                let rise = -level.dot(normal) / normal.y;
                let along = (level + DVec3::Y * rise).normalize();
                let off = made.distance(along * 3.0);
                within!(
                    off,
                    1e-4,
                    "{played:?}, {degrees} degrees: {made} is off by {off}"
                );
            }
            assert!(run.trace.always(Standing), "{degrees} degrees");
            run.sound()
        });
    }
}

/// Asserts that the climber slides down like a point mass under constant acceleration.
fn slides(run: &mut Run, uphill: DVec3, angle: f64) {
    let start = run.position();
    for tick in 1..=60u32 {
        run.step(&IDLE);
        assert_eq!(run.mode(), Sliding, "tick {tick}");
        let ticks = f64::from(tick);
        let way = 9.81 * libm::sin(angle) * TICK * TICK * ticks * ticks * 0.5;
        let off = run.position().distance(start - uphill * way);
        within!(off, 1e-4, "{angle} rad, tick {tick}: {off}");
        let speed = 9.81 * libm::sin(angle) * TICK * ticks;
        let off = run.state().velocity.distance(-uphill * speed);
        within!(off, 1e-4, "{angle} rad, tick {tick}: velocity off by {off}");
    }
}

/// Ground 10 m wide along X, through points by x and height.
fn strip(points: [(f64, f64); 3]) -> Shape {
    points.windows(2).fold(Shape::default(), |shape, ends| {
        let [(from, low), (to, high)] = [ends[0], ends[1]];
        shape.and(Shape::quad([
            DVec3::new(from, low, -5.0),
            DVec3::new(from, low, 5.0),
            DVec3::new(to, high, 5.0),
            DVec3::new(to, high, -5.0),
        ]))
    })
}

/// Ground that is level up to its origin, then goes down along +X at 45 degrees.
fn brink() -> Shape {
    strip([(-20.0, 0.0), (0.0, 0.0), (30.0, -30.0)])
}

pub(crate) fn a_run_downhill_sticks_to_the_floor_or_flies_off() {
    every(0.0, |played| {
        let mut run = Run::on(played, &brink(), walker_at(10.0), -DVec3::X);
        run.steps(90, &walk(DVec3::X));
        assert!(run.trace.always(Standing), "{played:?}");
        let radius = run.config().body.radius;
        for (tick, position) in run.trace.positions.iter().enumerate() {
            if position.x > 1.0 {
                let above = (position.x + position.y) / libm::sqrt(2.0) - radius;
                assert!(
                    above.abs() <= 1e-4,
                    "{played:?}, tick {tick}: {above} above"
                );
            }
        }
        assert!(run.position().x > 9.5, "{}", run.position());
        run.sound()
    });
    every(0.0, |played| {
        let mut config = walker_at(10.0);
        config.ground.snap_distance = 0.0;
        let mut run = Run::on(played, &brink(), config, -DVec3::X);
        while run.mode() == Standing {
            run.step(&walk(DVec3::X));
            assert!(run.position().x < 0.5, "still stands at {}", run.position());
        }
        let (from, speed) = (run.position(), run.state().velocity);
        assert!((speed.x - 10.0).abs() < 1e-4, "{speed}");
        for tick in 1..40u32 {
            run.step(&walk(DVec3::X));
            assert_eq!(run.mode(), Falling);
            let ticks = f64::from(tick);
            let fall = -9.81 * TICK * TICK * ticks * ticks * 0.5;
            let expected = from + speed * (TICK * ticks) + DVec3::Y * fall;
            let off = run.position().distance(expected);
            within!(off, 1e-4, "{played:?}, tick {tick}: {off}");
        }
        run.sound()
    });
}

/// Ground that is level up to 2 m along +X, then rises at an angle.
fn ramp(angle: f64) -> Shape {
    let (rise, run) = (30.0 * libm::sin(angle), 30.0 * libm::cos(angle));
    strip([(-10.0, 0.0), (2.0, 0.0), (2.0 + run, rise)])
}

/// Angle by which a slope may exceed the limit for a climber that stands already, radians.
const HYSTERESIS: f64 = 0.035;

pub(crate) fn a_slope_is_climbed_just_below_the_limit_and_not_just_above() {
    for (limit, climbs) in [(0.601, true), (0.599 - HYSTERESIS, false)] {
        every(0.0, |played| {
            let mut config = walker_at(6.0);
            config.body.height = 0.6;
            config.ground.max_slope = limit;
            config.ground.step_height = 0.0;
            let mut run = Run::on(played, &ramp(0.6), config, -DVec3::X * 4.0);
            run.steps(200, &walk(DVec3::X));
            let end = run.feet();
            if climbs {
                assert!(end.x > 6.0 && end.y > 3.0, "{played:?} ends at {end}");
            } else {
                assert!(end.x < 4.5 && end.y < 2.0, "{played:?} climbs to {end}");
            }
            let flying: Vec<_> = run.trace.modes.iter().map(|m| *m != Standing).collect();
            let many = flying.iter().filter(|f| **f).count();
            assert!(many <= 3, "{played:?}: {many} ticks in the air");
            assert!(!flying.windows(2).any(|two| two[0] && two[1]));
            run.sound()
        });
    }
}

pub(crate) fn ten_thousand_steps_stay_on_the_ground() {
    for &played in kinds() {
        let stage = Stage::new(played).with_still(&Shape::floor(1001.0));
        let config = walker_at(0.1 * libm::sqrt(2.0) / TICK);
        let start = DVec3::new(-500.0, 0.0, -500.0);
        let mut run = Run::new(stage, config, start).settle();
        run.steps(10_000, &walk(DVec3::new(1.0, 0.0, 1.0)));
        assert!(run.trace.always(Standing), "{played:?}");
        let made = run.feet() - start;
        let least = made.x.min(made.z);
        assert!(least >= 999.0, "{played:?}: travelled {made}");
        run.sound();
    }
}

pub(crate) fn any_direction_is_up() {
    let ups = [
        -DVec3::Y,
        DVec3::X,
        DVec3::new(1.0, 2.0, -3.0).normalize(),
        DVec3::new(-5.0, -1.0, 0.5).normalize(),
    ];
    for up in ups {
        every(0.0, |played| {
            let axis = DVec3::Y.cross(up).normalize_or(DVec3::X);
            let angle = libm::acos(DVec3::Y.dot(up));
            let turn = rotation_from_axis_angle(axis, angle);
            let config = ClimberConfig {
                gravity: up * -9.81,
                ..walker_at(3.0)
            };
            let floor = Shape::floor(10.0).turned(axis, angle);
            let stage = Stage::new(played).with_still(&floor);
            let mut run = Run::new(stage, config, up * 0.5);
            run.steps(40, &IDLE);
            assert_eq!(run.mode(), Standing, "up is {up}");
            assert!(run.feet().length() < 1e-5, "up is {up}: {}", run.feet());
            let before = run.trace.modes.len();
            run.steps(60, &walk(turn * DVec3::X));
            assert!(run.trace.modes[before..].iter().all(|m| *m == Standing));
            let off = run.feet().distance(turn * DVec3::X * 3.0);
            assert!(off < 1e-4, "up is {up}: off by {off}");
            run.sound()
        });
    }
}

pub(crate) fn a_walk_on_a_flat_box_keeps_its_height() {
    every(0.0, |played| {
        let mut config = walker_at(9.0);
        config.gravity = DVec3::Y * -30.0;
        config.body.radius = 0.36;
        config.body.margin = 0.01;
        config.body.height = 1.5;
        let stage = Stage::at_rate(played, 30.0).with_still(&Shape::floor(15.0));
        let mut run = Run::new(stage, config, DVec3::new(-7.0, 0.0, -7.0)).settle();
        let mut height = run.position().y;
        for tick in 0..90u32 {
            // The climber walks diagonally across the box, with two turns.
            let angle = 0.7 + f64::from(tick / 30) * 2.2;
            run.step(&walk(DVec3::new(libm::cos(angle), 0.0, libm::sin(angle))));
            let jump = (run.position().y - height).abs();
            within!(jump, 1e-4, "{played:?}, tick {tick}: by {jump}");
            height = run.position().y;
        }
        assert!(run.trace.always(Standing));
        run.sound()
    });
}

pub(crate) fn a_walk_of_a_metre_a_second_is_exact_at_any_tick_rate() {
    for rate in [24, 30, 50, 60] {
        every(0.0, |played| {
            let stage = Stage::at_rate(played, f64::from(rate)).with_still(&Shape::floor(10.0));
            let mut run = Run::new(stage, walker_at(1.0), DVec3::ZERO).settle();
            run.steps(rate, &walk(DVec3::Z));
            let off = run.feet().distance(DVec3::Z);
            within!(off, 1e-3, "{rate} Hz: off by {off}");
            run.sound()
        });
    }
}

pub(crate) fn a_long_tick_keeps_the_velocity_up_to_the_obstacle() {
    every(0.0, |played| {
        let mut config = jolt();
        config.gravity = DVec3::ZERO;
        let wall = Shape::boxed(DVec3::new(17.0, -5.0, -5.0), DVec3::new(18.0, 5.0, 5.0));
        let stage = Stage::at(played, 0.25, DVec3::ZERO).with_still(&wall);
        let mut run = Run::new(stage, config, DVec3::ZERO).thrown(DVec3::X * 20.0);
        for tick in 1..=3 {
            run.step(&IDLE);
            let off = run.position().x - 5.0 * f64::from(tick);
            assert!(off.abs() < 1e-9, "{off}");
            assert_eq!(run.state().velocity, DVec3::X * 20.0);
        }
        run.steps(3, &IDLE);
        let off = run.position().x - (17.0 - 0.32);
        within!(off.abs(), 1e-6, "{played:?}: {off} m from the wall");
        assert!(run.state().velocity.x.abs() < 1e-9);
        run.sound()
    });
}

/// The floor counts as moving, though it stays in place.
pub(crate) fn a_landing_is_reported_once() {
    let still = |_| shifted(DVec3::ZERO);
    let stage = Stage::new(one_kind()).with(&Shape::floor(10.0), still);
    let mut run = Run::new(stage, jolt(), DVec3::Y);
    run.steps(90, &IDLE);
    assert_eq!(count(&run.trace.events, is_landed), 1);
}

/// Height of the apex of a parabola through the highest three positions.
fn apex(heights: &[f64]) -> f64 {
    let highest = (1..heights.len() - 1).max_by(|a, b| heights[*a].total_cmp(&heights[*b]));
    let top = highest.unwrap_or(1);
    let (before, at, after) = (heights[top - 1], heights[top], heights[top + 1]);
    let bend = before - 2.0 * at + after;
    at - (after - before) * (after - before) / (8.0 * bend)
}

pub(crate) fn a_jump_is_as_high_at_any_rate() {
    // The relative error of the height, for each rate and kind.
    let found = RefCell::new(Vec::new());
    for rate in [30, 60, 120, 240] {
        every(0.0, |played| {
            let stage = Stage::at_rate(played, f64::from(rate)).with_still(&Shape::floor(10.0));
            let mut run = Run::new(stage, jolt(), DVec3::ZERO).settle();
            let start = run.position().y;
            run.step(&JUMP);
            run.steps(rate, &IDLE);
            let heights = run.trace.heights().map(|y| y - start);
            let heights: Vec<f64> = [0.0].into_iter().chain(heights).collect();
            let speed = run.config().ground.jump_speed;
            let expected = speed * speed / (2.0 * 9.81);
            found
                .borrow_mut()
                .push((rate, apex(&heights) / expected - 1.0));
            run.sound()
        });
    }
    let found = found.take();
    let worst = found.iter().map(|(_, off)| off.abs()).fold(0.0, f64::max);
    within!(worst, 1e-3, "{found:?}");
}
