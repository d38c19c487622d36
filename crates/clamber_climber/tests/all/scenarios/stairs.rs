//! Steps, bumps, pillars and funnels.

use clamber_climber::ClimberMode::{Falling, Standing};
use glam::DVec3;

use crate::input::{IDLE, walk};
use crate::stage::{Run, Shape, Stage, every, jolt, kinds, walker_at, within};

/// Tick rates, hertz.
const RATES: [u32; 4] = [60, 120, 240, 360];

pub(crate) fn stairs_are_walked_up_at_any_rate() {
    for rate in RATES {
        every(0.0, |played| {
            let dt = 1.0 / f64::from(rate);
            let stairs = Shape::stairs(10, 0.3, 0.3, 2.0);
            let stage = Stage::at(played, dt, DVec3::ZERO).with_still(&stairs);
            let mut run = Run::new(stage, walker_at(4.0), -DVec3::Z).settle();
            let mut z = run.position().z;
            let mut ticks = 0;
            while run.feet().y < 3.0 - 1e-3 {
                run.step(&walk(DVec3::Z));
                ticks += 1;
                let p = run.position();
                let told = format!("{rate} Hz, {played:?}, at {p}");
                assert!(p.z > z, "{told}: stuck");
                assert!(p.x.abs() <= 1e-6, "{told}: drifts");
                assert_eq!(run.mode(), Standing, "{told}");
                z = p.z;
                // The way leads from 1 m before the first riser to the tenth.
                let ideal = (1.0 + 9.0 * 0.3) / 4.0;
                assert!(f64::from(ticks) * dt <= 1.5 * ideal, "{told}: slow");
            }
            run.sound()
        });
    }
}

pub(crate) fn stairs_block_a_climber_that_cannot_step() {
    for rate in RATES {
        every(0.0, |played| {
            let mut config = walker_at(4.0);
            config.ground.step_height = 0.0;
            let stairs = Shape::stairs(10, 0.3, 0.3, 2.0);
            let stage = Stage::at_rate(played, f64::from(rate)).with_still(&stairs);
            let mut run = Run::new(stage, config, -DVec3::Z).settle();
            run.steps(rate, &walk(DVec3::Z));
            let end = run.feet();
            let told = format!("{rate} Hz, {played:?}: ends at {end}");
            assert!((end.z + 0.32).abs() <= 1.1e-2, "{told}");
            assert!(end.y.abs() <= 1e-4, "{told}");
            run.sound()
        });
    }
}

/// A wall along X that faces +Z.
fn wall(z: f64) -> Shape {
    Shape::boxed(DVec3::new(-20.0, -1.0, z - 1.0), DVec3::new(20.0, 3.0, z))
}

pub(crate) fn a_wall_alongside_gives_no_speed() {
    for rate in RATES {
        every(0.0, |played| {
            let want = DVec3::new(5.0, 0.0, -1.0);
            let stage = Stage::at_rate(played, f64::from(rate))
                .with_still(&Shape::floor(20.0))
                .with_still(&wall(-0.32));
            let mut run = Run::new(stage, walker_at(want.length()), DVec3::ZERO).settle();
            run.steps(rate, &walk(want.normalize()));
            let off = run.feet().distance(DVec3::X * 5.0);
            let feet = run.feet();
            within!(off, 1e-2, "{rate} Hz, {played:?}: {feet} is off by {off}");
            assert!(run.trace.always(Standing));
            run.sound()
        });
    }
}

/// Boxes on a floor, along X from 1 m on.
fn bumps(width: f64, height: f64, every: f64, count: u32) -> Shape {
    (0..count).fold(Shape::floor(30.0), |shape, k| {
        let x = 1.0 + every * f64::from(k);
        let low = DVec3::new(x, -0.5, -2.0);
        shape.and(Shape::boxed(low, DVec3::new(x + width, height, 2.0)))
    })
}

pub(crate) fn bumps_are_walked_over() {
    for (width, height, distance, count) in [(0.05, 0.01, 0.5, 20), (0.3, 0.1, 2.0, 5)] {
        every(0.0, |played| {
            let shape = bumps(width, height, distance, count);
            let mut run = Run::on(played, &shape, walker_at(3.0), DVec3::ZERO);
            run.steps(240, &walk(DVec3::X));
            assert!(run.trace.always(Standing), "{played:?}, {height} m");
            let feet = run.feet();
            assert!(feet.x >= 11.0, "{played:?}, {height} m: to {feet}");
            assert!(feet.z.abs() <= 1e-4, "{played:?}, {height} m: to {feet}");
            run.sound()
        });
    }
}

pub(crate) fn stairs_with_too_narrow_treads_are_a_wall() {
    every(0.0, |played| {
        let stairs = Shape::stairs(10, 0.3, 0.05, 2.0);
        let mut run = Run::on(played, &stairs, walker_at(3.0), -DVec3::Z);
        run.steps(180, &walk(DVec3::Z));
        let heights = run.trace.heights().map(|y| y - 0.32);
        let highest = heights.fold(0.0, f64::max);
        assert!(highest < 0.35, "{played:?}: climbs to {highest}");
        run.sound()
    });
}

/// Thirty square pillars of 0.2 m, side by side.
fn pillars() -> Shape {
    (0..30u32).fold(Shape::default(), |shape, k| {
        let x = -1.0 + 0.2 * f64::from(k);
        shape.and(Shape::boxed(
            DVec3::new(x, -0.5, -0.52),
            DVec3::new(x + 0.2, 2.0, -0.32),
        ))
    })
}

/// A wall of 25 columns of quadrilaterals.
fn segments() -> Shape {
    let flat = Shape::field(DVec3::new(-1.0, 0.0, -1.0), 0.25, [25, 12], |_, _| 0.0);
    let upright = flat.turned(DVec3::X, core::f64::consts::FRAC_PI_2);
    upright.moved(DVec3::new(0.0, 0.0, -0.32))
}

pub(crate) fn walls_of_pillars_and_of_segments_do_not_snag() {
    for wall in [pillars(), segments()] {
        every(0.0, |played| {
            let stage = Stage::new(played)
                .with_still(&Shape::floor(20.0))
                .with_still(&wall);
            let want = DVec3::new(2.0, 0.0, -1.0);
            let mut run = Run::new(stage, walker_at(want.length()), DVec3::ZERO).settle();
            run.steps(120, &walk(want.normalize()));
            let off = run.feet().distance(DVec3::X * 4.0);
            within!(off, 1e-3, "{played:?}: {} is off by {off}", run.feet());
            run.sound()
        });
    }
}

/// The drop beside the wall is 20 m deep. Edges within the wall must not count as ledges to stand on.
pub(crate) fn a_wall_along_a_drop_is_no_ground() {
    every(0.0, |played| {
        let tiles = Shape::field(DVec3::new(-3.0, 0.0, -1.0), 0.35, [25, 12], |_, _| 0.0);
        let upright = tiles.turned(DVec3::X, core::f64::consts::FRAC_PI_2);
        let cliff = Shape::boxed(DVec3::new(-10.0, -20.0, -5.0), DVec3::new(0.0, 0.0, 5.0));
        let stage = Stage::new(played)
            .with_still(&cliff)
            .with_still(&upright.moved(DVec3::new(0.0, 0.0, -0.33)));
        let mut run = Run::new(stage, walker_at(2.0), -DVec3::X).settle();
        run.steps(90, &walk(DVec3::X));
        for (mode, position) in run.trace.modes.iter().zip(&run.trace.positions) {
            // Up to there, the climber rolls over the edge.
            if position.x > 0.32 {
                assert_eq!(*mode, Falling, "{played:?}: at {position}");
            }
        }
        assert!(run.feet().y < -1.0, "{played:?}: {}", run.feet());
        run.sound()
    });
}

/// Four slopes of 65 degrees that meet in a point.
fn funnel() -> Shape {
    let rise = libm::tan(crate::stage::radians(65.0));
    Shape::field(DVec3::new(-3.0, 0.0, -3.0), 3.0, [2, 2], |x, z| {
        rise * x.abs().max(z.abs())
    })
}

pub(crate) fn a_funnel_holds_a_climber_that_falls_into_it() {
    every(0.0, |played| {
        let stage = Stage::new(played).with_still(&funnel());
        let mut run = Run::new(stage, jolt(), DVec3::new(0.4, 3.0, -0.2));
        run.steps(180, &IDLE);
        let rest = run.position();
        run.steps(60, &IDLE);
        assert_eq!(run.mode(), Standing, "{played:?}: {:?}", run.state());
        let drift = run.position().distance(rest);
        within!(drift, 1e-4, "{played:?}: moves by {drift}");
        run.sound()
    });
}

/// A floor, and a ceiling that comes down to it along +X.
fn acute() -> Shape {
    let ceiling = Shape::quad([
        DVec3::new(0.0, 3.0, -3.0),
        DVec3::new(6.0, 0.0, -3.0),
        DVec3::new(6.0, 0.0, 3.0),
        DVec3::new(0.0, 3.0, 3.0),
    ]);
    Shape::floor(20.0).and(ceiling)
}

pub(crate) fn an_acute_corner_below_a_ceiling_stops_gently() {
    every(0.0, |played| {
        let mut run = Run::on(played, &acute(), walker_at(3.0), -DVec3::X);
        run.steps(120, &walk(DVec3::X));
        let rest = run.position();
        for _ in 0..60 {
            run.step(&walk(DVec3::X));
            let jump = run.position().distance(rest);
            let place = run.position();
            within!(jump, 1e-3, "{played:?}: jumps by {jump} to {place}");
        }
        // The upper ball touches the ceiling, which falls by 0.5 m per metre.
        let top = DVec3::new(rest.x, rest.y + 1.35, 0.0);
        let room = (3.0 - top.y - top.x * 0.5) * 2.0 / libm::sqrt(5.0);
        assert!(
            (room - 0.32).abs() <= 0.021,
            "{played:?}: {room} of room at {rest}"
        );
        run.sound()
    });
}

pub(crate) fn a_hollow_box_is_solid_from_within() {
    every(0.0, |played| {
        let hollow = Shape::boxed(DVec3::new(-2.0, 0.0, -2.0), DVec3::new(2.0, 3.0, 2.0));
        let mut run = Run::on(played, &hollow, walker_at(4.0), DVec3::ZERO);
        for direction in [DVec3::X, DVec3::new(1.0, 0.0, 1.0), -DVec3::Z, -DVec3::X] {
            run.steps(90, &walk(direction));
            let end = run.feet();
            let most = end.x.abs().max(end.z.abs());
            assert!((most - 1.68).abs() <= 1e-4, "{played:?}: {end}");
            assert!(end.y.abs() <= 1e-4, "{played:?}: {end}");
        }
        run.sound()
    });
    // The climber is thrown at the lid from inside.
    for &played in kinds() {
        let hollow = Shape::boxed(DVec3::new(-2.0, 0.0, -2.0), DVec3::new(2.0, 3.0, 2.0));
        let stage = Stage::new(played).with_still(&hollow);
        let mut run = Run::new(stage, jolt(), DVec3::Y * 0.1).thrown(DVec3::Y * 300.0);
        run.step(&IDLE);
        let top = run.position().y + 1.35 + 0.32;
        assert!((top - 3.0).abs() <= 1e-4, "{played:?}: {top}");
        run.sound();
    }
}
