//! Ice, mud, wet fur, and frictions out of range.

use clamber_climber::ClimberMode::{Falling, Holding, Standing};
use clamber_climber::{ClimberConfig, ContactRule};
use glam::DVec3;

use super::scene::{Case, G, ODD, at_every_rate, at_wall, but, person, wall};
use crate::input::{HOLD, IDLE, JUMP, grip_climb, walk};
use crate::stage::{Run, Shape, radians, shifted, turned, within};

/// A walker at rest on a floor with a friction.
fn on_floor(case: Case, floor: &Shape, friction: f64) -> Run {
    let stage = case.stage().numbered(ODD).with_still(floor);
    let mut run = Run::new(stage, ClimberConfig::walker(), DVec3::ZERO).settle();
    run.set_rule(but(move |query| query.usual().with_friction(friction)));
    run
}

/// A climber at a wall that it can grip, with a friction.
fn on_wall(case: Case, friction: f64) -> Run {
    let mut run = at_wall(case.stage().numbered(ODD).with_still(&wall(-9.0, 9.0)), 0.0);
    run.set_rule(but(move |_| ContactRule::GRIP.with_friction(friction)));
    run
}

pub(crate) fn ice_accelerates_and_brakes_slowly() {
    let pull = 0.1 * 15.0;
    at_every_rate(|case| {
        let mut run = on_floor(case, &Shape::floor(9.0), 0.1);
        let start = run.position().x;
        run.steps(case.ticks(1.0), &walk(DVec3::X));
        let (went, speed) = (run.position().x - start, run.state().velocity.x);
        within!((speed - pull).abs(), 1e-3, "{case}: {speed} m/s");
        within!((went - pull / 2.0).abs(), 1e-3, "{case}: went {went} m");
        run.steps(case.ticks(1.5), &IDLE);
        let went = run.position().x - start;
        within!((went - pull).abs(), 5e-3, "{case}: rests at {went} m");
        let state = run.state();
        assert_eq!(state.velocity.x, state.base_velocity.x, "{case}");
        run.sound()
    });
}

/// Ice that is pulled away below a climber, or turns, moves the climber by its friction alone.
pub(crate) fn ice_that_moves_takes_along_by_friction_alone() {
    // Half of the square of the time after the first second, in which the climber comes to rest.
    let half_square = |time: f64| 0.5 * (time - 1.0).max(0.0) * (time - 1.0).max(0.0);
    for (friction, turns) in [(0.0, false), (0.1, false), (0.0, true)] {
        at_every_rate(|at| {
            let case = format!("{at}, friction {friction}, turns {turns}");
            let stage = at
                .stage()
                .numbered(ODD)
                .with(&Shape::floor(9.0), move |time| {
                    if turns {
                        turned(DVec3::Y, half_square(time))
                    } else {
                        shifted(DVec3::X * (5.0 * half_square(time)))
                    }
                });
            let mut run = Run::new(stage, ClimberConfig::walker(), DVec3::X * 2.0);
            run.set_rule(but(move |query| query.usual().with_friction(friction)));
            run.steps(at.ticks(1.0), &IDLE);
            assert_eq!(run.mode(), Standing, "{case}");
            let start = run.position();
            run.steps(at.ticks(1.5), &IDLE);
            let pull = friction * 15.0;
            let (went, speed) = (
                run.position() - start,
                run.state().velocity - DVec3::X * (pull * 1.5),
            );
            let off = (went - DVec3::X * (pull * 1.5 * 1.5 / 2.0)).length();
            within!(speed.length(), 1e-4, "{case}: {speed} m/s off");
            within!(off, 1e-4, "{case}: went {went}");
            run.sound()
        });
    }
}

pub(crate) fn an_icy_slope_pulls_down() {
    let angle = radians(20.0);
    let floor = Shape::floor(30.0).turned(DVec3::Z, angle);
    for (friction, jumps) in [(0.0, false), (0.1, false), (0.5, false), (0.1, true)] {
        at_every_rate(|at| {
            let case = format!("{at}, friction {friction}");
            let mut run = on_floor(at, &floor, friction);
            let start = run.position();
            let pull = (G * libm::sin(angle) - friction * 15.0).max(0.0);
            run.steps(at.ticks(1.0), &IDLE);
            assert!(run.trace.always(Standing), "{case}");
            let (went, speed) = (
                run.position().distance(start),
                run.state().velocity.length(),
            );
            within!((speed - pull).abs(), 2e-3, "{case}: {speed} m/s");
            within!((went - pull / 2.0).abs(), 2e-3, "{case}: went {went} m");
            if jumps {
                run.step(&JUMP);
                assert_eq!(run.mode(), Falling, "{case}");
            }
            run.sound()
        });
    }
}

pub(crate) fn mud_slows_a_walk() {
    at_every_rate(|case| {
        let mut run = on_floor(case, &Shape::floor(9.0), 3.0);
        let start = run.position().x;
        run.steps(case.ticks(1.0), &walk(DVec3::X));
        let went = run.position().x - start;
        within!((went - 1.0).abs(), 1e-3, "{case}: went {went} m");
        run.sound()
    });
}

pub(crate) fn wet_fur_slips_through_hands() {
    let climb_speed = person().grip.unwrap().climb_speed;
    for (climb, rise) in [(0.0, -0.5), (1.0, 0.5), (0.5, 0.0), (-1.0, -1.5)] {
        at_every_rate(|at| {
            let case = format!("{at}, {climb}");
            let stage = at.stage().numbered(ODD).with_still(&wall(-9.0, 9.0));
            let mut run = at_wall(stage, 0.0);
            run.set_rule(but(|_| ContactRule::GRIP));
            run.steps(at.ticks(0.5), &HOLD);
            assert_eq!(run.mode(), Holding, "{case}");
            run.set_rule(but(|_| ContactRule::GRIP.with_friction(0.5)));
            let start = run.position().y;
            let input = grip_climb(DVec3::Y * climb);
            run.steps(at.ticks(1.0), &input);
            let mut modes = run.trace.modes[1..].iter();
            assert!(modes.all(|mode| *mode == Holding), "{case}");
            let rose = run.position().y - start;
            let off = (rose - rise * climb_speed).abs();
            within!(off, 2e-3, "{case}: rose {rose}");
            run.sound()
        });
    }
}

/// Walks, jumps and stops on a floor, and climbs along a wall, with a friction.
fn plays(case: Case, friction: f64) -> [Run; 2] {
    let mut walks = on_floor(case, &Shape::floor(9.0), friction);
    let mut climbs = on_wall(case, friction);
    walks.steps(case.ticks(0.5), &walk(DVec3::X));
    walks.step(&JUMP);
    walks.steps(case.ticks(1.5), &IDLE);
    let up = grip_climb(DVec3::new(0.6, 0.8, 0.0));
    climbs.steps(case.ticks(0.5), &up);
    [walks, climbs]
}

pub(crate) fn a_friction_out_of_range_counts_as_0_or_as_usual() {
    for (given, used) in [
        (-2.0, 0.0),
        (-0.0, 0.0),
        (-f64::MIN_POSITIVE, 0.0),
        (f64::MIN, 0.0),
        (f64::NAN, 1.0),
        (-f64::NAN, 1.0),
        (f64::INFINITY, 1.0),
        (f64::NEG_INFINITY, 1.0),
    ] {
        at_every_rate(|at| {
            let case = format!("{at}, {given}");
            let runs = plays(at, given);
            for (run, other) in runs.iter().zip(plays(at, used)) {
                let states = [run, &other].map(|run| run.climber.state().fingerprint());
                assert_eq!(states[0], states[1], "{case}: {:?}", run.state());
                assert_eq!(run.trace.events, other.trace.events, "{case}");
            }
            let [walks, climbs] = runs;
            climbs.sound();
            walks.sound()
        });
    }
}

/// Even the largest friction does not overflow: the climber stays where it is, and slides and tumbles to rest.
pub(crate) fn the_stickiest_mud_holds_fast() {
    let steep = Shape::floor(30.0).turned(DVec3::Z, radians(60.0));
    for friction in [1e9, 1e300, f64::MAX] {
        at_every_rate(|at| {
            let case = format!("{at}, {friction}");
            let stays = |run: &Run, start: DVec3, what: &str| {
                let moved = run.position().distance(start);
                within!(moved, 1e-3, "{case}: {what} {moved} m");
            };
            let mut walks = on_floor(at, &Shape::floor(9.0), friction);
            let start = walks.position();
            walks.steps(at.ticks(0.5), &walk(DVec3::X));
            stays(&walks, start, "walks");
            let mut climbs = on_wall(at, friction);
            climbs.steps(at.ticks(0.5), &HOLD);
            let start = climbs.position();
            let up = grip_climb(DVec3::Y);
            climbs.steps(at.ticks(0.5), &up);
            stays(&climbs, start, "climbs");
            climbs.sound();
            // Down a slope, the climber slides by at most a tenth of gravity's effect, which friction leaves.
            let mut config = person();
            config.ground.slide_friction = 0.5;
            let stage = at.stage().numbered(ODD).with_still(&steep);
            let mut slides = Run::new(stage, config, DVec3::ZERO);
            slides.set_rule(but(move |query| query.usual().with_friction(friction)));
            slides.steps(at.ticks(0.5), &IDLE);
            let speed = slides.state().velocity.length();
            assert!(speed < 0.1 * G, "{case}: slides at {speed} m/s");
            slides.sound();
            walks.sound()
        });
    }
}
