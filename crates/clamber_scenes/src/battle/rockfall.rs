//! Rocks that fall on the creature, and fall again once they lie in the valley.

use std::time::Instant;

use clamber_surface::surface::SkinnedSurface;
use clamber_world::rapier3d::prelude::*;
use clamber_world::{Debris, DebrisConfig};
use glam::DVec3;

use super::scene::CREATURE;
use super::{BattleError, TICK};
use crate::rocks::scatter;
use crate::{solid_angle, valley};

/// Height of the creature that rocks have their own size for, metres; for others they are scaled.
const HEIGHT: f64 = 40.0;

/// Smallest scale of rocks: rapier's own lengths, such as the 2 cm over which it predicts, are not scaled.
const SMALLEST: f64 = 0.1;

/// Ticks after which one of the rocks that lie in the valley falls again.
const AGAIN: u64 = 60;

/// Ticks between two looks at whether a rock is inside the creature, which go over all triangles.
const LOOK_EVERY: u64 = 30;

/// A rock this near to the ground, in its own largest radius, lies in the valley.
const LIES: f64 = 4.0;

/// The rocks of a battle, and what became of them.
#[derive(Clone, Debug)]
pub struct Rockfall {
    debris: Debris,
    rocks: Vec<RigidBodyHandle>,
    scale: f64,
    rng: fastrand::Rng,
    /// The next rock to be looked at for whether it lies.
    next: usize,
    report: RockfallReport,
    times: Vec<f64>,
}

/// What became of the rocks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RockfallReport {
    /// How often any was let fall.
    pub drops: u32,
    /// Rocks at the skin, over all ticks.
    pub near: u64,
    /// Rocks put back in front of the skin, over all ticks.
    pub put_back: u32,
    /// Rocks caught between skin, over all ticks.
    pub caught: u32,
    /// How often one was seen under the ground, or inside the creature other than under its feet.
    pub fell_through: u32,
}

impl Rockfall {
    /// So many rocks over a place, for a creature of a height.
    pub(super) fn new(
        world: &mut PhysicsWorld,
        count: usize,
        seed: u64,
        above: DVec3,
        height: f64,
    ) -> Result<Self, BattleError> {
        let scale = (height / HEIGHT).clamp(SMALLEST, 1.0);
        let rocks = scatter(world, count, seed, above, scale);
        let mut debris = Debris::new(DebrisConfig::default());
        for rock in &rocks {
            debris.add(*rock, &mut world.bodies, &world.colliders)?;
        }
        Ok(Self {
            debris,
            scale,
            rng: fastrand::Rng::with_seed(seed),
            next: 0,
            report: RockfallReport {
                drops: rocks.len() as u32,
                ..RockfallReport::default()
            },
            rocks,
            times: Vec::new(),
        })
    }

    /// Steps the world with its rocks. Now and then one falls again, from `above`.
    pub(super) fn step(
        &mut self,
        surface: &SkinnedSurface,
        world: &mut PhysicsWorld,
        above: DVec3,
        tick: u64,
    ) -> Result<(), BattleError> {
        let start = Instant::now();
        let surfaces = [(CREATURE, surface)];
        let (bodies, colliders) = (&mut world.bodies, &mut world.colliders);
        self.debris
            .before_step(&surfaces, bodies, colliders, TICK)?;
        world.step_with_events(&self.debris, &());
        let (broad_phase, narrow_phase) = (&world.broad_phase, &world.narrow_phase);
        let bodies = &mut world.bodies;
        let report = self.debris.after_step(
            &surfaces,
            bodies,
            &world.colliders,
            broad_phase,
            narrow_phase,
            TICK,
        )?;
        self.times.push(start.elapsed().as_secs_f64() * 1e6);
        self.report.near += u64::from(report.near);
        self.report.put_back += report.put_back;
        self.report.caught += report.caught;
        if tick.is_multiple_of(LOOK_EVERY) {
            self.look(surface, world);
        }
        if tick.is_multiple_of(AGAIN) {
            self.drop_again(world, above);
        }
        Ok(())
    }

    fn look(&mut self, surface: &SkinnedSurface, world: &PhysicsWorld) {
        let mut positions = Vec::new();
        surface.skin_all(&mut positions);
        for rock in &self.rocks {
            let place = world.bodies[*rock].translation().as_dvec3();
            let through = self.debris.is_let_through(*rock);
            let in_model = surface.world_from_model().inverse_transform_point(place);
            let inside = solid_angle::is_inside(&positions, surface.mesh(), in_model);
            let under = place.y < valley::height(place.x, place.z);
            self.report.fell_through += u32::from(inside && !through || under);
        }
    }

    /// The next of those that lie in the valley.
    fn drop_again(&mut self, world: &mut PhysicsWorld, above: DVec3) {
        for _ in 0..self.rocks.len() {
            let rock = self.rocks[self.next];
            self.next = (self.next + 1) % self.rocks.len();
            let body = &mut world.bodies[rock];
            let place = body.translation().as_dvec3();
            if place.y - valley::height(place.x, place.z) < LIES * self.scale {
                let aside = DVec3::new(self.rng.f64() - 0.5, 0.0, self.rng.f64() - 0.5);
                let place = above + aside * (6.0 * self.scale);
                body.set_translation(place.as_vec3(), true);
                body.set_linvel(Vector::ZERO, true);
                self.report.drops += 1;
                return;
            }
        }
    }

    /// The rocks, in the world's own handles.
    pub fn bodies(&self) -> &[RigidBodyHandle] {
        &self.rocks
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.rocks.len()
    }

    /// True without rocks.
    pub fn is_empty(&self) -> bool {
        self.rocks.is_empty()
    }

    /// What became of them so far.
    pub fn report(&self) -> &RockfallReport {
        &self.report
    }

    /// What each tick of theirs cost, physics included, microseconds.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// A number over every bit of where they are.
    pub(super) fn fingerprint(&self, bodies: &RigidBodySet) -> u64 {
        let numbers = self.rocks.iter().flat_map(|rock| {
            let body = &bodies[*rock];
            let (place, turn) = (body.translation().to_array(), body.rotation().to_array());
            place.into_iter().chain(turn)
        });
        numbers.fold(0, |hash: u64, x| {
            (hash.rotate_left(5) ^ u64::from(x.to_bits())).wrapping_mul(0x9e37_79b9_7f4a_7c15)
        })
    }
}
