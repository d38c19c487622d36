//! Stepping off an edge with the grip held: the climber turns round and hangs from the edge.

use clamber_climber::ClimberInput;
use clamber_climber::ClimberMode::{LedgeHanging, Standing};
use glam::DVec3;

use crate::cases::pairs;
use crate::events::{count, is_caught};
use crate::input::{HOLD, IDLE, grip_walk};
use crate::stage::{Played, Run, Shape, Stage, Trace, every, tireless, turned, within};

/// Radius of the body, metres.
const RADIUS: f64 = 0.4;

/// Distance of the ball's centre below the edge from which it hangs, metres.
const DROP: f64 = 0.6;

/// Speed at which arms draw, metres a second.
const DRAW: f64 = 3.0;

/// A block of 4 m whose top has an edge at height 0 and z 0.
fn block() -> Shape {
    Shape::boxed(DVec3::new(-6.0, -4.0, -6.0), DVec3::new(6.0, 0.0, 0.0))
}

/// A plate of 6 cm with the same edge.
fn plate() -> Shape {
    Shape::boxed(DVec3::new(-6.0, -0.06, -6.0), DVec3::new(6.0, 0.0, 0.0))
}

/// A floor below the edge, at a height.
fn floor(height: f64) -> Shape {
    let low = DVec3::new(-9.0, height - 1.0, -9.0);
    Shape::boxed(low, DVec3::new(9.0, height, 9.0))
}

/// A way to go over the edge.
#[derive(Clone, Copy, Debug)]
struct Way {
    rate: f64,
    /// The stick, for an edge that the climber leaves along +Z.
    stick: DVec3,
    /// Height of the capsule's second ball, metres.
    height: f64,
    /// Angle by which the scene is turned about the vertical, radians.
    angle: f64,
}

fn ways() -> Vec<Way> {
    let way = |rate, x: f64, z: f64, height, angle| Way {
        rate,
        stick: DVec3::new(x, 0.0, z),
        height,
        angle,
    };
    vec![
        way(60.0, 0.0, 1.0, 0.0, 0.0),
        way(30.0, 0.0, 1.0, 1.0, 0.9),
        way(120.0, 0.0, 0.2, 0.0, 2.0),
        way(240.0, 0.0, 0.5, 1.0, 4.0),
        way(60.0, 0.7, 0.7, 0.0, 5.0),
        way(30.0, -0.8, 0.4, 0.0, 3.0),
    ]
}

/// A climber that stands a metre behind the edge.
fn standing(stage: Stage, way: &Way) -> Run {
    let mut config = tireless();
    config.grip = None;
    config.body.height = way.height;
    let feet = turned(DVec3::Y, way.angle).rotation * DVec3::new(0.0, 0.0, -1.0);
    Run::new(stage, config, feet).settle()
}

fn stage(played: Played, way: &Way, shapes: &[Shape]) -> Stage {
    let pose = turned(DVec3::Y, way.angle);
    let stage = Stage::at_rate(played, way.rate);
    let shapes = shapes.iter();
    shapes.fold(stage, |stage, shape| {
        stage.with_still(&shape.clone().placed(&pose))
    })
}

/// Walks on with the stick held until the climber hangs, for a limited time. True if it hangs.
fn hangs(run: &mut Run, way: &Way, grip: bool) -> bool {
    let walk = turned(DVec3::Y, way.angle).rotation * way.stick;
    let input = ClimberInput { walk, grip, ..IDLE };
    let seconds = 0.5 + 1.5 / (3.0 * way.stick.z);
    (0..(seconds * way.rate) as u32).any(|_| {
        run.step(&input);
        run.mode() == LedgeHanging
    })
}

fn hangs_and_rests(played: Played, way: &Way, shapes: &[Shape]) -> Trace {
    let case = format!("{played:?}, {way:?}");
    let yaw = turned(DVec3::Y, way.angle).rotation;
    let mut run = standing(stage(played, way, shapes), way);
    let hung = hangs(&mut run, way, true);
    assert!(hung, "{case}: {:?} at {}", run.mode(), run.position());
    assert_eq!(count(&run.trace.events, is_caught), 1, "{case}");
    let dt = 1.0 / way.rate;
    let input = grip_walk(yaw * way.stick);
    // With the stick held, the climber moves down to its place, no faster than arms draw, and along the ledge if the
    // stick is oblique.
    let mut last = run.position();
    for _ in 0..way.rate as u32 {
        run.step(&input);
        assert_eq!(run.mode(), LedgeHanging, "{case} at {}", run.position());
        let made = run.position().distance(last);
        let at = run.position();
        within!(made, DRAW * dt * 1.2 + 1e-5, "{case}: {made} to {at}");
        last = run.position();
    }
    run.steps(way.rate as u32 / 2, &HOLD);
    let place = yaw.inverse() * run.position();
    let off = DVec3::new(0.0, place.y + DROP, place.z - RADIUS).length();
    within!(off, 2e-3, "{case}: hangs at {place}");
    let facing = yaw.inverse() * run.state().heading;
    let off = facing.distance(DVec3::NEG_Z);
    within!(off, 1e-3, "{case}: faces {facing}");
    let speed = run.state().velocity.length();
    within!(speed, 1e-4, "{case}: {speed} m/s");
    run.sound()
}

pub(crate) fn a_climber_that_steps_off_an_edge_hangs_from_it() {
    for (way, shape) in pairs(ways(), [block(), plate()]) {
        every(0.0, |played| {
            hangs_and_rests(played, &way, core::slice::from_ref(&shape))
        });
    }
}

/// The climber walks off without the grip, onto a step, or onto ground above which it has no room to hang.
pub(crate) fn a_climber_that_can_step_down_or_has_no_room_does_not_hang() {
    let cases = [
        (false, None),
        (true, Some(-0.15)),
        (true, Some(-0.3)),
        (true, Some(-0.9)),
    ];
    for (way, (grip, below)) in pairs(ways(), cases) {
        every(0.0, |played| {
            let case = format!("{played:?}, {way:?}, {grip}, {below:?}");
            let mut shapes = vec![block()];
            shapes.extend(below.map(floor));
            let mut run = standing(stage(played, &way, &shapes), &way);
            let hung = hangs(&mut run, &way, grip);
            assert!(!hung, "{case}: hangs at {}", run.position());
            if below.is_some() {
                run.steps(way.rate as u32, &IDLE);
                assert_eq!(run.mode(), Standing, "{case} at {}", run.position());
            }
            run.sound()
        });
    }
}
