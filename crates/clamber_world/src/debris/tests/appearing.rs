//! Rocks around which skin appears: they break off below it, or a creature is placed or spawned where they are.

mod breaking_off;
mod changing;
mod coming;
mod growing;
mod open_skin;
mod restored;

use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::Influence;
use clamber_surface::rig::JointId;
use clamber_surface::surface::SkinnedSurface;
use glam::{DQuat, DVec3, Vec3};
use rapier3d::prelude::*;

use super::scene::{add_rock, bits, slab, step};
use crate::ObstacleId;
use crate::debris::inner_capsule::InnerCapsule;
use crate::debris::{Debris, DebrisConfig, DebrisReport};
use crate::testing::rest;

/// The influence of each vertex of a creature: its one joint.
const BONE: Influence = Influence {
    joint: JointId(0),
    weight: 1.0,
};

/// A box-shaped creature on one joint.
struct Creature {
    id: ObstacleId,
    surface: SkinnedSurface,
    /// Half its size in the world, metres.
    half: DVec3,
}

/// The motion of a creature in a tick, with its place at the end of the tick.
#[derive(Clone, Copy, Debug)]
enum Does {
    Moves(DVec3),
    IsPlaced(DVec3),
    /// The creature is not in the list.
    IsAway,
}

/// Creatures and rocks in a frame that moves evenly. All places are in that frame.
struct Stage {
    creatures: Vec<Creature>,
    world: PhysicsWorld,
    debris: Debris,
    rocks: Vec<RigidBodyHandle>,
    frame: DVec3,
    dt: f64,
    ticks: u32,
}

impl Stage {
    fn new(rate: u32, frame: DVec3) -> Self {
        let dt = 1.0 / f64::from(rate);
        let mut world = PhysicsWorld::default();
        world.integration_parameters.dt = dt as f32;
        Self {
            creatures: Vec::new(),
            world,
            debris: Debris::new(DebrisConfig::default()),
            rocks: Vec::new(),
            frame,
            dt: f64::from(dt as f32),
            ticks: 0,
        }
    }

    /// Lifts rapier's limit of 400 m/s, for large rocks in fast frames.
    fn allow_any_speed(&mut self) {
        let parameters = &mut self.world.integration_parameters;
        parameters.normalized_max_linear_velocity = f32::MAX;
    }

    /// A stage with one creature, around the origin of the frame.
    fn with_creature(rate: u32, frame: DVec3, half: DVec3, scale: f64) -> Self {
        let mut stage = Self::new(rate, frame);
        stage.creature(3, half, scale);
        stage.pose(&[Does::IsPlaced(DVec3::ZERO)]);
        stage
    }

    /// A creature of a size in the world, `scale` times as large there as in its model space.
    fn creature(&mut self, id: u64, half: DVec3, scale: f64) {
        let in_model = (half / scale).as_vec3();
        self.creatures.push(Creature {
            id: ObstacleId(id),
            surface: slab(in_model, in_model.min_element() * 0.5, 1),
            half,
        });
    }

    /// Ground below a height, which moves with the frame.
    fn ground(&mut self, height: f32) {
        let body = RigidBodyBuilder::kinematic_velocity_based().linvel(self.frame.as_vec3());
        let ground = ColliderBuilder::cuboid(900.0, 50.0, 900.0);
        let ground = ground.translation(Vector::new(0.0, height - 50.0, 0.0));
        self.world.insert(body, ground.friction(0.6));
    }

    /// A rock that rests in the frame.
    fn rock(&mut self, shape: &ColliderBuilder, place: DVec3) -> RigidBodyHandle {
        let place = place + self.shift();
        let body = RigidBodyBuilder::dynamic()
            .translation(place.as_vec3())
            .linvel(self.frame.as_vec3());
        let (body, _) = add_rock(&mut self.world, &mut self.debris, body, shape.clone());
        self.rocks.push(body);
        body
    }

    /// How far the frame has come.
    fn shift(&self) -> DVec3 {
        self.frame * (self.dt * f64::from(self.ticks))
    }

    fn pose(&mut self, does: &[Does]) {
        let shift = self.shift();
        for (creature, does) in self.creatures.iter_mut().zip(does) {
            let scale = creature.half.x / f64::from(extent(&creature.surface).x);
            let to = |place: DVec3| Similarity {
                rotation: DQuat::IDENTITY,
                scale,
                translation: place + shift,
            };
            match *does {
                Does::Moves(place) => creature.surface.advance(&rest(), to(place)).unwrap(),
                Does::IsPlaced(place) => creature.surface.teleport(&rest(), to(place)).unwrap(),
                Does::IsAway => {}
            }
        }
    }

    /// A tick, in which every rock that is inside a creature must be on its way out of it.
    fn tick(&mut self, case: &str, does: &[Does]) -> DebrisReport {
        self.start_tick(does);
        self.step(case, does)
    }

    fn start_tick(&mut self, does: &[Does]) {
        self.ticks += 1;
        self.pose(does);
    }

    /// The tick that [`Stage::start_tick`] began.
    fn step(&mut self, case: &str, does: &[Does]) -> DebrisReport {
        let here = self.creatures.iter().zip(does);
        let here = here.filter(|(_, does)| !matches!(does, Does::IsAway));
        let list: Vec<_> = here.map(|(one, _)| (one.id, &one.surface)).collect();
        let report = step(&mut self.world, &mut self.debris, &list, self.dt);
        let mut told = 0;
        for rock in &self.rocks {
            let passes = self.debris.is_let_through(*rock) || self.debris.is_put_out(*rock);
            told += u32::from(passes);
            let is_here = |one: &&Creature| list.iter().any(|(id, _)| *id == one.id);
            for creature in self.creatures.iter().filter(is_here) {
                let off = self.place(*rock) - creature.middle(self.shift());
                let inside = off.abs().cmplt(creature.half * 0.999).all();
                let now = format_args!("{case}, tick {}", self.ticks);
                assert!(!inside || passes, "{now}: stays {off} from the middle");
            }
        }
        let counted = report.caught + report.put_out;
        assert!(told <= counted, "{case}: {told} rocks, {report:?}");
        report
    }

    /// Place of a rock in the frame.
    fn place(&self, rock: RigidBodyHandle) -> DVec3 {
        self.world.bodies[rock].translation().as_dvec3() - self.shift()
    }

    /// Velocity of a rock in the frame.
    fn velocity(&self, rock: RigidBodyHandle) -> DVec3 {
        self.world.bodies[rock].linvel().as_dvec3() - self.frame
    }

    fn bits(&self) -> Vec<u32> {
        bits(self.rocks.iter().map(|rock| &self.world.bodies[*rock]))
    }
}

impl Creature {
    fn middle(&self, shift: DVec3) -> DVec3 {
        self.surface.world_from_model().translation - shift
    }
}

/// A rate, a frame, and the scale of a creature.
type Setting = (u32, DVec3, f64);

/// Rates, frames, and scales of creatures, one after the other.
fn settings() -> impl Iterator<Item = Setting> {
    let frames = [
        DVec3::ZERO,
        DVec3::X * 30.0,
        DVec3::new(-3.0, 30.0, 8.0),
        DVec3::Z * 300.0,
        DVec3::ZERO,
    ];
    let rates = [30, 60, 120, 240].into_iter().cycle();
    let frames = frames.into_iter().cycle();
    let scales = [1.0, 0.1, 10.0, 1.0, 3.0].into_iter().cycle();
    rates.zip(frames).zip(scales).map(|((a, b), c)| (a, b, c))
}

/// Half the size of a creature in its model space.
fn extent(surface: &SkinnedSurface) -> Vec3 {
    let corners = surface.mesh().positions().iter();
    corners.fold(Vec3::ZERO, |most, p| most.max(p.abs()))
}

/// Rocks about as large as a ball of radius `size`, each with the radius of the largest ball inside.
fn shapes(size: f32) -> Vec<(ColliderBuilder, f64)> {
    let corners = [
        [0.9, 0.3, -0.2],
        [-0.8, 0.4, 0.3],
        [0.1, 1.0, 0.1],
        [0.2, -0.9, 0.4],
        [-0.3, -0.2, 1.0],
        [0.4, 0.1, -0.9],
        [-0.5, -0.7, -0.6],
    ];
    let corners = corners.map(Vec3::from_array);
    let low = corners.iter().fold(Vec3::ZERO, |low, p| low.min(*p));
    let high = corners.iter().fold(Vec3::ZERO, |high, p| high.max(*p));
    // The ball inside is about the middle of its box.
    let corners = corners.map(|p| (p - (low + high) * 0.5) * size);
    let all = [
        ColliderBuilder::ball(size),
        ColliderBuilder::cuboid(size, size * 0.8, size * 0.9),
        ColliderBuilder::capsule_z(size * 0.8, size * 0.6),
        ColliderBuilder::convex_hull(&corners).unwrap(),
    ];
    let radius = |shape: &ColliderBuilder| {
        let mut world = PhysicsWorld::default();
        let (body, _) = world.insert(RigidBodyBuilder::dynamic(), shape.clone());
        let core = InnerCapsule::of(&world.bodies[body], &world.colliders);
        core.unwrap().radius
    };
    all.map(|shape| (shape.clone(), radius(&shape))).into()
}
