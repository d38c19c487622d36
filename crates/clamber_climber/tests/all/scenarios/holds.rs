//! A stick that is held climbs in one direction, over bumps, round edges and bellies, and from walls onto ceilings.

use clamber_climber::ClimberInput;
use clamber_climber::ClimberMode::{Hanging, Holding};
use clamber_world::SurfaceKind;
use glam::{DAffine3, DVec3};

use crate::cases::pairs;
use crate::input::{HOLD, grip_climb, grip_walk};
use crate::stage::{Played, Run, Shape, Skin, Stage, kinds, radians, tireless, turned};

/// Fur of a shape that turns about the vertical at a rate in radians a second.
fn fur(shape: &Shape, turning: f64) -> Skin {
    let pose = move |time: f64| (vec![DAffine3::IDENTITY], turned(DVec3::Y, turning * time));
    Skin::of(shape, SurfaceKind::Fur, &|_| vec![1.0], Box::new(pose))
}

/// A climber that does not tire, with the centre of its ball at a point, after it has taken hold.
fn holding(played: Played, rate: f64, shape: &Shape, turning: f64, center: DVec3) -> Run {
    let stage = Stage::at_rate(played, rate).with_skin(fur(shape, turning));
    let config = tireless();
    let mut run = Run::new(stage, config, center - DVec3::Y * config.body.radius);
    for _ in 0..(rate * 0.25) as u32 {
        run.step_held(&HOLD);
    }
    let state = run.state();
    assert!(matches!(run.mode(), Holding), "{played:?}: {state:?}");
    run
}

/// Climbs with the same input for some seconds. Returns the displacement along a direction, and the longest
/// displacement of a tick against the tick before.
fn ride(run: &mut Run, rate: f64, seconds: f64, input: &ClimberInput, along: DVec3) -> (f64, f64) {
    let start = run.position();
    let (mut before, mut back) = (DVec3::ZERO, 0.0f64);
    for _ in 0..(rate * seconds) as u32 {
        let from = run.position();
        run.step(input);
        let step = run.position() - from;
        back = back.max(-step.dot(before.normalize_or_zero()));
        before = step;
    }
    ((run.position() - start).dot(along), back)
}

/// The underside of a slab with bumps of about this angle.
fn belly(degrees: f64) -> Shape {
    let cell = 0.4;
    let rise = cell * libm::tan(radians(degrees)) * 0.7;
    Shape::field(
        DVec3::new(-14.0, 5.0, -14.0),
        cell,
        [70, 70],
        move |x, z| {
            let wave = libm::sin(7.3 * x + 1.7 * z) + libm::sin(5.1 * z - 3.3 * x);
            0.5 * rise * wave
        },
    )
    .flipped()
}

pub(crate) fn a_held_stick_crosses_a_belly_as_a_direction_does() {
    let rides = [
        (30.0, 0.1, 0.0),
        (60.0, 1.0, 2.1),
        (60.0, 5.0, 0.6),
        (240.0, 20.0, 4.0),
    ];
    for (&played, (rate, degrees, side)) in pairs(kinds(), rides) {
        let way = DVec3::new(libm::sin(side), 0.0, libm::cos(side));
        let start = way * -2.5 + DVec3::Y * 4.58;
        let shape = belly(degrees);
        let climb = grip_climb(way);
        let [walked, climbed] = [grip_walk(way), climb].map(|input| {
            let mut run = holding(played, rate, &shape, 0.0, start);
            ride(&mut run, rate, 3.0, &input, way)
        });
        let told = format!("{played:?}, {rate} Hz, {degrees} degrees, {way}");
        let share = walked.0 / climbed.0;
        assert!(share > 0.95, "{told}: {} of {} m", walked.0, climbed.0);
        assert!(walked.1 < 1e-3, "{told}: back by {} m", walked.1);
    }
}

/// The climber starts below a box or on top of it, and climbs over its edges all around it.
pub(crate) fn a_held_stick_goes_round_the_edges_of_a_box() {
    let shape = Shape::boxed(DVec3::new(-2.0, 5.0, -1.5), DVec3::new(2.0, 8.0, 1.5));
    for &played in kinds() {
        for (rate, name, start) in [
            (30.0, "below", 4.58),
            (60.0, "top", 8.42),
            (240.0, "below", 4.58),
        ] {
            let start = DVec3::new(0.1, start, 0.2);
            let mut run = holding(played, rate, &shape, 0.0, start);
            let told = format!("{played:?} at {rate} Hz, {name}");
            let mut seen = [false; 4];
            let mut before = DVec3::ZERO;
            for _ in 0..(rate * 11.0) as u32 {
                let from = run.position();
                run.step(&grip_walk(DVec3::new(0.02, 0.0, 1.0)));
                let step = run.position() - from;
                let back = -step.dot(before.normalize_or_zero());
                assert!(back < 1e-3, "{told}: back by {back} m at {from}");
                before = step;
                let p = run.position();
                seen[0] |= p.y < 4.7 && p.z.abs() < 1.0;
                seen[1] |= p.y > 8.3 && p.z.abs() < 1.0;
                seen[2] |= p.z > 1.8;
                seen[3] |= p.z < -1.8;
            }
            // The way around is 16 m, and the climber has climbed all of it.
            assert_eq!(seen, [true; 4], "{told}: at {}", run.position());
        }
    }
}

/// The climber goes up a wall and onto the ceiling at its top.
pub(crate) fn a_held_stick_leads_from_a_wall_onto_its_ceiling() {
    let wall = Shape::boxed(DVec3::new(-3.0, 0.0, -1.0), DVec3::new(3.0, 5.0, 0.0));
    let ceiling = Shape::boxed(DVec3::new(-3.0, 5.0, -1.0), DVec3::new(3.0, 6.0, 9.0));
    let shape = wall.and(ceiling);
    for (&played, rate) in pairs(kinds(), [30.0, 60.0, 240.0]) {
        let mut run = holding(played, rate, &shape, 0.0, DVec3::new(0.1, 3.0, 0.42));
        let (_, back) = ride(&mut run, rate, 5.0, &grip_walk(DVec3::NEG_Z), DVec3::Z);
        let p = run.position();
        let told = format!("{played:?} at {rate} Hz: at {p}, back by {back} m");
        assert!(p.z > 3.0 && (p.y - 4.6).abs() < 0.02, "{told}");
        assert!(back < 1e-3, "{told}");
    }
}

/// The direction is found anew when the stick turns by more than 20 degrees, and turns with the creature.
pub(crate) fn a_stick_that_turns_far_enough_leads_anew() {
    let shape = belly(1.0);
    let at = |degrees: f64| {
        let angle = radians(degrees);
        DVec3::new(libm::sin(angle), 0.0, libm::cos(angle))
    };
    for &played in kinds() {
        for (angle, taken) in [
            (10.0, 0.0),
            (18.0, 0.0),
            (22.0, 22.0),
            (90.0, 90.0),
            (180.0, 180.0),
        ] {
            let mut run = holding(played, 60.0, &shape, 0.0, DVec3::new(0.0, 4.58, -2.0));
            ride(&mut run, 60.0, 0.5, &grip_walk(at(0.0)), DVec3::Z);
            let (way, _) = ride(&mut run, 60.0, 1.0, &grip_walk(at(angle)), at(taken));
            assert!(way > 1.45, "{played:?}, {angle} degrees: {way} m of 1.5");
        }
        // A quarter turn of the creature in two seconds takes the direction along.
        let mut run = holding(
            played,
            60.0,
            &shape,
            core::f64::consts::FRAC_PI_4,
            DVec3::new(0.0, 4.58, 0.0),
        );
        ride(&mut run, 60.0, 2.0, &grip_walk(DVec3::Z), DVec3::Z);
        let (way, _) = ride(&mut run, 60.0, 0.1, &grip_walk(DVec3::Z), DVec3::X);
        assert!(way > 0.12, "{played:?}: {way} m along X");
        assert!(!matches!(run.mode(), Hanging));
    }
}
