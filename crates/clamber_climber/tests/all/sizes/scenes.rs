//! Scenes in which every number of a configuration matters.

use std::f64::consts::TAU;

use clamber_climber::ClimberMode::{
    Falling, Hanging, Holding, LedgeHanging, Sliding, Standing, Tumbling,
};
use clamber_climber::{ClimberConfig, ClimberInput};
use glam::DVec3;

use crate::input::{HOLD, IDLE, grip_walk, walk};
use crate::scene::{FUR, STONE};
use crate::sizes::play::Scene;

/// A climber with every ability on. None of its times is a whole number of ticks, so that rounding decides nothing.
pub(crate) fn person() -> ClimberConfig {
    let mut config = ClimberConfig::colossus_climber();
    config.body.height = 0.9;
    let ground = &mut config.ground;
    ground.acceleration = 25.0;
    ground.air_acceleration = 6.0;
    ground.terminal_speed = 13.0;
    ground.slide_friction = 0.3;
    ground.jump_release_gravity = 2.5;
    ground.coyote_time = 0.113;
    ground.jump_buffer = 0.157;
    let grip = config.grip.as_mut().unwrap();
    grip.calm_time = 0.413;
    grip.max_overhang = 2.0;
    config.ledge.as_mut().unwrap().pull_up_time = 0.617;
    config.tumble.as_mut().unwrap().recover_time = 0.513;
    config
}

impl Scene {
    /// The scene's climber at size 1.
    pub(crate) fn person(&self) -> ClimberConfig {
        let mut config = person();
        (self.adjust)(&mut config);
        config
    }
}

/// A scene without input that other scenes vary.
const STAGE: Scene = Scene {
    name: "",
    cuboid: None,
    motion: |_| DVec3::ZERO,
    half_space: (DVec3::ZERO, DVec3::Y, STONE),
    adjust: |_| {},
    position: DVec3::new(0.0, 0.4, 0.0),
    velocity: DVec3::ZERO,
    input: |_| IDLE,
    jump: None,
    blow: None,
    seconds: 2.0,
    from: 0.0,
    shows: Standing,
};

/// A box of 8 by 8 by 16 m with an edge of its top at x and y, to the right of the edge (`side` 1) or to its left (-1).
const fn boxed(x: f64, y: f64, side: f64) -> Option<[DVec3; 2]> {
    let center = DVec3::new(x + 4.0 * side, y - 4.0, 0.0);
    Some([center, DVec3::new(4.0, 4.0, 8.0)])
}

/// A swing of `size` metres to either side, `times` times a second, at a time.
fn swing(size: f64, times: f64, time: f64) -> f64 {
    size * libm::sin(TAU * times * time)
}

/// The climber hangs below the edge of a box whose top is at height 0 and whose front is at x = 0.
const LEDGE: Scene = Scene {
    cuboid: boxed(0.0, 0.0, 1.0),
    half_space: (DVec3::new(0.0, -30.0, 0.0), DVec3::Y, STONE),
    position: DVec3::new(-0.78, -0.8, 0.1),
    from: 2.5,
    shows: LedgeHanging,
    ..STAGE
};

/// The climber holds a wall of fur whose front is at x = 0.
const WALL: Scene = Scene {
    half_space: (DVec3::ZERO, DVec3::NEG_X, FUR),
    position: DVec3::new(-0.7, 0.0, 0.1),
    input: |_| HOLD,
    from: 0.5,
    shows: Holding,
    ..STAGE
};

pub(crate) fn scenes() -> Vec<Scene> {
    vec![
        Scene {
            name: "walks up a curb, and stops",
            cuboid: boxed(1.0, 0.41, 1.0),
            input: |time| walk(DVec3::X * if time < 1.2 { 1.0 } else { 0.0 }),
            ..STAGE
        },
        Scene {
            name: "runs down a step",
            adjust: |config| {
                config.ground.walk_speed = 15.0;
                config.ground.acceleration = 1_000.0;
            },
            // At 30 Hz, the climber moves in a tick from above the step to beyond its edge.
            cuboid: boxed(0.75, 0.18, -1.0),
            position: DVec3::new(-0.3, 0.58, 0.0),
            input: |_| walk(DVec3::X),
            seconds: 0.5,
            ..STAGE
        },
        Scene {
            name: "crouches below a ceiling",
            cuboid: boxed(-4.0, 9.6, 1.0),
            input: |_| walk(DVec3::Z),
            ..STAGE
        },
        Scene {
            name: "stands on a slope",
            half_space: (DVec3::ZERO, DVec3::new(-0.731, 0.682, 0.0), STONE),
            position: DVec3::new(-0.3, 0.28, 0.0),
            input: |_| walk(DVec3::new(0.3, 0.0, 0.2)),
            ..STAGE
        },
        Scene {
            name: "slides down a slope",
            half_space: (DVec3::ZERO, DVec3::new(-0.866, 0.5, 0.0), STONE),
            position: DVec3::new(-0.4, 0.25, 0.0),
            shows: Sliding,
            ..STAGE
        },
        Scene {
            name: "jumps, steers and lands",
            input: |time| ClimberInput {
                jump_held: time < 0.45,
                ..walk(DVec3::new(0.6, 0.0, 0.3))
            },
            jump: Some(0.3),
            shows: Falling,
            ..STAGE
        },
        Scene {
            name: "jumps too early",
            position: DVec3::new(0.0, 0.9, 0.0),
            jump: Some(0.2),
            ..STAGE
        },
        Scene {
            name: "falls from high",
            position: DVec3::new(0.0, 16.0, 0.0),
            seconds: 5.0,
            shows: Tumbling,
            ..STAGE
        },
        Scene {
            name: "is shoved",
            blow: Some((0.5, DVec3::new(2.2, 0.0, 0.7))),
            ..STAGE
        },
        Scene {
            name: "is knocked over",
            blow: Some((0.5, DVec3::new(2.5, 2.2, 0.7))),
            seconds: 4.0,
            shows: Tumbling,
            ..STAGE
        },
        Scene {
            name: "is knocked down by its ground",
            motion: |time| DVec3::X * swing(0.115, 5.0, time.min(0.4)),
            seconds: 3.0,
            shows: Tumbling,
            ..STAGE
        },
        Scene {
            name: "is thrown off by its ground",
            motion: |time| DVec3::Y * swing(0.1, 4.4, time),
            seconds: 1.0,
            shows: Falling,
            ..STAGE
        },
        Scene {
            name: "climbs a wall that shakes, and jumps off",
            motion: |time| DVec3::Y * swing(0.05, 2.0, time),
            input: |time| ClimberInput {
                climb: DVec3::new(0.0, 0.8, 0.6),
                grip: time < 1.41,
                ..IDLE
            },
            jump: Some(1.4),
            ..WALL
        },
        Scene {
            name: "catches fur in a fall",
            velocity: DVec3::new(0.0, -12.5, 0.0),
            seconds: 1.0,
            ..WALL
        },
        Scene {
            name: "hangs from a wall that shakes, until it is calm",
            motion: |time| DVec3::Y * swing(0.1, 2.5, time.min(1.2)),
            seconds: 3.0,
            shows: Hanging,
            ..WALL
        },
        Scene {
            name: "holds a wall that leans over",
            half_space: (DVec3::ZERO, DVec3::new(-0.95, -0.3, 0.0), FUR),
            position: DVec3::new(-0.6, 0.0, 0.0),
            ..WALL
        },
        Scene {
            name: "hangs from a ceiling, and swings",
            half_space: (DVec3::ZERO, DVec3::new(-0.3, -0.95, 0.0), FUR),
            position: DVec3::new(0.0, -0.5, 0.0),
            blow: Some((1.0, DVec3::new(0.5, 0.0, 1.5))),
            shows: Hanging,
            ..WALL
        },
        Scene {
            name: "goes along a ledge",
            input: |time| {
                grip_walk(if time < 2.7 {
                    DVec3::X * 0.01
                } else {
                    DVec3::Z
                })
            },
            seconds: 3.5,
            ..LEDGE
        },
        Scene {
            name: "pulls itself up",
            input: |time| ClimberInput {
                walk: DVec3::X * if time < 2.7 { 0.01 } else { 1.0 },
                grip: time < 3.5,
                ..IDLE
            },
            seconds: 4.0,
            shows: Standing,
            ..LEDGE
        },
        Scene {
            name: "catches a ledge in a fall",
            position: DVec3::new(-0.65, 0.0, 0.1),
            velocity: DVec3::new(0.0, -12.5, 0.0),
            input: |_| grip_walk(DVec3::X * 0.01),
            seconds: 3.0,
            ..LEDGE
        },
    ]
}
