//! One-way platforms and doors.

use std::cell::Cell;
use std::rc::Rc;

use clamber_climber::ClimberMode::{Falling, Standing};
use clamber_climber::{ClimberConfig, ContactRule};
use clamber_world::ObstacleId;
use glam::DVec3;

use super::scene::{Case, G, ODD, RADIUS, at_every_rate, but};
use crate::input::{IDLE, JUMP, high_jump, walk};
use crate::stage::{Run, Shape, Trace, shifted, within};

/// A plate of 6 cm and a sheet without thickness, with their tops at height 1.
fn platforms() -> [Shape; 2] {
    let corner = |x: f64, z: f64| DVec3::new(x, 1.0, z);
    let sheet = [
        corner(-3.0, -3.0),
        corner(-3.0, 3.0),
        corner(3.0, 3.0),
        corner(3.0, -3.0),
    ];
    let plate = Shape::boxed(DVec3::new(-3.0, 0.94, -3.0), corner(3.0, 3.0));
    [plate, Shape::quad(sheet)]
}

/// Jumps through a platform, stands and walks on it, and drops through it. A body with a height reaches through the
/// platform before it jumps.
fn through_and_back(
    case: Case,
    (platform, height): (&Shape, f64),
    motion: fn(f64) -> DVec3,
) -> Trace {
    let stage = case
        .stage()
        .with_still(&Shape::floor(9.0))
        .numbered(ODD)
        .with(platform, move |time| shifted(motion(time)));
    let mut config = ClimberConfig::walker();
    config.ground.jump_speed = 5.5;
    config.body.height = height;
    let mut run = Run::new(stage, config, DVec3::ZERO);
    let drops = Rc::new(Cell::new(false));
    let key = Rc::clone(&drops);
    run.set_rule(but(move |query| {
        if key.get() {
            ContactRule::PASS
        } else {
            query.one_way()
        }
    }));
    let mut run = run.settle();
    run.step(&JUMP);
    run.steps(case.ticks(1.5), &high_jump(false));
    let heights = run.trace.positions.iter().map(|at| at.y - RADIUS);
    let top = heights.fold(0.0, f64::max);
    let apex = 5.5 * 5.5 / (2.0 * G);
    let dt = 1.0 / case.rate;
    within!(
        (top - apex).abs(),
        G * dt * dt / 8.0 + 1e-4,
        "{case}: rose to {top} of {apex}"
    );
    let stands = |run: &Run| {
        let off = run.feet().y - 1.0 - motion(run.stage.time()).y;
        assert_eq!(run.mode(), Standing, "{case} at {}", run.feet());
        within!(off.abs(), 1e-3, "{case}: stands at {}", run.feet());
    };
    stands(&run);
    for tick in 0..case.ticks(1.0) {
        let side = if tick < case.ticks(0.5) { 1.0 } else { -1.0 };
        run.step(&walk(DVec3::X * side));
        stands(&run);
    }
    drops.set(true);
    run.step(&IDLE);
    assert_eq!(run.mode(), Falling, "{case}");
    run.steps(case.ticks(0.1), &IDLE);
    drops.set(false);
    run.steps(case.ticks(1.4), &IDLE);
    assert_eq!(run.mode(), Standing, "{case}");
    let feet = run.feet();
    within!(feet.y.abs(), 1e-3, "{case}: dropped to {feet}");
    run.sound()
}

pub(crate) fn a_one_way_platform_is_jumped_through_stood_on_and_dropped_through() {
    for (platform, height) in platforms().iter().zip([0.0, 0.8]) {
        at_every_rate(|case| through_and_back(case, (platform, height), |_| DVec3::ZERO));
    }
}

pub(crate) fn a_one_way_platform_that_moves_is_boarded_from_below() {
    let sways = |time: f64| DVec3::new(0.3 * time, 0.1 * libm::sin(2.0 * time), 0.0);
    for (platform, height) in platforms().iter().zip([0.8, 0.0]) {
        at_every_rate(|case| through_and_back(case, (platform, height), sways));
    }
}

/// A door 20 cm thick.
fn door() -> Shape {
    Shape::boxed(DVec3::new(1.0, 0.0, -2.0), DVec3::new(1.2, 3.0, 2.0))
}

/// Walks at a door, as a climber with an id.
fn at_door(case: Case, id: u64) -> Run {
    let stage = case
        .stage()
        .with_still(&Shape::floor(9.0))
        .numbered(ODD)
        .with_still(&door());
    let mut config = ClimberConfig::walker();
    config.body.height = 1.0;
    let mut run = Run::new(stage, config, DVec3::ZERO).settle();
    run.id = Some(ObstacleId(id));
    run.set_rule(but(|query| {
        if query.climber == Some(ObstacleId(7)) {
            ContactRule::PASS
        } else {
            query.usual()
        }
    }));
    run.steps(case.ticks(1.0), &walk(DVec3::X));
    run
}

pub(crate) fn a_door_lets_one_pass_and_not_another() {
    for (id, ends) in [(7, 3.0), (8, 1.0 - RADIUS)] {
        at_every_rate(|at| {
            let case = format!("{at}, {id}");
            let run = at_door(at, id);
            let x = run.position().x;
            within!((x - ends).abs(), 2e-3, "{case}: at {x}");
            assert!(run.trace.always(Standing), "{case}");
            run.sound()
        });
    }
}

/// A door that closes on the climber pushes it out to the nearer side, and then leaves it free.
pub(crate) fn a_door_that_closes_on_a_climber_pushes_it_out() {
    for (x, ends) in [(0.9, 1.0 - RADIUS), (1.3, 1.2 + RADIUS)] {
        at_every_rate(|at| {
            let case = format!("{at}, from {x}");
            let stage = at
                .stage()
                .with_still(&Shape::floor(9.0))
                .numbered(ODD)
                .with_still(&door());
            let mut run = Run::new(stage, ClimberConfig::walker(), DVec3::X * x);
            let open = Rc::new(Cell::new(true));
            let is_open = Rc::clone(&open);
            run.set_rule(but(move |query| query.usual().with_solid(!is_open.get())));
            let mut run = run.settle();
            within!(
                (run.position().x - x).abs(),
                1e-9,
                "{case}: not let through"
            );
            open.set(false);
            run.steps(at.ticks(1.0), &IDLE);
            let place = run.position();
            within!((place.x - ends).abs(), 2e-3, "{case}: at {place}");
            assert_eq!(run.mode(), Standing, "{case}");
            run.trace.clone()
        });
    }
}
