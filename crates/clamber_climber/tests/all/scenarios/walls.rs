//! Walls in the way, walls that approach, and walls that overlap the climber from the start.

use clamber_climber::ClimberMode::Standing;
use clamber_world::rapier3d::prelude::ColliderBuilder;
use glam::DVec3;

use crate::input::{IDLE, walk};
use crate::stage::{
    Played, Run, Shape, Stage, every, jolt, kinds, radians, shifted, walker_at, within,
};

pub(crate) fn an_overlap_is_left_in_one_tick() {
    for depth in [0.005, 0.05, 0.2] {
        every(0.0, |played| {
            let mut config = jolt();
            config.gravity = DVec3::ZERO;
            let wall = Shape::boxed(DVec3::new(-2.0, -3.0, -3.0), DVec3::new(0.0, 3.0, 3.0));
            let stage = Stage::new(played).with_still(&wall);
            let start = DVec3::new(0.32 - depth, -0.32, 0.0);
            let mut run = Run::new(stage, config, start);
            for tick in 0..3 {
                run.step(&IDLE);
                let off = run.position().distance(DVec3::X * 0.32);
                within!(off, 1e-6, "{played:?}, {depth} m deep, tick {tick}: {off}");
            }
            run.sound()
        });
    }
}

/// Two walls at 75 degrees that meet in a line along Z, above a floor.
fn valley() -> Shape {
    let lean = radians(75.0);
    let (rise, run) = (4.0 * libm::sin(lean), 4.0 * libm::cos(lean));
    let side = |x: f64, flip: bool| {
        let quad = Shape::quad([
            DVec3::new(0.0, 0.0, -1.0),
            DVec3::new(0.0, 0.0, 1.0),
            DVec3::new(x, rise, 1.0),
            DVec3::new(x, rise, -1.0),
        ]);
        if flip { quad.flipped() } else { quad }
    };
    side(run, false)
        .and(side(-run, true))
        .and(Shape::floor(10.0))
}

pub(crate) fn two_walls_through_the_body_lift_it_out_and_let_it_go() {
    every(0.0, |played| {
        let stage = Stage::new(played).with_still(&valley());
        let mut run = Run::new(stage, walker_at(2.0), DVec3::Y * 0.2);
        let mut height = run.position().y;
        for _ in 0..10 {
            run.step(&IDLE);
            let p = run.position();
            let told = format!("{played:?}: {p} from {height}");
            assert!(p.y >= height - 1e-6, "{told}: sinks");
            assert!(p.x.abs() <= 1e-3 && p.z.abs() <= 1e-3, "{told}");
            height = p.y;
        }
        assert!(run.feet().y > 0.5, "{played:?}: {}", run.feet());
        // The climber walks out of the valley along the crease, and down to the floor.
        run.steps(120, &walk(DVec3::Z));
        assert!(run.feet().z > 1.0, "{played:?}: {}", run.feet());
        assert!(run.feet().y.abs() <= 0.05, "{played:?}: {}", run.feet());
        run.sound()
    });
}

pub(crate) fn six_hundred_metres_a_second_stop_at_a_box() {
    every(0.0, |played| {
        let mut config = jolt();
        config.gravity = DVec3::ZERO;
        let wall = Shape::boxed(DVec3::new(5.0, -1.0, -1.0), DVec3::new(5.1, 2.0, 1.0));
        let stage = Stage::new(played).with_still(&wall);
        let mut run = Run::new(stage, config, DVec3::ZERO).thrown(DVec3::X * 600.0);
        run.step(&IDLE);
        let off = run.position().x - 4.68;
        within!(off.abs(), 1e-6, "{played:?}: {off}");
        let velocity = run.state().velocity;
        assert!(velocity.length() <= 1e-3, "{velocity:?}");
        run.sound()
    });
}

pub(crate) fn six_hundred_metres_a_second_stop_at_a_capsule() {
    let mut config = jolt();
    config.gravity = DVec3::ZERO;
    let stage = Stage::new(Played::Body).with_bodies(|bodies| {
        let other = ColliderBuilder::capsule_y(0.675, 0.32);
        bodies.add_fixed(other.translation(DVec3::new(5.0, 0.675, 0.0).as_vec3()));
    });
    let start = DVec3::Y * -0.32;
    let mut run = Run::new(stage, config, start).thrown(DVec3::X * 600.0);
    run.step(&IDLE);
    let off = run.position().x - (5.0 - 0.64);
    within!(off.abs(), 1e-6, "{off}");
    run.sound();
}

pub(crate) fn a_wall_pushes_an_idle_climber() {
    for (speed, ticks) in [(2.0, 240), (30.0, 120)] {
        every(0.0, |played| {
            let wall = Shape::boxed(DVec3::new(-3.0, -0.5, -5.0), DVec3::new(-1.0, 4.0, 5.0));
            let stage = Stage::new(played)
                .with_still(&Shape::floor(80.0))
                .with(&wall, move |time| shifted(DVec3::X * (speed * time)));
            let mut run = Run::new(stage, jolt(), DVec3::ZERO).settle();
            for tick in 0..ticks {
                run.step(&IDLE);
                let face = -1.0 + speed * run.stage.time();
                let gap = run.position().x - face - 0.32;
                let p = run.position();
                let told = format!("{played:?} at {speed} m/s, tick {tick} at {p}");
                within!(-gap, 2e-2, "{told}: gap {gap}");
                assert!((p.y - 0.32).abs() <= 1e-3 && p.z.abs() <= 1e-3, "{told}");
            }
            assert!(run.position().x > 1.0);
            run.sound()
        });
    }
}

pub(crate) fn a_ball_within_a_solid_box_comes_out_of_its_nearest_face() {
    let mut config = jolt();
    config.gravity = DVec3::ZERO;
    config.body.radius = 0.5;
    config.body.height = 0.0;
    let stage = Stage::new(Played::Body)
        .with_bodies(|bodies| bodies.add_fixed(ColliderBuilder::cuboid(1.0, 1.0, 1.0)));
    let start = DVec3::new(0.8, 0.3 - 0.5, 0.0);
    let mut run = Run::new(stage, config, start);
    let mut ticks = 0;
    while run.position().x < 1.5 - 1e-3 {
        run.step(&IDLE);
        ticks += 1;
        assert!(ticks <= 20, "still at {}", run.position());
    }
    let p = run.position();
    assert!(
        (p - DVec3::new(1.5, 0.3, 0.0)).length() <= 1e-3,
        "{p} after {ticks}"
    );
}

pub(crate) fn a_slow_wall_pushes_off_an_edge() {
    for speed in [0.1, 0.5, 1.5] {
        // Kinds are not compared: rounding decides whether a climber that rolls off an edge slides or falls past it.
        for &played in kinds() {
            let wall = Shape::boxed(DVec3::new(-3.0, -0.5, -5.0), DVec3::new(-0.4, 4.0, 5.0));
            let stage = Stage::new(played)
                .with_still(&Shape::floor(1.0))
                .with(&wall, move |time| shifted(DVec3::X * (speed * time)));
            let mut run = Run::new(stage, jolt(), DVec3::ZERO).settle();
            let told = format!("{played:?} at {speed} m/s");
            let mut ticks = 0;
            while run.mode() == Standing {
                run.step(&IDLE);
                ticks += 1;
                let p = run.position();
                // At the edge the climber rolls over, as far as it can stand there.
                assert!(p.x <= 1.0 + 0.32, "{told}: stands on nothing at {p}");
                assert!(ticks < 2000, "{told}: is not pushed");
            }
            run.steps(60, &IDLE);
            assert!(run.feet().y < -1.0, "{told}: {}", run.feet());
            run.sound();
        }
    }
}

pub(crate) fn a_corner_takes_all_velocity() {
    every(0.0, |played| {
        let mut config = jolt();
        config.gravity = DVec3::ZERO;
        config.body.height = 0.0;
        let hollow = Shape::boxed(DVec3::splat(-2.0), DVec3::splat(2.0));
        let stage = Stage::new(played).with_still(&hollow);
        let start = -DVec3::Y * 0.32;
        let mut run = Run::new(stage, config, start).thrown(DVec3::new(-150.0, 140.0, -130.0));
        run.step(&IDLE);
        let off = run.position().distance(DVec3::new(-1.68, 1.68, -1.68));
        within!(off, 1e-6, "{played:?}");
        within!(run.state().velocity.length(), 1e-3, "{played:?}: velocity");
        run.sound()
    });
}

pub(crate) fn ground_moves_on_below_a_climber_held_back_by_a_wall() {
    for speed in [0.2, 1.0, 5.0] {
        every(0.0, |played| {
            let wall = Shape::boxed(DVec3::new(0.5, -0.5, -5.0), DVec3::new(1.0, 4.0, 5.0));
            let stage = Stage::new(played)
                .with_still(&wall)
                .with(&Shape::floor(10.0).moved(-DVec3::Y), move |time| {
                    shifted(DVec3::X * (speed * time))
                });
            let mut run = Run::new(stage, jolt(), -DVec3::Y).settle();
            let ticks = (8.0 / (speed * run.stage.dt)) as u32;
            run.steps(ticks, &IDLE);
            let off = run.feet().distance(DVec3::new(0.18, -1.0, 0.0));
            within!(off, 1e-4, "{played:?} at {speed} m/s: {}", run.feet());
            assert_eq!(run.mode(), Standing);
            // The ground's end passes below the climber. The climber then falls for a second, so that a rest of speed
            // from rounding does not matter.
            let left = ((10.7 / speed + 1.0) / run.stage.dt) as u32 - ticks;
            run.steps(left, &IDLE);
            let feet = run.feet();
            assert!(feet.y < -1.5, "{played:?} at {speed} m/s: {feet}");
            run.sound()
        });
    }
}
