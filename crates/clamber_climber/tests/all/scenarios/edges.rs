//! Edges within smooth ground, and seams between flush obstacles.

use clamber_climber::ClimberMode::{Sliding, Standing};
use glam::DVec3;

use crate::cases::pairs;
use crate::input::{IDLE, walk};
use crate::stage::{Run, Shape, Stage, every, jolt, one_kind, radians, walker_at, within};

pub(crate) fn a_gutter_of_768_faces_is_walked_along_to_its_caps() {
    every(0.0, |played| {
        let gutter = Shape::half_pipe(0.33, 3.0, 768);
        let stage = Stage::new(played).with_still(&gutter);
        let start = DVec3::Y * -0.33;
        let mut config = walker_at(4.0);
        // Otherwise the climber would step up onto the rim.
        config.ground.step_height = 0.0;
        let mut run = Run::new(stage, config, start).settle();
        let touched = run.stage.obstacles(|obstacles| {
            let mut contacts = Vec::new();
            obstacles[0].1.overlap_capsule(&run.body(), &mut contacts);
            let mut wider = run.body();
            wider.radius += 0.02;
            obstacles[0].1.overlap_capsule(&wider, &mut contacts);
            contacts.len()
        });
        assert!(touched > 256, "{played:?}: {touched} contacts");
        for (direction, end) in [(DVec3::X, 2.68), (-DVec3::X, -2.68)] {
            run.steps(120, &walk(direction));
            let p = run.position();
            assert!((p.x - end).abs() <= 1e-4, "{played:?}: {p}");
            assert_eq!(run.mode(), Standing);
            let normal = run
                .state()
                .support
                .map(|support| support.normal_in_world().y);
            assert!(normal.is_some_and(|y| y > 0.999), "{played:?}: {normal:?}");
        }
        run.sound()
    });
}

/// A slope of 60 degrees down along +X, of 7 by 7 quadrilaterals of 4 m. It is too steep to stand on, so that a climber
/// slides without friction.
fn quads(mirrored: bool) -> Shape {
    let flat = Shape::field(DVec3::new(-14.0, 0.0, -14.0), 4.0, [7, 7], |_, _| 0.0);
    let mut shape = flat.turned(DVec3::Z, -radians(60.0));
    if mirrored {
        for p in &mut shape.positions {
            p.z = -p.z;
        }
        shape = shape.flipped();
    }
    shape
}

fn steep() -> (DVec3, DVec3) {
    let angle = radians(60.0);
    let (s, c) = (libm::sin(angle), libm::cos(angle));
    (DVec3::new(s, c, 0.0), DVec3::new(c, -s, 0.0))
}

pub(crate) fn edges_within_a_slope_are_not_felt() {
    let (normal, down) = steep();
    // Across the edges, diagonally, and along a row of edges.
    for (start, speed) in [
        (DVec3::new(-9.0, 0.0, -9.0), DVec3::Z * 3.0),
        (DVec3::new(-8.0, 0.0, -6.0), DVec3::Z * 3.0),
        (DVec3::new(-9.1, 0.0, -10.0), DVec3::Z * 6.0),
    ] {
        every(0.0, |played| {
            let config = jolt();
            let radius = config.body.radius;
            let along = down * start.x + DVec3::Z * start.z;
            let feet = along + (normal - DVec3::Y) * radius;
            let stage = Stage::new(played).with_still(&quads(false));
            let mut run = Run::new(stage, config, feet).thrown(speed);
            let from = run.position();
            for tick in 1..=110u32 {
                run.step(&IDLE);
                let ticks = f64::from(tick);
                let pull = 9.81 * libm::sin(radians(60.0));
                let dt = run.stage.dt;
                let way = pull * dt * dt * ticks * ticks * 0.5;
                let expected = from + speed * (dt * ticks) + down * way;
                let off = run.position().distance(expected);
                within!(off, 1e-3, "{played:?}, tick {tick}: {off}");
                let off = run
                    .state()
                    .velocity
                    .distance(speed + down * (pull * dt * ticks));
                within!(off, 2e-3, "{played:?}, tick {tick}: velocity off by {off}");
                assert_eq!(run.mode(), Sliding);
            }
            run.sound()
        });
    }
}

pub(crate) fn edges_within_a_slope_are_not_felt_at_360_metres_a_second() {
    let (normal, down) = steep();
    for (mirrored, start) in pairs([false, true], [-8.0, -7.9, -6.0]) {
        every(0.0, |played| {
            let config = jolt();
            let along = down * start - DVec3::Z * 5.0;
            let feet = along + (normal - DVec3::Y) * config.body.radius;
            let stage = Stage::new(played).with_still(&quads(mirrored));
            let mut run = Run::new(stage, config, feet).thrown(DVec3::Z * 360.0);
            let from = run.position();
            run.step(&IDLE);
            let dt = run.stage.dt;
            let pull = 9.81 * libm::sin(radians(60.0)) * dt;
            let expected = DVec3::Z * 360.0 + down * pull;
            let mean = DVec3::Z * 360.0 + down * (pull * 0.5);
            let off = (run.position() - from).distance(mean * dt);
            within!(off, 1e-4, "{played:?}, from {start}: off by {off}");
            let off = run.state().velocity.distance(expected);
            within!(off, 1e-4, "{played:?}, from {start}: velocity off by {off}");
            run.sound()
        });
    }
}

pub(crate) fn a_fin_on_an_edge_of_the_floor_blocks() {
    // Two triangles of the floor and one of the fin share an edge.
    let fin = Shape {
        positions: vec![
            DVec3::new(0.0, 0.0, -4.0),
            DVec3::new(0.0, 0.0, 4.0),
            DVec3::new(-6.0, 0.0, 0.0),
            DVec3::new(6.0, 0.0, 0.0),
            DVec3::new(0.0, 6.0, 0.0),
        ],
        triangles: vec![[0, 2, 1], [0, 1, 3], [0, 1, 4]],
    };
    for fin in [fin.clone(), fin.flipped()] {
        every(0.0, |played| {
            let mut run = Run::on(played, &fin, walker_at(3.0), DVec3::new(-2.0, 0.0, 0.1));
            run.steps(90, &walk(DVec3::X));
            let p = run.position();
            assert!((p.x + 0.32).abs() <= 1e-4, "{played:?}: {p}");
            assert!((p.y - 0.32).abs() <= 1e-4, "{played:?}: {p}");
            run.sound()
        });
    }
}

pub(crate) fn the_seam_of_two_fields_is_not_felt() {
    let field = |low: f64| Shape::field(DVec3::new(low, 0.0, -8.0), 1.0, [16, 16], |_, _| 0.0);
    every(0.0, |played| {
        let stage = Stage::new(played)
            .with_still(&field(-16.0))
            .with_still(&field(0.0));
        let mut run = Run::new(stage, walker_at(2.0), -DVec3::X * 3.0).settle();
        run.steps(480, &walk(DVec3::X));
        let lowest = run.trace.heights().fold(f64::INFINITY, f64::min);
        assert!(lowest >= 0.32 - 0.05, "{played:?}: sinks to {lowest}");
        assert!(run.feet().x > 12.0, "{played:?}: {}", run.feet());
        assert!(run.trace.always(Standing));
        run.sound()
    });
}

pub(crate) fn the_seam_between_terrain_and_a_foot_is_not_felt() {
    let field = |low: f64| Shape::field(DVec3::new(low, 0.0, -8.0), 1.0, [16, 16], |_, _| 0.0);
    let foot = field(0.0);
    let stage = Stage::new(one_kind()).with_still(&foot);
    let stage = stage.with_ground(&field(-16.0));
    let mut run = Run::new(stage, walker_at(2.0), -DVec3::X * 3.0).settle();
    run.steps(480, &walk(DVec3::X));
    let off = run.feet().distance(DVec3::X * 13.0);
    within!(off, 1e-3, "{}", run.feet());
    assert!(run.trace.always(Standing));
    run.sound();
}
