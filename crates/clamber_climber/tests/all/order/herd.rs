use clamber_climber::{
    Climber, ClimberConfig, ClimberInput, ClimberObstacle, ContactQuery, StepReport, StepRules,
};
use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use clamber_surface::rig::{Clip, Palette, Playback, Skeleton};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{Obstacle, ObstacleId};
use glam::{DQuat, DVec3};
use rayon::prelude::*;

use crate::creature::{clip, ground, skeleton, tube};
use crate::scene::{DT, rest};

/// Number of creatures.
pub(crate) const CREATURES: usize = 3;

/// Number of climbers.
pub(crate) const CLIMBERS: usize = 6;

/// First id of the climbers' bodies.
const BODIES: u64 = 100;

/// The order in which items of a list are processed.
pub(crate) enum Order {
    Listed,
    /// A new random order for each list.
    Shuffled(fastrand::Rng),
}

impl Order {
    fn of(&mut self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        if let Self::Shuffled(rng) = self {
            rng.shuffle(&mut order);
        }
        order
    }
}

/// Three tubes that cross each other and turn, with climbers on them.
pub(crate) struct Herd {
    skeleton: Skeleton,
    clip: Clip,
    creatures: [SkinnedSurface; CREATURES],
    floor: SkinnedSurface,
    pub(crate) climbers: Vec<Climber>,
    pub(crate) bodies_are_there: bool,
    /// Ticks in which two climbers were within 2 cm of each other.
    pub(crate) touches: u32,
}

impl Herd {
    pub(crate) fn new() -> Self {
        let mut floor = SkinnedSurface::new(ground());
        let under = Similarity::from_translation(DVec3::Y * -3.0);
        floor.teleport(&rest(), under).unwrap();
        let mut herd = Self {
            skeleton: skeleton(),
            clip: clip(),
            creatures: std::array::from_fn(|_| SkinnedSurface::new(tube())),
            floor,
            climbers: (0..CLIMBERS).map(climber).collect(),
            bodies_are_there: true,
            touches: 0,
        };
        for index in 0..CREATURES {
            let palette = herd.palette(0, index);
            herd.creatures[index]
                .teleport(&palette, place(0, index))
                .unwrap();
        }
        herd
    }

    fn palette(&self, tick: u32, index: usize) -> Palette {
        let time = 0.3 * f64::from(tick) * DT + 0.6 * index as f64;
        let rest = self.skeleton.rest_pose();
        let pose = self.clip.sample(&rest, time, Playback::Loop).unwrap();
        self.skeleton.palette(&pose).unwrap()
    }

    fn pose(&mut self, tick: u32, order: &[usize]) {
        for &index in order {
            let palette = self.palette(tick + 1, index);
            self.creatures[index]
                .advance(&palette, place(tick + 1, index))
                .unwrap();
        }
    }

    /// One tick. Returns the fingerprint and the report of each climber, by its index.
    pub(crate) fn tick(&mut self, tick: u32, order: &mut Order) -> Vec<(u64, StepReport)> {
        self.pose(tick, &order.of(CREATURES));
        let bodies = self.bodies();
        let mut told = vec![None; CLIMBERS];
        for index in order.of(CLIMBERS) {
            let mut listed = order.of(1 + CREATURES + CLIMBERS);
            if !self.bodies_are_there {
                listed.retain(|place| *place <= CREATURES);
            }
            let world = (&self.floor, &self.creatures, &bodies[..]);
            told[index] = Some(step(&mut self.climbers[index], index, tick, world, &listed));
        }
        self.count_touches();
        told.into_iter().map(Option::unwrap).collect()
    }

    /// [`Self::tick`] with each climber as a task of its own, in random order.
    pub(crate) fn tick_on_threads(
        &mut self,
        tick: u32,
        rng: &mut fastrand::Rng,
    ) -> Vec<(u64, StepReport)> {
        let mut order = Order::Shuffled(rng.fork());
        self.pose(tick, &order.of(CREATURES));
        let bodies = self.bodies();
        let world = (&self.floor, &self.creatures, &bodies[..]);
        let listed = order.of(1 + CREATURES + CLIMBERS);
        let mut tasks: Vec<_> = self.climbers.iter_mut().enumerate().collect();
        rng.shuffle(&mut tasks);
        let told = tasks
            .into_par_iter()
            .map(|(index, climber)| (index, step(climber, index, tick, world, &listed)));
        let mut told: Vec<_> = told.collect();
        told.sort_by_key(|(index, _)| *index);
        told.into_iter().map(|(_, told)| told).collect()
    }

    fn bodies(&self) -> Vec<ClimberObstacle> {
        let mut fixed: Vec<(ObstacleId, &dyn Obstacle)> = vec![(ObstacleId(50), &self.floor)];
        for (place, creature) in self.creatures.iter().enumerate() {
            fixed.push((ObstacleId(place as u64 + 1), creature));
        }
        let climbers = self.climbers.iter();
        climbers
            .map(|climber| ClimberObstacle::new(climber, &fixed, DT))
            .collect()
    }

    fn count_touches(&mut self) {
        let places: Vec<DVec3> = self
            .climbers
            .iter()
            .map(|climber| climber.state().position)
            .collect();
        let touch = |a: usize, b: usize| places[a].distance(places[b]) < 0.82;
        let mut pairs = (0..CLIMBERS).flat_map(|a| (0..a).map(move |b| (a, b)));
        self.touches += u32::from(pairs.any(|(a, b)| touch(a, b)));
    }
}

/// All obstacles that a climber can touch.
type World<'a> = (
    &'a SkinnedSurface,
    &'a [SkinnedSurface; CREATURES],
    &'a [ClimberObstacle],
);

/// Steps a climber. `listed` is the order of the floor, the creatures and the bodies in its list of obstacles.
fn step(
    climber: &mut Climber,
    index: usize,
    tick: u32,
    (floor, creatures, bodies): World<'_>,
    listed: &[usize],
) -> (u64, StepReport) {
    let mut obstacles: Vec<(ObstacleId, &dyn Obstacle)> = Vec::new();
    for &place in listed {
        if place == 0 {
            obstacles.push((ObstacleId(50), floor));
        } else if let Some(creature) = creatures.get(place - 1) {
            obstacles.push((ObstacleId(place as u64), creature));
        } else if place - 1 - CREATURES != index {
            let body = place - 1 - CREATURES;
            obstacles.push((ObstacleId(BODIES + body as u64), &bodies[body]));
        }
    }
    let input = input(index as u32, tick, climber.state().position);
    // Every other climber has a rule that uses each field of a rule.
    let is_ruled = index % 2 == 1;
    let rule = |query: &ContactQuery<'_>| {
        let id = query.id.0;
        let usual = query.usual().with_grip(id < BODIES);
        if !is_ruled {
            usual
        } else if query.is_character() {
            usual.with_solid(id.is_multiple_of(2))
        } else {
            let level = query.contact.normal.y > 0.9;
            let is_solid = index != 5 || id != 2 || query.is_from_above();
            let usual = usual.with_solid(is_solid).with_step(id.is_multiple_of(2));
            usual.with_friction(if level { 0.7 } else { 1.0 })
        }
    };
    let rules = StepRules::by(&rule);
    let report = climber.step_with(&input, &obstacles, &rules, DT).unwrap();
    (climber.state().fingerprint(), report)
}

/// Pose of a creature's root. The creatures' centres are above each other, and move up and down.
fn place(tick: u32, index: usize) -> Similarity {
    let time = f64::from(tick) * DT;
    let turn = turn(index, time);
    let roll = rotation_from_axis_angle(DVec3::X, 0.1 * libm::sin(2.0 * time));
    let bob = 0.3 * libm::sin(1.5 * time + index as f64);
    Similarity {
        rotation: turn * roll,
        scale: 1.0,
        translation: turn * (DVec3::X * -7.5) + DVec3::Y * bob,
    }
}

/// A climber above a tube. Each tube has two, so close that they touch.
fn climber(index: usize) -> Climber {
    let config = if index.is_multiple_of(2) {
        ClimberConfig::colossus_climber()
    } else {
        ClimberConfig::walker()
    };
    let along = turn(index % CREATURES, 0.0) * DVec3::X;
    let out = if index < CREATURES { 2.0 } else { 2.81 };
    Climber::new(config, along * out + DVec3::Y * 2.5).unwrap()
}

/// Rotation of a creature about up, so that the creatures cross each other.
fn turn(creature: usize, time: f64) -> DQuat {
    rotation_from_axis_angle(DVec3::Y, 1.1 * creature as f64 + 0.1 * time)
}

/// Walks to the middle, where all climbers meet, and in circles there.
fn input(index: u32, tick: u32, position: DVec3) -> ClimberInput {
    let middle = -position * DVec3::new(1.0, 0.0, 1.0);
    let angle = f64::from(index * 2 + tick / 45);
    let about = DVec3::new(libm::cos(angle), 0.0, libm::sin(angle));
    ClimberInput {
        walk: middle.clamp_length_max(0.7) + about * 0.3,
        jump: (tick + 13 * index).is_multiple_of(80),
        grip: index.is_multiple_of(2) && !(tick / 60 + index).is_multiple_of(3),
        ..ClimberInput::default()
    }
}
