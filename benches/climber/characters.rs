//! rapier's character controllers on meshes that never move, one for each climber of the crowd.

use std::error::Error;
use std::time::Instant;

use clamber::prelude::*;
use clamber::world::rapier3d::control::{CharacterLength, KinematicCharacterController};
use clamber::world::rapier3d::math::{Pose3, Vector};
use clamber::world::rapier3d::parry::query::DefaultQueryDispatcher;
use clamber::world::rapier3d::parry::shape::Ball;
use clamber::world::rapier3d::pipeline::{QueryFilter, QueryPipeline};
use clamber::world::rapier3d::prelude::{ColliderBuilder, PhysicsWorld};
use clamber_scenes::climbs::RATE;
use rayon::prelude::*;

/// Length of a tick, seconds.
const DT: f64 = 1.0 / RATE;

/// A rapier mesh of a surface's current skin, in world space.
pub(crate) fn still_mesh(surface: &SkinnedSurface) -> Result<ColliderBuilder, Box<dyn Error>> {
    let mut positions = Vec::new();
    surface.skin_all(&mut positions);
    let place = surface.world_from_model();
    let points = positions.iter();
    let points = points.map(|p| place.transform_point_f32(*p).as_vec3());
    let triangles = surface.mesh().triangles().iter();
    let triangles = triangles.map(|corners| corners.map(|v| v.0));
    Ok(ColliderBuilder::trimesh(
        points.collect(),
        triangles.collect(),
    )?)
}

/// A ball of the climber's radius that rapier's controller moves.
pub(crate) struct Character {
    controller: KinematicCharacterController,
    shape: Ball,
    pub(crate) pose: Pose3,
    pub(crate) is_grounded: bool,
    /// The position to which the character is put back.
    seat: Vector,
    /// Horizontal walking velocity, metres a second.
    walk: Vector,
}

impl Character {
    pub(crate) fn new(seat: Vector, walk: Vector) -> Self {
        Self {
            controller: KinematicCharacterController {
                offset: CharacterLength::Absolute(0.01),
                ..KinematicCharacterController::default()
            },
            shape: Ball::new(0.4),
            pose: Pose3::from_translation(seat),
            is_grounded: false,
            seat,
            walk,
        }
    }

    /// Runs a tick: the character walks, and falls by the distance that gravity adds in one tick.
    pub(crate) fn step(&mut self, queries: &QueryPipeline<'_>) {
        let way = self.walk * DT as f32 - Vector::Y * (9.81 * DT * DT) as f32;
        let (shape, pose) = (&self.shape, &self.pose);
        let moved = self
            .controller
            .move_shape(DT as f32, queries, shape, pose, way, |_| {});
        self.pose.translation += moved.translation;
        self.is_grounded = moved.grounded;
    }

    /// Puts the character back on its seat if it is farther than `away` metres from it.
    fn sit(&mut self, away: f64) {
        if f64::from((self.pose.translation - self.seat).length()) > away {
            self.pose.translation = self.seat;
        }
    }
}

/// rapier's query pipeline over all colliders.
pub(crate) fn queries(world: &PhysicsWorld) -> QueryPipeline<'_> {
    world.broad_phase.as_query_pipeline(
        &DefaultQueryDispatcher,
        &world.bodies,
        &world.colliders,
        QueryFilter::default(),
    )
}

/// Many characters in a static world.
pub(crate) struct Characters {
    world: PhysicsWorld,
    all: Vec<Character>,
    /// Distance from its seat at which a character is put back, metres.
    away: f64,
    /// The largest number of characters that a thread takes at a time.
    grain: usize,
    grounded: usize,
}

impl Characters {
    pub(crate) fn new(
        (world, all): (PhysicsWorld, Vec<Character>),
        (away, grain): (f64, usize),
    ) -> Self {
        Self {
            world,
            all,
            away,
            grain,
            grounded: 0,
        }
    }

    /// Runs a tick of all characters; returns the seconds.
    pub(crate) fn step(&mut self, threads: &rayon::ThreadPool) -> f64 {
        for character in &mut self.all {
            character.sit(self.away);
        }
        let start = Instant::now();
        let (world, all) = (&self.world, &mut self.all);
        threads.install(|| {
            let all = all.par_iter_mut().with_max_len(self.grain);
            all.for_each_init(|| queries(world), |queries, one| one.step(queries));
        });
        start.elapsed().as_secs_f64()
    }

    /// Counts the characters that are grounded after this tick.
    pub(crate) fn count(&mut self) {
        self.grounded += self.all.iter().filter(|one| one.is_grounded).count();
    }

    /// Number of grounded characters, summed over all counted ticks.
    pub(crate) fn grounded(&self) -> usize {
        self.grounded
    }
}
