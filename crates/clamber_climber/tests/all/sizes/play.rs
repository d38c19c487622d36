//! Plays a scene at a size: lengths are scaled by the size, speeds and times by its square root.

use clamber_climber::{Climber, ClimberConfig, ClimberInput, ClimberMode, ClimberState, StepRules};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::SurfaceTag;
use clamber_world::{HalfSpace, Obstacle, ObstacleId};
use glam::{DQuat, DVec3};

use crate::input::blow;
use crate::moving::MovingHalfSpace;
use crate::scene::{STONE, cuboid, rest};

/// A scene at size 1: a box, a half-space that may move, and a climber.
pub(crate) struct Scene {
    pub(crate) name: &'static str,
    /// Changes to the usual climber's configuration.
    pub(crate) adjust: fn(&mut ClimberConfig),
    /// The box's centre, and half its lengths.
    pub(crate) cuboid: Option<[DVec3; 2]>,
    /// A point of the half-space's plane, its normal and tag.
    pub(crate) half_space: (DVec3, DVec3, SurfaceTag),
    /// Displacement of the half-space at a time in seconds.
    pub(crate) motion: fn(f64) -> DVec3,
    pub(crate) position: DVec3,
    pub(crate) velocity: DVec3,
    /// The input at a time; jumps and blows are true for one tick.
    pub(crate) input: fn(f64) -> ClimberInput,
    /// Times of the tick of a jump, and of a blow.
    pub(crate) jump: Option<f64>,
    pub(crate) blow: Option<(f64, DVec3)>,
    pub(crate) seconds: f64,
    /// Time from which the states are compared, seconds: before it, speeds that are no part of the configuration show.
    pub(crate) from: f64,
    /// A mode that the climber is in at some time.
    pub(crate) shows: ClimberMode,
}

/// The compared part of a state, in the units of size 1. The frame in the air is left out: it becomes the air's within
/// two seconds at every size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    pub(crate) mode: ClimberMode,
    numbers: [f64; 36],
}

impl Seen {
    fn new(state: &ClimberState, size: f64) -> Self {
        let root = libm::sqrt(size);
        let vectors = [
            state.position / size,
            state.velocity / root,
            state.support.map_or(DVec3::ZERO, |_| state.base_velocity) / root,
            state.own_way / size,
            state.heading,
            state.support_velocity.unwrap_or_default() / root,
            state.shake,
            state.hanging.legs / size,
        ];
        let others = [
            state.stamina,
            state.hit_points,
            state.coyote / root,
            state.jump_buffer / root,
            state.hanging.arm / size,
            state.hanging.calm / root,
            state.ledge_hanging.pull_up,
            state.tumbling.still / root,
            state.tumbling.down / root,
            f64::from(u8::from(state.crouched)),
            f64::from(u8::from(state.flying.jumping)),
            f64::from(u8::from(state.standing.shoved)),
        ];
        let mut numbers = [0.0; 36];
        let all = vectors.iter().flat_map(|v| v.to_array()).chain(others);
        for (number, value) in numbers.iter_mut().zip(all) {
            *number = value;
        }
        Self {
            mode: state.mode,
            numbers,
        }
    }

    /// The largest difference of a number, relative to its size or to 1.
    pub(crate) fn apart(&self, other: &Self) -> f64 {
        if self.mode != other.mode {
            return f64::INFINITY;
        }
        let pairs = self.numbers.iter().zip(&other.numbers);
        pairs
            .map(|(a, b)| (a - b).abs() / a.abs().max(1.0))
            .fold(0.0, f64::max)
    }
}

/// Plays a scene with a climber whose configuration already has the size. `rate` is the tick rate at size 1.
pub(crate) fn play(scene: &Scene, config: ClimberConfig, size: f64, rate: f64) -> Vec<Seen> {
    let root = libm::sqrt(size);
    let dt = root / rate;
    let surface = scene.cuboid.map(|[center, half]| {
        let mut surface = cuboid(half.as_vec3(), STONE);
        let place = Similarity {
            translation: center * size,
            rotation: DQuat::IDENTITY,
            scale: size,
        };
        surface.teleport(&rest(), place).unwrap();
        surface
    });
    let (point, normal, tag) = scene.half_space;
    let at_rest = HalfSpace::behind(point * size, normal)
        .unwrap()
        .with_tag(tag);
    let mut climber = Climber::new(config, scene.position * size).unwrap();
    climber
        .restore(ClimberState {
            velocity: scene.velocity * root,
            stamina: 0.9,
            crouched: true,
            ..*climber.state()
        })
        .unwrap();
    let tick_of = |time: f64| (time * rate).round() as u32;
    let mut seen = Vec::new();
    for tick in 1..=tick_of(scene.seconds) {
        let time = f64::from(tick) / rate;
        let half_space = MovingHalfSpace {
            at_rest,
            shifts: [tick - 1, tick].map(|tick| (scene.motion)(f64::from(tick) / rate) * size),
        };
        let mut obstacles: Vec<(ObstacleId, &dyn Obstacle)> = vec![(ObstacleId(0), &half_space)];
        if let Some(surface) = &surface {
            obstacles.push((ObstacleId(1), surface));
        }
        let struck = scene.blow.filter(|(when, _)| tick_of(*when) == tick);
        let input = ClimberInput {
            jump: scene.jump.is_some_and(|when| tick_of(when) == tick),
            ..(scene.input)(time)
        };
        let rules = StepRules {
            knockback: struck.and_then(|(_, velocity)| blow(velocity * root)),
            ..StepRules::default()
        };
        let step = climber.step_with(&input, &obstacles, &rules, dt);
        let report = step.unwrap();
        assert!(
            report.is_clear,
            "{} at size {size}, tick {tick}",
            scene.name
        );
        if time >= scene.from {
            seen.push(Seen::new(climber.state(), size));
        }
    }
    seen
}
