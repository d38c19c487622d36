use rapier3d::prelude::*;

use super::Debris;

/// A copy of a rapier world and its debris between two ticks. Save it with an arena if rocks have to be rolled back,
/// too.
///
/// A snapshot costs much more than a saved arena, because it copies all of rapier's sets; the bench `arena` measures
/// it. Leave out rocks that are only decoration.
///
/// ```
/// use clamber_world::rapier3d::prelude::*;
/// use clamber_world::{Debris, DebrisConfig, DebrisSnapshot};
///
/// let mut world = PhysicsWorld::default();
/// let mut debris = Debris::new(DebrisConfig::default());
/// let rock = world.insert_body(RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 9.0, 0.0)));
/// world.insert_collider(ColliderBuilder::ball(0.4), Some(rock));
/// debris.add(rock, &mut world.bodies, &world.colliders)?;
///
/// let before = DebrisSnapshot::save(&world, &debris);
/// world.step();
/// before.restore(&mut world, &mut debris);
/// assert_eq!(world.bodies[rock].translation().y, 9.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct DebrisSnapshot {
    islands: IslandManager,
    broad_phase: DefaultBroadPhase,
    narrow_phase: NarrowPhase,
    bodies: RigidBodySet,
    colliders: ColliderSet,
    impulse_joints: ImpulseJointSet,
    multibody_joints: MultibodyJointSet,
    soft_bodies: SoftBodySet,
    debris: Debris,
}

impl DebrisSnapshot {
    /// Copies the parts of a world that change, and its debris.
    pub fn save(world: &PhysicsWorld, debris: &Debris) -> Self {
        Self {
            islands: world.islands.clone(),
            broad_phase: world.broad_phase.clone(),
            narrow_phase: world.narrow_phase.clone(),
            bodies: world.bodies.clone(),
            colliders: world.colliders.clone(),
            impulse_joints: world.impulse_joints.clone(),
            multibody_joints: world.multibody_joints.clone(),
            soft_bodies: world.soft_bodies.clone(),
            debris: debris.clone(),
        }
    }

    /// Restores world and debris. They go on with the same bits as they did then, if the skin does too. Gravity and
    /// integration parameters stay as they are.
    pub fn restore(&self, world: &mut PhysicsWorld, debris: &mut Debris) {
        let saved = self.clone();
        world.islands = saved.islands;
        world.broad_phase = saved.broad_phase;
        world.narrow_phase = saved.narrow_phase;
        world.bodies = saved.bodies;
        world.colliders = saved.colliders;
        world.impulse_joints = saved.impulse_joints;
        world.multibody_joints = saved.multibody_joints;
        world.soft_bodies = saved.soft_bodies;
        *debris = saved.debris;
    }
}
