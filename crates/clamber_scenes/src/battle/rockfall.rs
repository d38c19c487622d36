//! Rocks that fall on the creature, and fall again once they lie in the valley.

use std::time::Instant;

use clamber_world::rapier3d::prelude::*;
use clamber_world::{Debris, DebrisConfig};
use glam::DVec3;

use super::checks::ROCKS_INSIDE;
use super::faults::{Faults, Moment};
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
    /// Rocks batted out of the valley, where there is no ground to lie on.
    pub left: u32,
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
        moment: &Moment<'_>,
        world: &mut PhysicsWorld,
        above: DVec3,
        faults: &mut Faults,
    ) -> Result<(), BattleError> {
        let (surface, tick) = (moment.surface, moment.tick);
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
            self.look_inside(moment, world, faults);
        }
        self.bring_back(moment, world, above, faults);
        if tick.is_multiple_of(AGAIN) {
            self.drop_again(world, above);
        }
        Ok(())
    }

    fn look_inside(&mut self, moment: &Moment<'_>, world: &PhysicsWorld, faults: &mut Faults) {
        let surface = moment.surface;
        let mut positions = Vec::new();
        surface.skin_all(&mut positions);
        for (index, rock) in self.rocks.iter().enumerate() {
            let place = world.bodies[*rock].translation().as_dvec3();
            let in_model = surface.world_from_model().inverse_transform_point(place);
            let inside = solid_angle::is_inside(&positions, surface.mesh(), in_model);
            if inside && !self.debris.is_let_through(*rock) {
                self.report.fell_through += 1;
                faults.note(ROCKS_INSIDE, || {
                    moment.describe(&format!("rock {index} inside"), place)
                });
            }
        }
    }

    /// Rocks that no ground will stop fall again from above: those batted out of the valley, which are counted by
    /// themselves, and those under its ground, which should not be there.
    fn bring_back(
        &mut self,
        moment: &Moment<'_>,
        world: &mut PhysicsWorld,
        above: DVec3,
        faults: &mut Faults,
    ) {
        for index in 0..self.rocks.len() {
            let body = &mut world.bodies[self.rocks[index]];
            let place = body.translation().as_dvec3();
            if !valley::contains(place.x, place.z) {
                self.report.left += 1;
            } else if place.y < valley::height(place.x, place.z) {
                self.report.fell_through += 1;
                faults.note(ROCKS_INSIDE, || {
                    moment.describe(&format!("rock {index} below the ground"), place)
                });
            } else {
                continue;
            }
            // A rock that was batted away spins; one that lies does not.
            body.set_angvel(Vector::ZERO, true);
            self.let_fall(index, world, above);
        }
    }

    /// The next of those that lie in the valley.
    fn drop_again(&mut self, world: &mut PhysicsWorld, above: DVec3) {
        for _ in 0..self.rocks.len() {
            let index = self.next;
            self.next = (self.next + 1) % self.rocks.len();
            let place = world.bodies[self.rocks[index]].translation().as_dvec3();
            if place.y - valley::height(place.x, place.z) < LIES * self.scale {
                self.let_fall(index, world, above);
                return;
            }
        }
    }

    /// Lets a rock fall from rest, from somewhere about `above`.
    fn let_fall(&mut self, index: usize, world: &mut PhysicsWorld, above: DVec3) {
        let aside = DVec3::new(self.rng.f64() - 0.5, 0.0, self.rng.f64() - 0.5);
        let place = above + aside * (6.0 * self.scale);
        let body = &mut world.bodies[self.rocks[index]];
        body.set_translation(place.as_vec3(), true);
        body.set_linvel(Vector::ZERO, true);
        self.report.drops += 1;
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
