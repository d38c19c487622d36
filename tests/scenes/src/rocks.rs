//! Rocks that fall on a creature.

use clamber_surface::surface::SkinnedSurface;
use clamber_world::rapier3d::prelude::*;
use clamber_world::{Debris, DebrisConfig, DebrisError, DebrisReport, ObstacleId};
use glam::DVec3;

/// Rocks, stones and logs in a physics world, which a creature's skin stops.
#[derive(Clone, Debug)]
pub struct FallingRocks {
    /// What brings the skin near them into the world.
    pub debris: Debris,
    /// Their bodies.
    pub bodies: Vec<RigidBodyHandle>,
}

impl FallingRocks {
    /// Adds `count` rocks, stones and logs to a physics world, in layers from `above` upwards; every sixth is a
    /// log. At a scale of 1 a rock's size is 25 to 70 cm: the radius of a ball, or the largest half extent of a
    /// box. A log has half of its size as radius, and twice its size as half length without the round ends.
    pub fn new(
        world: &mut PhysicsWorld,
        count: usize,
        seed: u64,
        above: DVec3,
        scale: f64,
    ) -> Result<Self, DebrisError> {
        let mut rng = fastrand::Rng::with_seed(seed);
        let scale = scale as f32;
        let mut between = |low: f32, high: f32| (low + (high - low) * rng.f32()) * scale;
        let mut bodies = Vec::with_capacity(count);
        for index in 0..count {
            let size = between(0.25, 0.7);
            let shape = match index % 6 {
                0 => ColliderBuilder::capsule_x(size * 2.0, size * 0.5),
                1 | 3 => ColliderBuilder::cuboid(size, size * 0.7, size * 0.8),
                _ => ColliderBuilder::ball(size),
            };
            // In layers, so that no rock begins inside another.
            let (layer, row, column) = (index / 25, (index % 25) / 5, index % 5);
            let aside = Vector::new(
                (row as f32 - 2.0) * 2.6 * scale + between(-0.3, 0.3),
                layer as f32 * 3.0 * scale,
                (column as f32 - 2.0) * 2.6 * scale + between(-0.3, 0.3),
            );
            let place = (above + aside.as_dvec3()).as_vec3();
            let body = RigidBodyBuilder::dynamic().translation(place);
            let collider = shape.density(2500.0).friction(0.6);
            bodies.push(world.insert(body, collider).0);
        }
        let mut debris = Debris::new(DebrisConfig::default());
        for rock in &bodies {
            debris.add(*rock, &mut world.bodies, &world.colliders)?;
        }
        Ok(Self { debris, bodies })
    }

    /// Steps the world by `dt` seconds, with the rocks and the skin near them.
    pub fn step(
        &mut self,
        skin: (ObstacleId, &SkinnedSurface),
        world: &mut PhysicsWorld,
        dt: f64,
    ) -> Result<DebrisReport, DebrisError> {
        let debris = &mut self.debris;
        debris.before_step(&[skin], &mut world.bodies, &mut world.colliders, dt)?;
        world.step_with_events(&*debris, &());
        let (broad_phase, narrow_phase) = (&world.broad_phase, &world.narrow_phase);
        let (bodies, colliders) = (&mut world.bodies, &world.colliders);
        debris.after_step(&[skin], bodies, colliders, broad_phase, narrow_phase, dt)
    }
}
