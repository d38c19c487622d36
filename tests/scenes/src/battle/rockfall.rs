//! Rocks that fall on the creature. Rocks that come to lie in the valley are dropped again.

use std::time::Instant;

use clamber_surface::Fingerprint;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::DebrisReport;
use clamber_world::rapier3d::prelude::*;
use glam::{DVec3, Vec3};

use super::{CREATURE, SceneError, TICK};
use crate::rocks::FallingRocks;
use crate::{solid_angle, valley};

/// Height of a creature for which rocks have a scale of 1, metres. Smaller creatures get smaller rocks.
const HEIGHT: f64 = 40.0;

/// Smallest scale of rocks: rapier's own lengths, such as its prediction distance of 2 cm, are not scaled.
const SMALLEST: f64 = 0.1;

/// Every so many ticks one of the rocks that lie in the valley is dropped again.
const AGAIN: u64 = 60;

/// Ticks between two checks of whether a rock is inside the creature. A check goes over all triangles.
const LOOK_EVERY: u64 = 30;

/// A rock lies in the valley if its centre is less than this above the ground, metres at a scale of 1.
const LIES: f64 = 4.0;

/// Corners and triangles of a mesh.
pub type Triangles = (Vec<Vec3>, Vec<[u32; 3]>);

/// The rocks of a battle, and counts of what happened to them.
#[derive(Clone, Debug)]
pub struct Rockfall {
    rocks: FallingRocks,
    scale: f64,
    rng: fastrand::Rng,
    /// Index of the next rock to check for lying in the valley.
    next: usize,
    /// How often a rock was dropped, the first drop of each included.
    pub drops: u32,
    /// What the skin did to them in the last tick.
    pub report: DebrisReport,
    /// How often a rock was knocked out of the valley, where there is no ground.
    pub left: u32,
    /// Rocks that were found inside the creature without being caught, as under a foot, or below the ground, in the
    /// last tick: index, place and kind of the fault.
    pub faults: Vec<(usize, DVec3, &'static str)>,
}

impl Rockfall {
    /// `count` rocks above a place, for a creature `height` metres tall.
    pub(super) fn new(
        world: &mut PhysicsWorld,
        count: usize,
        seed: u64,
        above: DVec3,
        height: f64,
    ) -> Result<Self, SceneError> {
        let scale = (height / HEIGHT).clamp(SMALLEST, 1.0);
        let rocks = FallingRocks::new(world, count, seed, above, scale)?;
        Ok(Self {
            scale,
            rng: fastrand::Rng::with_seed(seed),
            next: 0,
            drops: rocks.bodies.len() as u32,
            report: DebrisReport::default(),
            left: 0,
            faults: Vec::new(),
            rocks,
        })
    }

    /// Steps the world with its rocks. Drops lost rocks again from about `above`, and once a second a rock that lies in
    /// the valley. Returns the time that rocks and physics took, microseconds.
    pub(super) fn step(
        &mut self,
        surface: &SkinnedSurface,
        tick: u64,
        world: &mut PhysicsWorld,
        above: DVec3,
    ) -> Result<f64, SceneError> {
        let start = Instant::now();
        self.report = self.rocks.step((CREATURE, surface), world, TICK)?;
        let time = start.elapsed().as_secs_f64() * 1e6;
        self.faults.clear();
        if tick.is_multiple_of(LOOK_EVERY) {
            self.look_inside(surface, world);
        }
        self.bring_back(world, above);
        if tick.is_multiple_of(AGAIN) {
            self.drop_again(world, above);
        }
        Ok(time)
    }

    fn look_inside(&mut self, surface: &SkinnedSurface, world: &PhysicsWorld) {
        let mut positions = Vec::new();
        surface.skin_all(&mut positions);
        for (index, rock) in self.rocks.bodies.iter().enumerate() {
            let place = world.bodies[*rock].translation().as_dvec3();
            let in_model = surface.world_from_model().inverse_transform_point(place);
            let inside = solid_angle::is_inside_skin(&positions, surface, in_model);
            if inside && !self.rocks.debris.is_let_through(*rock) {
                self.faults.push((index, place, "inside"));
            }
        }
    }

    /// Drops rocks again that no ground will stop: those out of the valley, which have a count of their own, and those
    /// under its ground, which are a fault.
    fn bring_back(&mut self, world: &mut PhysicsWorld, above: DVec3) {
        for index in 0..self.bodies().len() {
            let body = &mut world.bodies[self.bodies()[index]];
            let place = body.translation().as_dvec3();
            if !valley::contains(place.x, place.z) {
                self.left += 1;
            } else if place.y < valley::height(place.x, place.z) {
                self.faults.push((index, place, "below the ground"));
            } else {
                continue;
            }
            // A rock that was knocked away spins; a lying rock does not.
            body.set_angvel(Vector::ZERO, true);
            self.let_fall(index, world, above);
        }
    }

    /// Drops the next rock that lies in the valley again.
    fn drop_again(&mut self, world: &mut PhysicsWorld, above: DVec3) {
        for _ in 0..self.bodies().len() {
            let index = self.next;
            self.next = (self.next + 1) % self.bodies().len();
            let place = world.bodies[self.bodies()[index]].translation().as_dvec3();
            if place.y - valley::height(place.x, place.z) < LIES * self.scale {
                self.let_fall(index, world, above);
                return;
            }
        }
    }

    /// Drops a rock from near `above`, without linear velocity.
    fn let_fall(&mut self, index: usize, world: &mut PhysicsWorld, above: DVec3) {
        let aside = DVec3::new(self.rng.f64() - 0.5, 0.0, self.rng.f64() - 0.5);
        let place = above + aside * (6.0 * self.scale);
        let body = &mut world.bodies[self.bodies()[index]];
        body.set_translation(place.as_vec3(), true);
        body.set_linvel(Vector::ZERO, true);
        self.drops += 1;
    }

    /// Handles of the rocks' bodies in the physics world.
    pub fn bodies(&self) -> &[RigidBodyHandle] {
        &self.rocks.bodies
    }

    /// The meshes of the rocks' colliders, each with its rock's body.
    pub fn meshes(&self, world: &PhysicsWorld) -> Vec<(RigidBodyHandle, Triangles)> {
        let mut meshes = Vec::new();
        for rock in self.bodies() {
            for collider in world.bodies[*rock].colliders() {
                let mesh = match world.colliders[*collider].shape().as_typed_shape() {
                    TypedShape::Ball(ball) => ball.to_trimesh(24, 16),
                    TypedShape::Cuboid(cuboid) => cuboid.to_trimesh(),
                    TypedShape::Capsule(capsule) => capsule.to_trimesh(24, 12),
                    _ => continue,
                };
                meshes.push((*rock, mesh));
            }
        }
        meshes
    }

    /// A 64-bit hash of the rocks' positions and rotations.
    pub(super) fn fingerprint(&self, bodies: &RigidBodySet) -> u64 {
        let numbers = self.bodies().iter().flat_map(|rock| {
            let body = &bodies[*rock];
            let (place, turn) = (body.translation().to_array(), body.rotation().to_array());
            place.into_iter().chain(turn)
        });
        let mut hash = Fingerprint::default();
        numbers.for_each(|x| hash.floats(&[x]));
        hash.value()
    }
}
