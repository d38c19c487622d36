//! Ledges that are followed to their end, over steps, across gaps and around corners, while the stick is held.

use clamber_climber::ClimberInput;
use clamber_climber::ClimberMode::LedgeHanging;
use clamber_surface::geometry::Similarity;
use glam::DVec3;

use crate::input::{HOLD, grip_walk};
use crate::stage::{Played, Run, Shape, Stage, Trace, every, tireless, turned, within};

/// A scene with an edge at height 0. The climber hangs from it at the origin, facing -Z.
struct Scene {
    name: &'static str,
    walls: Vec<Shape>,
    /// The stick, which is held.
    stick: DVec3,
    /// Time for which the stick is held, seconds.
    seconds: f64,
    /// The climber's final position and facing; the facing is zero where it has begun to turn.
    ends: (DVec3, DVec3),
    /// True if the climber is at rest there although the stick is held.
    rests: bool,
    /// Number of times that the climber's way turns back: once in a sharp inner corner.
    turns_back: u32,
}

/// Distance of the ball's centre below the edge, metres.
const DROP: f64 = 0.6;

/// Radius of the ball, and its centre's distance from the wall, metres.
const RADIUS: f64 = 0.4;

/// Speed along a ledge, metres a second.
const SHIMMY: f64 = 1.0;

/// Speed at which arms draw, metres a second.
const DRAW: f64 = 3.0;

/// The climber's position before any shimmy.
const START: DVec3 = DVec3::new(0.0, -DROP, RADIUS);

/// A wall 4 m high whose top is at a height, from one x to another, with its face at a z.
fn wall(from: f64, to: f64, top: f64, face: f64) -> Shape {
    Shape::boxed(DVec3::new(from, -4.0, -3.0), DVec3::new(to, top, face))
}

/// An upright prism over a polygon, counter-clockwise seen from above, with its top at height 0.
fn prism(corners: &[(f64, f64)]) -> Shape {
    let count = corners.len() as u32;
    let at = |y: f64| corners.iter().map(move |&(x, z)| DVec3::new(x, y, z));
    let mut shape = Shape {
        positions: at(-4.0).chain(at(0.0)).collect(),
        triangles: Vec::new(),
    };
    for k in 0..count {
        let next = (k + 1) % count;
        shape.triangles.push([k, next, next + count]);
        shape.triangles.push([k, next + count, k + count]);
    }
    for k in 2..count {
        shape.triangles.push([0, k, k - 1]);
        shape.triangles.push([count, count + k - 1, count + k]);
    }
    shape
}

/// The position at a wall whose face is `normal`, at a point of its edge.
fn at(edge: DVec3, normal: DVec3) -> DVec3 {
    edge + normal * RADIUS - DVec3::Y * DROP
}

fn ends() -> Vec<Scene> {
    let stop = |name: &'static str, second: Shape, x: f64| Scene {
        name,
        walls: vec![wall(-2.0, 1.0, 0.0, 0.0), second],
        stick: (DVec3::X * 2.0 - DVec3::Z * f64::from(u8::from(name.ends_with("well"))))
            .normalize(),
        seconds: 4.0,
        ends: (
            START + DVec3::X * x,
            if x > 1.0 { DVec3::ZERO } else { DVec3::NEG_Z },
        ),
        rests: true,
        turns_back: 0,
    };
    let name = "a higher wall, with the stick towards the wall as well";
    vec![
        stop("a higher wall", wall(1.0, 3.0, 0.6, 0.0), 0.95),
        stop("a lower wall", wall(1.0, 3.0, -0.4, 0.0), 1.05),
        stop("a higher wall across", wall(1.0, 3.0, 0.6, 2.0), 0.6),
        stop("a gap wider than the reach", wall(1.5, 3.0, 0.0, 0.0), 1.25),
        stop(name, wall(1.0, 3.0, 0.6, 0.0), 0.95),
    ]
}

/// Ledges that go on straight: up or down, back or forward, across a gap.
fn straight() -> Vec<Scene> {
    let mut scenes = Vec::new();
    let mut on = |name, gap: f64, top: f64, face: f64| {
        let second = wall(0.8137 + gap, 9.0, top, face);
        scenes.push(Scene {
            name,
            walls: vec![wall(-2.0, 0.8137, 0.0, 0.0), second],
            stick: DVec3::X,
            seconds: 3.0,
            ends: (START + DVec3::new(3.0, top, face), DVec3::NEG_Z),
            rests: false,
            turns_back: 0,
        });
    };
    on("5 cm up", 0.0, 0.05, 0.0);
    on("5 cm down", 0.0, -0.05, 0.0);
    on("half a radius up", 0.0, 0.2, 0.0);
    on("half a radius down", 0.0, -0.2, 0.0);
    on("5 cm back", 0.0, 0.0, -0.05);
    on("5 cm forward", 0.0, 0.0, 0.05);
    on("half a radius back", 0.0, 0.0, -0.2);
    on("half a radius forward", 0.0, 0.0, 0.2);
    on("up and forward", 0.0, 0.1, 0.1);
    on("down and back", 0.0, -0.1, -0.1);
    on("a gap of 2 cm", 0.02, 0.0, 0.0);
    on("a gap of 10 cm", 0.1, 0.0, 0.0);
    on("a gap of the arms' reach", 0.35, 0.0, 0.0);
    on("a gap, and up", 0.3, 0.1, 0.0);
    scenes
}

fn corners() -> Vec<Scene> {
    let scene = |name, walls, seconds, ends| Scene {
        name,
        walls,
        stick: DVec3::X,
        seconds,
        ends,
        rests: false,
        turns_back: u32::from(name == "a sharp inner corner"),
    };
    // The way leads to the corner, around it on a circle, and along the next wall.
    let arc = |degrees: f64| degrees.to_radians() * RADIUS;
    let square = prism(&[(-3.0, 0.0), (0.8, 0.0), (0.8, -9.0), (-3.0, -9.0)]);
    let obtuse = prism(&[(-3.0, 0.0), (0.8, 0.0), (6.8, -6.0), (-3.0, -6.0)]);
    let sharp = prism(&[(-6.0, 0.0), (0.8, 0.0), (-5.2, -6.0)]);
    let thin = prism(&[(-6.0, 0.0), (0.8, 0.0), (0.8, -0.3), (-6.0, -0.3)]);
    let diagonal = DVec3::new(1.0, 0.0, -1.0).normalize();
    let other = |x: f64, z: f64| DVec3::new(x, 0.0, z);
    vec![
        scene(
            "an outer corner",
            vec![square],
            3.0,
            (at(other(0.8, -(2.2 - arc(90.0))), DVec3::X), DVec3::NEG_X),
        ),
        scene("an obtuse outer corner", vec![obtuse], 3.0, {
            let normal = DVec3::new(1.0, 0.0, 1.0).normalize();
            let made = 2.2 - arc(45.0);
            (at(other(0.8, 0.0) + diagonal * made, normal), -normal)
        }),
        scene("a sharp outer corner", vec![sharp], 3.5, {
            let normal = DVec3::new(1.0, 0.0, -1.0).normalize();
            let along = DVec3::new(-1.0, 0.0, -1.0).normalize();
            let made = 2.7 - arc(135.0);
            (at(other(0.8, 0.0) + along * made, normal), -normal)
        }),
        scene(
            "the end of a thin wall",
            vec![thin],
            4.0,
            (
                at(other(0.8 - (2.9 - 2.0 * arc(90.0)), -0.3), DVec3::NEG_Z),
                DVec3::Z,
            ),
        ),
        scene(
            "an inner corner",
            vec![wall(-2.0, 0.8, 0.0, 0.0), wall(0.8, 3.0, 0.0, 9.0)],
            3.0,
            (at(other(0.8, RADIUS + 2.6), DVec3::NEG_X), DVec3::X),
        ),
        scene(
            "an inner corner to a higher wall",
            vec![wall(-2.0, 0.8, 0.0, 0.0), wall(0.8, 3.0, 0.15, 9.0)],
            3.0,
            (
                at(DVec3::new(0.8, 0.15, RADIUS + 2.6), DVec3::NEG_X),
                DVec3::X,
            ),
        ),
        scene(
            "an obtuse inner corner",
            vec![
                prism(&[(-3.0, 0.0), (0.8, 0.0), (0.8, -3.0), (-3.0, -3.0)]),
                prism(&[(0.8, 0.0), (6.8, 6.0), (6.8, -3.0), (0.8, -3.0)]),
            ],
            3.0,
            {
                let along = DVec3::new(1.0, 0.0, 1.0).normalize();
                let normal = DVec3::new(-1.0, 0.0, 1.0).normalize();
                // The ball stops short of the corner.
                let short = RADIUS * libm::tan(22.5f64.to_radians());
                (
                    at(other(0.8, 0.0) + along * (2.2 + 2.0 * short), normal),
                    -normal,
                )
            },
        ),
        scene(
            "a sharp inner corner",
            vec![
                wall(-2.0, 1.6, 0.0, 0.0),
                prism(&[(1.6, 0.0), (-3.4, 5.0), (3.0, 5.0), (3.0, 0.0)]),
            ],
            3.0,
            {
                let along = DVec3::new(-1.0, 0.0, 1.0).normalize();
                let normal = DVec3::new(-1.0, 0.0, -1.0).normalize();
                let short = RADIUS * libm::tan(67.5f64.to_radians());
                let made = 3.0 - (1.6 - short);
                (
                    at(other(1.6, 0.0) + along * (short + made), normal),
                    -normal,
                )
            },
        ),
    ]
}

/// Tick rates, hertz.
const RATES: [f64; 4] = [60.0, 30.0, 120.0, 240.0];

/// A climber that hangs at the origin.
fn hung(stage: Stage, yaw: &Similarity, case: &str) -> Run {
    let mut config = tireless();
    config.grip = None;
    let start = yaw.rotation * DVec3::new(0.0, -0.5, 0.45) - DVec3::Y * RADIUS;
    let ticks = (1.0 / stage.dt).round() as u32;
    let mut run = Run::new(stage, config, start);
    let walk = yaw.rotation * DVec3::NEG_Z * 0.1;
    for _ in 0..ticks {
        let is_caught = run.mode() == LedgeHanging;
        run.step(&if is_caught { HOLD } else { grip_walk(walk) });
    }
    let off = run.position().distance(yaw.rotation * START);
    within!(off, 2e-3, "{case}: hangs at {}", run.position());
    run
}

/// Plays a scene, turned about the vertical and mirrored, and checks every tick.
fn play(scene: &Scene, played: Played, rate: f64, is_mirrored: bool, angle: f64) -> Trace {
    let dt = 1.0 / rate;
    let name = scene.name;
    let case = format!("{played:?}, {name}, {rate} Hz, mirrored: {is_mirrored}");
    let yaw = turned(DVec3::Y, angle);
    let map = |v: DVec3| {
        let x = if is_mirrored { -v.x } else { v.x };
        yaw.rotation * DVec3::new(x, v.y, v.z)
    };
    let mut stage = Stage::at(played, dt, DVec3::ZERO);
    for shape in &scene.walls {
        let mut shape = shape.clone();
        for p in &mut shape.positions {
            *p = map(*p);
        }
        let shape = if is_mirrored { shape.flipped() } else { shape };
        stage = stage.with_still(&shape);
    }
    let mut run = hung(stage, &yaw, &case);
    let walk = map(scene.stick);
    let input = ClimberInput { walk, ..HOLD };
    let (mut last, mut last_way, mut reversals) = (run.position(), DVec3::ZERO, 0);
    let ticks = (scene.seconds * rate).round() as u32;
    for tick in 0..ticks {
        run.step(&input);
        let way = run.position() - last;
        let told = format!("{case}, tick {tick} at {last}, then {way}");
        assert_eq!(run.mode(), LedgeHanging, "{told}");
        let longest = DRAW * dt * (1.0 + 1e-9) + 1e-5;
        within!(way.length(), longest, "{told}: too far");
        let is_reversal = way.dot(last_way) < 0.0 && way.length().min(last_way.length()) > 1e-4;
        reversals += u32::from(is_reversal);
        assert!(reversals <= scene.turns_back, "{told}, was {last_way}");
        let velocity = run.state().velocity;
        let off = velocity.distance(way / dt);
        let allowed = 0.05 * velocity.length() + 2e-2;
        within!(off, allowed, "{told}: velocity {velocity}");
        (last, last_way) = (run.position(), way);
    }
    let (position, facing) = (map(scene.ends.0), map(scene.ends.1));
    let place = run.position();
    let off = place.distance(position);
    // The way is longer where the ball rolls around an edge or moves up a step.
    let allowed = if scene.rests {
        SHIMMY * dt + 0.15
    } else {
        0.25
    };
    within!(
        off,
        allowed,
        "{case}: ends at {place}, {off} m from {position}"
    );
    if facing != DVec3::ZERO {
        let heading = run.state().heading;
        within!(heading.distance(facing), 1e-3, "{case}: faces {heading}");
    }
    if scene.rests {
        for _ in 0..ticks / 4 {
            run.step(&input);
            let told = format!("{case}: at rest at {}", run.position());
            within!(run.position().distance(last), 1e-4, "{told}, was {last}");
            let velocity = run.state().velocity;
            within!(velocity.length(), 1e-4, "{told}: {velocity}");
        }
    }
    // The climber goes back the same way, and rests where it is once the stick is released.
    run.steps((1.5 * rate) as u32, &HOLD);
    let rest = run.position();
    for _ in 0..(0.5 * rate) as u32 {
        run.step(&HOLD);
        let off = run.position().distance(rest);
        within!(off, 1e-4, "{case}: rests at {rest}");
        let velocity = run.state().velocity;
        within!(velocity.length(), 1e-4, "{case}: {velocity}");
    }
    run.sound()
}

fn play_all(scenes: &[Scene]) {
    for (index, scene) in scenes.iter().enumerate() {
        for turn in 0..2 {
            let rate = RATES[(2 * turn + index) % 4];
            let angle = 0.7 * index as f64;
            every(0.0, |played| play(scene, played, rate, turn == 1, angle));
        }
    }
}

pub(crate) fn a_climber_rests_at_the_end_of_a_ledge_with_the_stick_kept() {
    play_all(&ends());
}

pub(crate) fn a_ledge_is_followed_over_steps_and_across_gaps() {
    play_all(&straight());
}

pub(crate) fn a_ledge_is_followed_around_corners() {
    play_all(&corners());
}
