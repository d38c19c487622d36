//! Ground that deforms, as only skin does.

use core::f64::consts::TAU;

use clamber_climber::ClimberMode::{Holding, Sliding, Standing};
use clamber_climber::{ClimberConfig, ClimberInput};
use clamber_surface::geometry::Similarity;
use clamber_world::SurfaceKind;
use glam::{DAffine3, DMat3, DVec3};

use crate::events::is_crushed;
use crate::input::IDLE;
use crate::stage::{Run, Shape, Skin, Stage, jolt, one_kind, radians, walker_at, within};

/// A skin with two joints. The second joint moves. `share` is the weight of that joint at a rest position.
fn skin(
    shape: &Shape,
    share: impl Fn(DVec3) -> f64,
    joint: impl Fn(f64) -> DAffine3 + 'static,
) -> Skin {
    let weights = |p: DVec3| {
        let share = share(p);
        vec![1.0 - share, share]
    };
    let pose = move |time| (vec![DAffine3::IDENTITY, joint(time)], Similarity::IDENTITY);
    Skin::new(shape, &weights, Box::new(pose))
}

fn on(skin: Skin, config: ClimberConfig, feet: DVec3) -> Run {
    Run::new(Stage::new(one_kind()).with_skin(skin), config, feet).settle()
}

/// A level plane of quadrilaterals of half a metre.
fn plain() -> Shape {
    Shape::field(DVec3::new(-5.0, 0.0, -5.0), 0.5, [20, 20], |_, _| 0.0)
}

/// Current position of the climber's material point.
fn material(run: &Run) -> DVec3 {
    let support = run.state().support.unwrap();
    let motion = run.stage.obstacles(|obstacles| {
        obstacles[0]
            .1
            .motion(&support.attachment.material, run.stage.dt)
    });
    motion.unwrap().position
}

pub(crate) fn breathing_ground_carries_for_a_minute() {
    // All of the ground rises alike, or a hump swells.
    let even = |_: DVec3| 1.0;
    let hump = |p: DVec3| (1.0 - p.length() / 4.0).max(0.0);
    for (name, share) in [("even", &even as &dyn Fn(DVec3) -> f64), ("hump", &hump)] {
        let rises =
            |time: f64| DAffine3::from_translation(DVec3::Y * (0.5 * libm::sin(TAU * time)));
        let mut config = jolt();
        config.body.height = 0.0;
        let mut run = on(
            skin(&plain(), share, rises),
            config,
            DVec3::new(1.0, 0.0, 0.6),
        );
        let point = run.state().support.unwrap().attachment.material;
        for tick in 0..3600 {
            run.step(&IDLE);
            let now = run.state().support.unwrap().attachment.material;
            assert_eq!(now, point, "{name}, tick {tick}: steps off its point");
            let away = run.position().distance(material(&run));
            within!((away - 0.32).abs(), 0.02, "{name}, tick {tick}: gap");
        }
        assert!(run.trace.always(Standing), "{name}");
        run.sound();
    }
}

pub(crate) fn feet_keep_their_barycentric_point_on_a_stretching_triangle() {
    // The skin stretches to twice its length along X and back, twice a second.
    let stretches = |time: f64| {
        let factor = 1.5 - 0.5 * libm::cos(2.0 * TAU * time);
        DAffine3::from_scale(DVec3::new(factor, 1.0, 1.0))
    };
    let rest = DVec3::new(1.1, 0.0, 0.7);
    let mut run = on(skin(&plain(), |_| 1.0, stretches), jolt(), rest);
    let point = run.state().support.unwrap().attachment.material;
    for tick in 0..600 {
        run.step(&IDLE);
        let now = run.state().support.unwrap().attachment.material;
        assert_eq!(now, point, "tick {tick}: barycentric coordinates changed");
        let expected = stretches(run.stage.time()).transform_point3(rest);
        let off = run.feet().distance(expected);
        within!(off, 1e-3, "tick {tick}: {off} from its material");
    }
    assert!(run.trace.always(Standing));
    run.sound();
}

/// Ground that is sheared to a slope of `angle`.
fn tilts(angle: impl Fn(f64) -> f64 + 'static) -> Skin {
    let shear = move |time: f64| {
        let rise = libm::tan(angle(time));
        let matrix = DMat3::from_cols(DVec3::new(1.0, rise, 0.0), DVec3::Y, DVec3::Z);
        DAffine3::from_mat3(matrix)
    };
    let shape = Shape::field(DVec3::new(-40.0, 0.0, -5.0), 1.0, [80, 10], |_, _| 0.0);
    skin(&shape, |_| 1.0, shear)
}

fn changes(run: &Run) -> usize {
    let pairs = run.trace.modes.windows(2);
    pairs.filter(|two| two[0] != two[1]).count()
}

pub(crate) fn ground_that_trembles_about_the_limit_is_lost_once_at_most() {
    let tremble = |time: f64| radians(0.1) * libm::sin(TAU * 7.0 * time);
    // The slope trembles around the limit for landings.
    let skin = tilts(move |time| radians(50.0) * (time / 2.0).min(1.0) + tremble(time));
    let mut run = on(skin, jolt(), DVec3::ZERO);
    run.steps(600, &IDLE);
    assert_eq!(changes(&run), 0, "loses its ground: {:?}", run.trace.events);
    // The slope goes beyond the limit for standing, and back to one on which a climber lands, twice.
    let skin = tilts(move |time| {
        let wave = (time / 2.0).rem_euclid(2.0);
        let slow = if wave < 1.0 { wave } else { 2.0 - wave };
        radians(53.0) * slow + tremble(time)
    });
    let mut run = on(skin, jolt(), DVec3::ZERO);
    run.steps(480, &IDLE);
    let events = &run.trace.events;
    assert_eq!(changes(&run), 4, "lost and found twice: {events:?}");
    assert!(run.trace.modes.contains(&Sliding));
}

pub(crate) fn closing_sheets_crush_the_climber_but_do_not_let_it_through() {
    // The sheets close on a ball to less than its radius, and on a capsule to more than the length of its axis: with
    // less room the axis would not fit between them.
    for (height, least) in [(0.0, 0.2), (1.35, 1.5)] {
        let mut config = jolt();
        config.body.height = height;
        let size = height + 0.64;
        // The room above its head shrinks from 1 m to the least in a second, and opens again.
        let open = size + 1.0;
        let room = move |time: f64| {
            let phase = (time - 1.0).abs().min(1.0);
            least + (open - least) * phase
        };
        let sheet = |y: f64| Shape::field(DVec3::new(-4.0, y, -4.0), 1.0, [8, 8], |_, _| 0.0);
        let closes = move |time: f64| DAffine3::from_translation(DVec3::Y * (room(time) - open));
        let share = |p: DVec3| if p.y > 0.1 { 1.0 } else { 0.0 };
        let both = sheet(0.0).and(sheet(open).flipped());
        let mut run = on(skin(&both, share, closes), config, DVec3::ZERO);
        let mut crushed = None;
        for tick in 0..180 {
            let report = run.step(&IDLE);
            let lid = room(run.stage.time());
            let p = run.position();
            let case = format!("{height}, tick {tick} at {p}");
            assert!(p.y > 0.0, "{case}: through the floor");
            // A crushed climber crouches, and has no upper ball then.
            let head = run.body().ends[1].y;
            assert!(head < lid, "{case}: through the lid {lid}");
            within!(p.x.abs() + p.z.abs(), 1e-3, "{case}: squeezed aside");
            if report.events.iter().any(is_crushed) && crushed.is_none() {
                crushed = Some(lid);
            }
        }
        // The margin is .02 at either end, and an overlap up to the margin is not reported as crushing.
        let told = crushed.unwrap();
        let is_right = (size - 0.12..=size).contains(&told);
        assert!(is_right, "{height}: crushed at {told} of room");
        assert_eq!(run.mode(), Standing, "{height}: {:?}", run.state());
        within!(run.feet().length(), 1e-3, "{height}: stands again");
    }
}

pub(crate) fn a_triangle_without_area_for_a_tick_keeps_the_climber() {
    for flat in [
        DVec3::new(0.0, 1.0, 1.0),
        DVec3::new(0.0, 1.0, 0.0),
        DVec3::ZERO,
    ] {
        let collapses = move |time: f64| {
            let tick = libm::round(time * 60.0);
            let scale = if tick == 30.0 { flat } else { DVec3::ONE };
            DAffine3::from_scale(scale)
        };
        let pose = move |time| (vec![collapses(time)], Similarity::IDENTITY);
        let furry = |pose| Skin::of(&plain(), SurfaceKind::Fur, &|_| vec![1.0], pose);
        for grips in [false, true] {
            let mut config = ClimberConfig::colossus_climber();
            config.body = jolt().body;
            config.ground = jolt().ground;
            config.tumble = None;
            config.stamina = None;
            // The jerk must not make the climber hang: only the hold is tested.
            if let Some(grip) = &mut config.grip {
                grip.hang_acceleration = f64::INFINITY;
            }
            let skin = furry(Box::new(pose) as crate::stage::Pose);
            let stage = Stage::new(one_kind()).with_skin(skin);
            let mut run = Run::new(stage, config, DVec3::new(0.2, 0.0, 0.1)).settle();
            let input = ClimberInput {
                grip: grips,
                ..IDLE
            };
            let mode = if grips { Holding } else { Standing };
            run.steps(29, &input);
            assert_eq!(run.mode(), mode, "{flat}");
            let before = run.position();
            for tick in 0..31 {
                run.step(&input);
                assert!(run.position().is_finite(), "{flat}, tick {tick}");
                let events = &run.trace.events;
                assert_eq!(run.mode(), mode, "{flat}, tick {tick}: {events:?}");
            }
            let off = run.position().distance(before);
            within!(off, 1e-3, "{flat}, grips {grips}: off by {off}");
        }
    }
}

/// The movement of a ball that up to seventeen planes touch, in a thousand directions in all.
pub(crate) fn no_velocity_enters_any_of_seventeen_planes() {
    let mut rng = fastrand::Rng::with_seed(36);
    let mut direction = || {
        let mut share = || rng.f64() * 2.0 - 1.0;
        loop {
            let v = DVec3::new(share(), share(), share());
            if (0.1..1.0).contains(&v.length()) {
                break v.normalize();
            }
        }
    };
    let mut config = walker_at(0.0);
    config.gravity = DVec3::ZERO;
    config.body.height = 0.0;
    for count in 1..=17 {
        // Squares of 40 m that touch the ball at rest. With enough of them, it cannot move in any direction.
        let normals: Vec<DVec3> = (0..count).map(|_| direction()).collect();
        let walls = normals.iter().fold(Shape::default(), |shape, normal| {
            let turn = glam::DQuat::from_rotation_arc(DVec3::Y, *normal);
            let square = Shape::field(DVec3::new(-20.0, -0.32, -20.0), 40.0, [1, 1], |_, _| 0.0);
            let pose = Similarity {
                rotation: turn,
                ..Similarity::IDENTITY
            };
            shape.and(square.placed(&pose))
        });
        let stage = Stage::new(one_kind()).with_still(&walls);
        let mut run = Run::new(stage, config, -DVec3::Y * 0.32);
        let rest = *run.state();
        for _ in 0..60 {
            let velocity = direction() * 6.0;
            run.put(clamber_climber::ClimberState { velocity, ..rest });
            run.step(&IDLE);
            let p = run.position();
            let entered = normals
                .iter()
                .map(|normal| -normal.dot(p))
                .fold(0.0, f64::max);
            within!(entered, 0.005, "{count} planes, {velocity}: by {entered}");
            // The movement is never backwards, and never farther than wanted.
            let made = p.dot(velocity.normalize());
            assert!(
                (-1e-3..=0.1 + 1e-3).contains(&made),
                "{count} planes, {velocity}: {made}"
            );
        }
    }
}
