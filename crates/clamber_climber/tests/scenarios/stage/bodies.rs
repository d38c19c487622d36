//! Meshes as kinematic bodies of a rapier world.

use clamber_surface::geometry::Similarity;
use clamber_world::rapier3d::prelude::{
    ColliderBuilder, PhysicsWorld, Pose, RigidBodyBuilder, RigidBodyHandle, Vector,
};
use clamber_world::{BodyPoses, RapierTerrain};
use glam::{DVec3, Quat};

use super::{Motion, Shape};

/// A rapier world of bodies that play motions.
pub(crate) struct Bodies {
    pub(crate) world: PhysicsWorld,
    before: BodyPoses,
    moving: Vec<(RigidBodyHandle, Motion)>,
    origin: DVec3,
}

impl Bodies {
    pub(crate) fn new(dt: f64, origin: DVec3) -> Self {
        let mut world = PhysicsWorld::default();
        world.integration_parameters.dt = dt as f32;
        Self {
            world,
            before: BodyPoses::new(),
            moving: Vec::new(),
            origin,
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.world.colliders.is_empty()
    }

    pub(crate) fn add(&mut self, shape: &Shape, motion: Motion) {
        let body = RigidBodyBuilder::kinematic_position_based().pose(pose(&motion(0.0)));
        let (handle, _) = self.world.insert(body, mesh(shape));
        self.moving.push((handle, motion));
        self.found();
    }

    pub(crate) fn add_fixed(&mut self, collider: ColliderBuilder) {
        self.world.insert_collider(collider, None);
        self.found();
    }

    pub(crate) fn add_still(&mut self, shape: &Shape) {
        self.add_fixed(mesh(shape));
    }

    /// So that the first tick has poses to come from.
    fn found(&mut self) {
        self.world.detect_collisions(&(), &());
        self.before.record(&self.world.bodies);
    }

    pub(crate) fn advance(&mut self, time: f64) {
        self.before.record(&self.world.bodies);
        for (handle, motion) in &self.moving {
            if let Some(body) = self.world.bodies.get_mut(*handle) {
                body.set_next_kinematic_position(pose(&motion(time)));
            }
        }
        self.world.step();
    }

    pub(crate) fn terrain(&self) -> RapierTerrain<'_> {
        RapierTerrain::of_world(&self.world, &self.before).with_origin(self.origin)
    }
}

fn pose(motion: &Similarity) -> Pose {
    let q = motion.rotation;
    let rotation = Quat::from_xyzw(q.x as f32, q.y as f32, q.z as f32, q.w as f32);
    Pose::from_parts(motion.translation.as_vec3(), rotation)
}

fn mesh(shape: &Shape) -> ColliderBuilder {
    let corners: Vec<Vector> = shape.positions.iter().map(|p| p.as_vec3()).collect();
    ColliderBuilder::trimesh(corners, shape.triangles.clone()).unwrap()
}
