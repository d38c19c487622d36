//! The giant's life in fast forward: it wanders in a valley with boulders and a wall, five riders wander and climb on
//! it, arrows and blades hit it now and then, the game sends it away when the riders have left it, and when it dies the
//! next one lives.

mod options;
mod rider;
mod tally;

use std::sync::Arc;

use clamber_climber::{Blow, ClimberError};
use clamber_colossus::brain::Act;
use clamber_colossus::{
    Brain, BrainError, ColossusError, Creature, CreatureConfig, CreatureEvent, CreatureKind, Noise,
    Person, Surroundings, Wound,
};
use clamber_surface::mesh::TriangleId;
use clamber_world::rapier3d::prelude::*;
use clamber_world::{BodyPoses, MaterialPoint, Obstacle, ObstacleId, RapierTerrain};
use glam::DVec3;
use indicatif::{ProgressBar, ProgressStyle};
use thiserror::Error;

use crate::{CreatureError, giant, person, valley};
pub use options::LifeOptions;
use rider::Rider;
pub use tally::{StateLine, Tally};

/// Length of a tick, seconds.
pub const TICK: f64 = 1.0 / 60.0;

const GROUND: ObstacleId = ObstacleId(0);
const GIANT: ObstacleId = ObstacleId(1);

/// Riders, boulders in the valley, and walls of rock around its middle.
const RIDERS: u64 = 5;
const BOULDERS: usize = 150;
const WALLS: u32 = 5;

/// Seconds between two arrows, two wounds, two noises, and two riders that are lifted onto the giant.
const ARROWS: f64 = 47.0;
const WOUNDS: f64 = 170.0;
const NOISES: f64 = 61.0;
const LIFTS: f64 = 37.0;

/// Of each so many seconds, riders leave the giant alone for so many.
const DAY: f64 = 400.0;
const QUIET: f64 = 160.0;

/// How far from its home the giant is sent when riders have left it, metres.
const SENT: f64 = 80.0;

/// Where riders are lifted to: anywhere, or onto joints whose names begin so.
const LIFTED_TO: [&[&str]; 5] = [
    &[""],
    &[""],
    &["head", "neck"],
    &["upper_arm.L", "forearm.L"],
    &["upper_arm.R", "forearm.R"],
];

/// Damage of a wound.
const DAMAGE: f64 = 0.6;

/// Of each so many ticks, one looks at the feet.
const LOOKS: u64 = 15;

/// A foot has settled after so many ticks.
const SETTLED: u32 = 30;

/// Why a life cannot go on.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LifeError {
    /// The giant's file is missing or broken.
    #[error(transparent)]
    Creature(#[from] CreatureError),
    /// The brain's file cannot be read.
    #[error("cannot read {}: {error}", file.display())]
    Read {
        /// The file.
        file: std::path::PathBuf,
        /// Why not.
        error: std::io::Error,
    },
    /// The brain is not valid.
    #[error("{}: {error}", file.display())]
    Brain {
        /// The file.
        file: std::path::PathBuf,
        /// Why not.
        error: BrainError,
    },
    /// The giant cannot be made or posed.
    #[error(transparent)]
    Colossus(#[from] ColossusError),
    /// A rider cannot be moved.
    #[error(transparent)]
    Climber(#[from] ClimberError),
}

/// A life: giant, riders, and what was seen of them.
pub struct Life {
    kind: Arc<CreatureKind>,
    giant: Creature,
    world: PhysicsWorld,
    riders: Vec<Rider>,
    tally: Tally,
    random: fastrand::Rng,
    seed: u64,
    ticks: u64,
    /// Of each foot, ticks since it came down.
    stands: Vec<u32>,
}

impl Life {
    /// A life before its first tick.
    ///
    /// # Errors
    /// [`LifeError`] if giant or brain cannot be loaded.
    pub fn new(options: &LifeOptions) -> Result<Self, LifeError> {
        let kind = Arc::new(kind(options)?);
        let mut random = fastrand::Rng::with_seed(options.seed);
        let world = arena(&mut random);
        let giant = born(&kind, options.seed)?;
        let mut riders = Vec::new();
        for id in 0..RIDERS {
            let place = somewhere(&mut random);
            riders.push(Rider::new(id, place, options.seed)?);
        }
        Ok(Self {
            tally: Tally::new(kind.brain()),
            stands: vec![0; kind.brain().file().body.legs.len()],
            kind,
            giant,
            world,
            riders,
            random,
            seed: options.seed,
            ticks: 0,
        })
    }

    /// What was seen so far.
    pub fn tally(&self) -> &Tally {
        &self.tally
    }

    /// The brain's name of the current state.
    pub fn state(&self) -> &str {
        self.kind.brain().path(self.giant.state().current())
    }

    /// Lets a tick pass. Returns true if the giant entered another state in it.
    ///
    /// # Errors
    /// [`LifeError`] if giant or riders leave the range of numbers.
    pub fn step(&mut self) -> Result<bool, LifeError> {
        self.ticks += 1;
        self.fate()?;
        let noises = self.noises();
        let poses = BodyPoses::default();
        let terrain = RapierTerrain::of_world(&self.world, &poses);
        let all: [&dyn Obstacle; 1] = [&terrain];
        let people: Vec<Person> = self
            .riders
            .iter()
            .map(|rider| person(&rider.climber, rider.id, GIANT))
            .collect();
        let around = Surroundings {
            terrain: &all,
            creatures: &[],
            people: &people,
            noises: &noises,
        };
        let report = self.giant.step(&around)?.clone();
        let mut changed = false;
        for event in &report.events {
            match event {
                CreatureEvent::Entered { to, .. } => {
                    changed = true;
                    self.tally.enter(*to);
                }
                CreatureEvent::Plant { leg, .. } => self.stands[*leg] = 0,
                _ => {}
            }
        }
        for blow in &report.blows {
            self.tally.blow(blow.state);
            if let Some(rider) = self.riders.iter_mut().find(|rider| rider.id == blow.person) {
                rider.blow = Some(Blow {
                    velocity: blow.velocity,
                    damage: blow.damage.clamp(0.0, 1.0),
                    by: Some(GIANT),
                });
            }
        }
        self.tally.tick(self.giant.state().current());
        look_at_feet(&self.giant, &mut self.stands, &mut self.tally, &all);
        let seconds = self.ticks as f64 * TICK;
        let is_quiet = self.is_quiet();
        let obstacles: [(ObstacleId, &dyn Obstacle); 2] =
            [(GROUND, &terrain), (GIANT, self.giant.surface())];
        let mut lost = Vec::new();
        for (index, rider) in self.riders.iter_mut().enumerate() {
            let input = rider.input(&self.giant, GIANT, seconds, is_quiet);
            let rode = rider.rides(GIANT);
            rider.climber.step(&input, &obstacles, TICK)?;
            self.tally.ride(rode, rider.rides(GIANT));
            if rider.is_lost(&terrain) || rider.climber.state().hit_points <= 0.0 {
                lost.push(index);
            }
        }
        for index in lost {
            self.tally.fallen += 1;
            let place = somewhere(&mut self.random);
            self.riders[index].revive(place)?;
        }
        Ok(changed)
    }

    /// True while riders leave the giant alone.
    fn is_quiet(&self) -> bool {
        Self::is_quiet_at(self.ticks)
    }

    fn is_quiet_at(ticks: u64) -> bool {
        (ticks as f64 * TICK).rem_euclid(DAY) > DAY - QUIET
    }

    /// What happens from outside: arrows and blades, riders that are lifted, errands, and the next giant after a death.
    fn fate(&mut self) -> Result<(), LifeError> {
        let every = |seconds: f64| self.ticks.is_multiple_of((seconds / TICK) as u64);
        let (arrow, wound, lift) = (every(ARROWS), every(WOUNDS), every(LIFTS));
        if arrow {
            let triangle = self.random.u32(..self.kind.mesh().triangles().len() as u32);
            self.strike(TriangleId(triangle), None, 0.0);
        }
        if wound {
            let open = (0..self.kind.weak_points().len()).find(|point| self.giant.is_open(*point));
            if let Some(place) = open.and_then(|point| self.giant.weak_point(point)) {
                let near = self.giant.surface().closest_point(place, 10.0);
                if let Some(triangle) = near.and_then(|near| u32::try_from(near.material.key).ok())
                {
                    self.strike(TriangleId(triangle), Some(place), DAMAGE);
                }
            }
        }
        if lift && !self.is_quiet() {
            let index = self.random.usize(..self.riders.len());
            let joints = LIFTED_TO[self.random.usize(..LIFTED_TO.len())];
            self.riders[index].lift(&self.giant, joints)?;
        }
        if self.is_quiet() && !Self::is_quiet_at(self.ticks - 1) {
            let angle = self.random.f64() * core::f64::consts::TAU;
            let way = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle));
            self.giant.send(Some(way * SENT));
        }
        let is_dead = self.kind.brain().is_final(self.giant.state().current());
        if is_dead && self.giant.state().brain().ticks_in_state(self.kind.brain()) > 600 {
            self.tally.lives += 1;
            self.giant = born(
                &self.kind,
                self.seed.wrapping_add(u64::from(self.tally.lives)),
            )?;
            self.tally.born();
        }
        Ok(())
    }

    fn strike(&mut self, triangle: TriangleId, place: Option<DVec3>, damage: f64) {
        let at = MaterialPoint::on_triangle(triangle, [1.0 / 3.0; 3]);
        let place = place.unwrap_or(self.giant.state().position());
        let done = self.giant.hurt(&Wound { place, at, damage });
        self.tally.damage += done;
    }

    fn noises(&mut self) -> Vec<Noise> {
        if !self.ticks.is_multiple_of((NOISES / TICK) as u64) {
            return Vec::new();
        }
        vec![Noise {
            place: somewhere(&mut self.random),
            loudness: 2.0,
        }]
    }
}

/// Lets the giant live, with a progress bar on standard error. Prints the states that it enters, if the options say so.
///
/// # Errors
/// As [`Life::new`] and [`Life::step`].
pub fn live(options: &LifeOptions) -> Result<Tally, LifeError> {
    let mut life = Life::new(options)?;
    let ticks = (options.minutes * 60.0 / TICK).round() as u64;
    let bar = ProgressBar::new(ticks);
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}  [{eta} left]");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    for tick in 0..ticks {
        if life.step()? && options.story {
            bar.suspend(|| println!("{:8.2} s  {}", tick as f64 * TICK, life.state()));
        }
        if tick.is_multiple_of(64) {
            bar.set_message(life.state().to_owned());
            bar.set_position(tick);
        }
    }
    bar.finish_and_clear();
    Ok(life.tally)
}

/// Looks how the feet that stand do so, now and then.
fn look_at_feet(
    giant: &Creature,
    stands: &mut [u32],
    tally: &mut Tally,
    terrain: &[&dyn Obstacle],
) {
    for (leg, stands) in stands.iter_mut().enumerate() {
        if !giant.state().is_planted(leg) {
            *stands = 0;
            continue;
        }
        *stands = stands.saturating_add(1);
        if *stands > SETTLED
            && giant.state().ticks().is_multiple_of(LOOKS)
            && let Some(clearance) = giant.foot_clearance(leg, terrain)
        {
            tally.foot(clearance / giant.kind().foot_length(leg));
        }
    }
}

fn kind(options: &LifeOptions) -> Result<CreatureKind, LifeError> {
    let file = options.brain.clone().unwrap_or_else(giant::brain_path);
    let text = std::fs::read_to_string(&file).map_err(|error| LifeError::Read {
        file: file.clone(),
        error,
    })?;
    let brain = Brain::from_json(&text, TICK).map_err(|error| LifeError::Brain { file, error })?;
    Ok(giant::giant()?.with_brain(brain)?)
}

fn born(kind: &Arc<CreatureKind>, seed: u64) -> Result<Creature, LifeError> {
    let config = CreatureConfig {
        position: DVec3::Y * valley::height(0.0, 0.0),
        seed,
        arena: 80.0,
        sight: 60.0,
        ..CreatureConfig::default()
    };
    Ok(Creature::new(Arc::clone(kind), config)?)
}

/// The valley with boulders in it and walls of rock.
fn arena(random: &mut fastrand::Rng) -> PhysicsWorld {
    let mut world = valley::world();
    let mut lot = |from: f64, to: f64| from + (to - from) * random.f64();
    for _ in 0..BOULDERS {
        let (x, z, radius) = (lot(-90.0, 90.0), lot(-90.0, 90.0), lot(2.0, 3.0));
        let y = valley::height(x, z) + lot(0.3, 2.0) - radius;
        let place = DVec3::new(x, y, z).as_vec3();
        let ball = ColliderBuilder::ball(radius as Real).position(Pose::from_translation(place));
        world.insert_collider(ball, None);
    }
    for wall in 0..WALLS {
        let angle = core::f64::consts::TAU * f64::from(wall) / f64::from(WALLS);
        let (x, z) = (55.0 * libm::sin(angle), 55.0 * libm::cos(angle));
        let rock = DVec3::new(x, valley::height(x, z) + 12.0, z).as_vec3();
        let turn = Vector::new(0.0, angle as Real, 0.0);
        let wall = ColliderBuilder::cuboid(10.0, 16.0, 3.0).position(Pose::new(rock, turn));
        world.insert_collider(wall, None);
    }
    world.detect_collisions(&(), &());
    world
}

/// A place in the valley, just above the ground.
fn somewhere(random: &mut fastrand::Rng) -> DVec3 {
    let mut lot = || (random.f64() - 0.5) * 180.0;
    let (x, z) = (lot(), lot());
    DVec3::new(x, valley::height(x, z) + 4.0, z)
}

/// True if a state attacks.
fn attacks(brain: &Brain, state: clamber_colossus::brain::StateId) -> bool {
    matches!(brain.act(state), Some(Act::Attack(_)))
}
