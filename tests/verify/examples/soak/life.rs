//! The giant's life in fast forward, in a valley with boulders and walls: five riders wander and climb on it, arrows
//! and blades hit it, and the game sends it away when the riders have left it. When it dies, the next giant lives.

#[path = "rider.rs"]
mod rider;

use std::error::Error;
use std::sync::Arc;

use clamber_climber::{ClimberMode, Knockback, StepRules};
use clamber_colossus::brain::StateId;
use clamber_colossus::{
    Brain, Creature, CreatureConfig, CreatureEvent, CreatureKind, Noise, Person, Riding,
    Surroundings,
};
use clamber_scenes::{giant, valley};
use clamber_surface::mesh::TriangleId;
use clamber_world::rapier3d::prelude::*;
use clamber_world::{BodyPoses, MaterialPoint, Obstacle, ObstacleId, RapierTerrain};
use core::f64::consts::TAU;
use fastrand::Rng;
use glam::DVec3;

use rider::Rider;

/// Length of a tick, seconds.
const TICK: f64 = 1.0 / 60.0;

const GROUND: ObstacleId = ObstacleId(0);
const GIANT: ObstacleId = ObstacleId(1);

/// Periods of arrows, wounds, noises, and of riders that are lifted onto the giant, seconds.
const ARROWS: f64 = 47.0;
const WOUNDS: f64 = 170.0;
const NOISES: f64 = 61.0;
const LIFTS: f64 = 37.0;

/// At the end of each day the riders leave the giant alone for the quiet time, seconds.
const DAY: f64 = 400.0;
const QUIET: f64 = 160.0;

/// Distance from its home to which the giant is sent when the riders have left it, metres.
const SENT: f64 = 80.0;

/// Beginnings of the names of the joints onto which a rider is lifted; one list is chosen at random.
const LIFTED_TO: [&[&str]; 5] = [
    &[""],
    &[""],
    &["head", "neck"],
    &["upper_arm.L", "forearm.L"],
    &["upper_arm.R", "forearm.R"],
];

/// The largest gap under a settled foot and its largest depth in the ground, as shares of its length.
const MOST_GAP: f64 = 0.01;

/// A state that is not final must end after this time, seconds.
const FOR_EVER: f64 = 180.0;

/// A life of this length must have seen every state, seconds.
const LONG: f64 = 1_800.0;

type Fallible<T> = Result<T, Box<dyn Error>>;

/// Lets a giant live, and prints the time that it spent in each state; returns the number of checks.
///
/// Panics if a state never ends, if a foot stands off the ground or in it, or if a life of half an hour or more misses
/// a state.
pub(crate) fn life(giant: &clamber_scenes::Creature, seed: u64, minutes: f64) -> usize {
    let lived = || -> Fallible<Life> {
        let mut life = Life::new(giant, seed)?;
        for _ in 0..(minutes * 60.0 / TICK).round() as u64 {
            life.step()?;
        }
        Ok(life)
    };
    match lived() {
        Ok(life) => {
            let faults = life.faults();
            assert!(faults.is_empty(), "{}", faults.join("\n"));
            life.states.len() + life.looks
        }
        Err(error) => panic!("{error}"),
    }
}

/// A state that has no states inside it.
struct State {
    id: StateId,
    /// How often it was entered.
    entered: u32,
    /// Time spent in it, and the longest stay, seconds.
    seconds: [f64; 2],
}

struct Life {
    kind: Arc<CreatureKind>,
    giant: Creature,
    world: PhysicsWorld,
    riders: Vec<Rider>,
    random: Rng,
    seed: u64,
    ticks: u64,
    /// Ticks since each foot came down.
    stands: Vec<u32>,
    /// Seconds since the current state was entered.
    since: f64,
    states: Vec<State>,
    /// Number of giants that died.
    deaths: u64,
    /// The largest gap under a settled foot, and its largest depth in the ground, as shares of its length.
    clearance: [f64; 2],
    /// Number of measured feet.
    looks: usize,
}

impl Life {
    fn new(giant: &clamber_scenes::Creature, seed: u64) -> Fallible<Self> {
        let brain = Brain::from_json(&std::fs::read_to_string(giant::brain_path())?, TICK)?;
        let kind = Arc::new(CreatureKind::new(&giant.rig, brain)?);
        let brain = kind.brain();
        let is_leaf = |state: &StateId| {
            let mut others = brain.states().filter(|other| other != state);
            !others.any(|other| brain.is_within(other, *state))
        };
        let state = |id| State {
            id,
            entered: 0,
            seconds: [0.0; 2],
        };
        let states = brain.states().filter(is_leaf).map(state).collect();
        let mut random = Rng::with_seed(seed);
        let world = arena(&mut random);
        let riders = (0..5).map(|id| Rider::new(id, somewhere(&mut random), seed));
        Ok(Self {
            riders: riders.collect::<Fallible<_>>()?,
            giant: born(&kind, seed)?,
            stands: vec![0; brain.file().body.legs.len()],
            kind,
            world,
            random,
            seed,
            ticks: 0,
            since: 0.0,
            states,
            deaths: 0,
            clearance: [0.0; 2],
            looks: 0,
        })
    }

    fn state(&mut self, id: StateId) -> Option<&mut State> {
        self.states.iter_mut().find(|state| state.id == id)
    }

    fn step(&mut self) -> Fallible<()> {
        self.ticks += 1;
        self.fate()?;
        let noises = self.noises();
        let poses = BodyPoses::default();
        let terrain = RapierTerrain::of_world(&self.world, &poses);
        let riders = self.riders.iter();
        let people: Vec<Person> = riders.map(person).collect();
        let report = self.giant.step(&Surroundings {
            terrain: &[&terrain],
            creatures: &[],
            people: &people,
            noises: &noises,
        });
        let report = report?.clone();
        let (seconds, is_quiet) = (self.ticks as f64 * TICK, is_quiet(self.ticks));
        let obstacles: [(ObstacleId, &dyn Obstacle); 2] =
            [(GROUND, &terrain), (GIANT, self.giant.surface())];
        let mut lost = Vec::new();
        for (index, rider) in self.riders.iter_mut().enumerate() {
            let struck = report.blows.iter().rfind(|blow| blow.person == rider.id);
            let knockback = struck.map(|blow| Knockback {
                velocity: blow.velocity,
                damage: blow.damage.clamp(0.0, 1.0),
                by: Some(GIANT),
            });
            let rules = StepRules {
                knockback,
                ..StepRules::default()
            };
            let input = rider.input(&self.giant, seconds, is_quiet);
            rider.climber.step_with(&input, &obstacles, &rules, TICK)?;
            let state = rider.climber.state();
            let above = state.position + DVec3::Y * 5.0;
            let is_lost = terrain.cast_ray(above, -DVec3::Y, 200.0).is_none();
            if is_lost || state.hit_points <= 0.0 {
                lost.push(index);
            }
        }
        for event in &report.events {
            match event {
                CreatureEvent::Entered { to, .. } => {
                    self.since = 0.0;
                    self.state(*to).into_iter().for_each(|to| to.entered += 1);
                }
                CreatureEvent::Plant { leg, .. } => self.stands[*leg] = 0,
                _ => {}
            }
        }
        self.since += TICK;
        let since = self.since;
        if let Some(state) = self.state(self.giant.state().current()) {
            state.seconds[0] += TICK;
            state.seconds[1] = state.seconds[1].max(since);
        }
        self.look_at_feet();
        for index in lost {
            let place = somewhere(&mut self.random);
            self.riders[index].revive(place)?;
        }
        Ok(())
    }

    /// Arrows, wounds, lifted riders, errands, and the next giant ten seconds after a death.
    fn fate(&mut self) -> Fallible<()> {
        let every = |seconds: f64| self.ticks.is_multiple_of((seconds / TICK) as u64);
        let (arrow, wound, lift) = (every(ARROWS), every(WOUNDS), every(LIFTS));
        if arrow {
            let triangle = self.random.u32(..self.kind.mesh().triangles().len() as u32);
            let place = self.giant.state().position();
            self.strike(TriangleId(triangle), place, 0.0);
        }
        if wound {
            let open = (0..self.kind.weak_points().len()).find(|point| self.giant.is_open(*point));
            if let Some(place) = open.and_then(|point| self.giant.weak_point(point)) {
                let near = self.giant.surface().closest_point(place, 10.0);
                if let Some(triangle) = near.and_then(|near| u32::try_from(near.material.key).ok())
                {
                    self.strike(TriangleId(triangle), place, 0.6);
                }
            }
        }
        if lift && !is_quiet(self.ticks) {
            let index = self.random.usize(..self.riders.len());
            let joints = LIFTED_TO[self.random.usize(..LIFTED_TO.len())];
            self.riders[index].lift(&self.giant, joints)?;
        }
        if is_quiet(self.ticks) && !is_quiet(self.ticks - 1) {
            let angle = self.random.f64() * TAU;
            self.giant.send(Some(level(angle) * SENT));
        }
        let (state, brain) = (self.giant.state(), self.kind.brain());
        if brain.is_final(state.current()) && state.brain().ticks_in_state(brain) > 600 {
            self.deaths += 1;
            self.giant = born(&self.kind, self.seed.wrapping_add(self.deaths))?;
            self.since = 0.0;
        }
        Ok(())
    }

    fn strike(&mut self, triangle: TriangleId, place: DVec3, damage: f64) {
        let at = MaterialPoint::on_triangle(triangle, [1.0 / 3.0; 3]);
        self.giant.hurt(&at, place, damage);
    }

    fn noises(&mut self) -> Vec<Noise> {
        let is_due = self.ticks.is_multiple_of((NOISES / TICK) as u64);
        let noise = is_due.then(|| Noise {
            place: somewhere(&mut self.random),
            loudness: 2.0,
        });
        noise.into_iter().collect()
    }

    /// Measures the feet that have stood for half a second, four times a second.
    fn look_at_feet(&mut self) {
        let poses = BodyPoses::default();
        let terrain = RapierTerrain::of_world(&self.world, &poses);
        for (leg, stands) in self.stands.iter_mut().enumerate() {
            if !self.giant.state().is_planted(leg) {
                *stands = 0;
                continue;
            }
            *stands = stands.saturating_add(1);
            if *stands > 30
                && self.giant.state().ticks().is_multiple_of(15)
                && let Some(clearance) = self.giant.foot_clearance(leg, &[&terrain])
            {
                let share = clearance / self.kind.foot_length(leg);
                self.looks += 1;
                self.clearance[0] = self.clearance[0].max(share);
                self.clearance[1] = self.clearance[1].max(-share);
            }
        }
    }

    /// Prints what was seen, and lists the faults.
    fn faults(&self) -> Vec<String> {
        let brain = self.kind.brain();
        let is_long = self.ticks as f64 * TICK >= LONG;
        let mut faults = Vec::new();
        for state in &self.states {
            let (name, [seconds, longest]) = (brain.path(state.id), state.seconds);
            println!("{name:<28} entered {:>5}  {seconds:>8.1} s", state.entered);
            if is_long && state.entered == 0 && seconds == 0.0 {
                faults.push(format!("`{name}` was never entered"));
            }
            if longest > FOR_EVER && !brain.is_final(state.id) {
                faults.push(format!("`{name}` lasted for {longest:.0} s"));
            }
        }
        for (what, share) in ["above", "in"].iter().zip(self.clearance) {
            let depth = format!("{:.3} % of its length {what} the ground", 100.0 * share);
            println!("a settled foot is at most {depth}");
            if share > MOST_GAP {
                faults.push(format!("a foot stood {depth}"));
            }
        }
        if self.looks == 0 {
            faults.push("no foot was measured".into());
        }
        faults
    }
}

/// A rider as the giant senses it.
fn person(rider: &Rider) -> Person {
    let (climber, state) = (&rider.climber, rider.climber.state());
    let support = state.support.filter(|on| on.attachment.obstacle == GIANT);
    Person {
        id: rider.id,
        body: climber.body(),
        riding: support.map(|support| Riding {
            at: support.attachment.material,
            hangs: state.mode == ClimberMode::Hanging,
        }),
    }
}

/// True at the ticks in which riders leave the giant alone.
fn is_quiet(ticks: u64) -> bool {
    (ticks as f64 * TICK).rem_euclid(DAY) > DAY - QUIET
}

fn level(angle: f64) -> DVec3 {
    DVec3::new(libm::sin(angle), 0.0, libm::cos(angle))
}

fn born(kind: &Arc<CreatureKind>, seed: u64) -> Fallible<Creature> {
    let config = CreatureConfig {
        position: DVec3::Y * valley::height(0.0, 0.0),
        seed,
        arena: 80.0,
        sight: 60.0,
        ..CreatureConfig::default()
    };
    Ok(Creature::new(Arc::clone(kind), config)?)
}

/// The valley with 150 boulders in it, and five walls of rock around its middle.
fn arena(random: &mut Rng) -> PhysicsWorld {
    let mut world = valley::world();
    let mut lot = |from: f64, to: f64| from + (to - from) * random.f64();
    for _ in 0..150 {
        let (x, z, radius) = (lot(-90.0, 90.0), lot(-90.0, 90.0), lot(2.0, 3.0));
        let y = valley::height(x, z) + lot(0.3, 2.0) - radius;
        let ball = ColliderBuilder::ball(radius as Real);
        world.insert_collider(ball.translation(DVec3::new(x, y, z).as_vec3()), None);
    }
    for wall in 0..5u32 {
        let angle = TAU * f64::from(wall) / 5.0;
        let at = level(angle) * 55.0;
        let rock = at.with_y(valley::height(at.x, at.z) + 12.0).as_vec3();
        let turn = Vector::new(0.0, angle as Real, 0.0);
        let wall = ColliderBuilder::cuboid(10.0, 16.0, 3.0).position(Pose::new(rock, turn));
        world.insert_collider(wall, None);
    }
    world.detect_collisions(&(), &());
    world
}

/// A place in the valley, just above the ground.
fn somewhere(random: &mut Rng) -> DVec3 {
    let mut lot = || (random.f64() - 0.5) * 180.0;
    let (x, z) = (lot(), lot());
    DVec3::new(x, valley::height(x, z) + 4.0, z)
}
