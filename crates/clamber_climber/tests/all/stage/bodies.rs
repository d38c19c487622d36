//! Meshes as kinematic bodies in a rapier world.

use clamber_surface::geometry::Similarity;
use clamber_world::rapier3d::prelude::{
    Collider, ColliderBuilder, ColliderHandle, PhysicsWorld, Pose, RigidBodyBuilder,
    RigidBodyHandle, SharedShape, Vector,
};
use clamber_world::{BodyPoses, RapierTerrain, SurfaceTag};
use glam::{DVec3, Quat};

use super::{Motion, Setting, Shape};

/// A rapier world of bodies that play motions.
///
/// In a moving frame, positions grow, and with them f32 rounding, since the origin of the rapier world, in f64, is
/// fixed. The bodies have the scale of the setting: nothing is simulated, so rapier's default lengths do not matter.
pub(crate) struct Bodies {
    pub(crate) world: PhysicsWorld,
    before: BodyPoses,
    moving: Vec<(RigidBodyHandle, Motion)>,
    origin: DVec3,
    /// Displacement of the frame in a tick, metres.
    step: DVec3,
    scale: f64,
    /// The number in the tag of the next colliders.
    pub(super) number: u32,
}

/// The tag of a collider, with the number that it was given.
pub(super) fn tag(_: ColliderHandle, collider: &Collider) -> SurfaceTag {
    SurfaceTag::default().with_user(collider.user_data as u32)
}

impl Bodies {
    pub(crate) fn new(dt: f64, origin: DVec3, setting: &Setting) -> Self {
        let mut world = PhysicsWorld::default();
        world.integration_parameters.dt = dt as f32;
        Self {
            world,
            before: BodyPoses::new(),
            moving: Vec::new(),
            origin,
            step: setting.frame * dt,
            scale: setting.scale,
            number: 0,
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.world.colliders.is_empty()
    }

    pub(crate) fn add(&mut self, shape: &Shape, motion: Motion) {
        let mesh = self.mesh(shape);
        self.insert(mesh, motion);
    }

    /// Adds a fixed collider in the scenario's units.
    pub(crate) fn add_fixed(&mut self, mut collider: ColliderBuilder) {
        if self.scale != 1.0 {
            let scale = Vector::splat(self.scale as f32);
            let scaled = collider.shape.scale_dyn(scale, 1);
            collider.shape = SharedShape(scaled.unwrap().into());
            collider.position.translation *= self.scale as f32;
        }
        self.insert_still(collider);
    }

    pub(crate) fn add_still(&mut self, shape: &Shape) {
        let mesh = self.mesh(shape);
        self.insert_still(mesh);
    }

    /// Adds a collider at rest in the frame. If the frame moves, the collider moves with it.
    fn insert_still(&mut self, collider: ColliderBuilder) {
        let collider = collider.user_data(u128::from(self.number));
        if self.step == DVec3::ZERO {
            self.world.insert_collider(collider, None);
            self.found();
        } else {
            self.insert(collider, std::rc::Rc::new(|_| Similarity::IDENTITY));
        }
    }

    fn insert(&mut self, collider: ColliderBuilder, motion: Motion) {
        let pose = self.pose(&motion(0.0), 0.0);
        let body = RigidBodyBuilder::kinematic_position_based().pose(pose);
        let collider = collider.user_data(u128::from(self.number));
        let (handle, _) = self.world.insert(body, collider);
        self.moving.push((handle, motion));
        self.found();
    }

    /// Sets the poses from which the first tick starts.
    fn found(&mut self) {
        if self.step == DVec3::ZERO {
            self.world.detect_collisions(&(), &());
            self.before.record(&self.world.bodies);
            return;
        }
        for (handle, motion) in &self.moving {
            let pose = self.pose(&motion(0.0), -1.0);
            if let Some(body) = self.world.bodies.get_mut(*handle) {
                body.set_position(pose, true);
            }
        }
        self.advance(0.0, 0);
    }

    pub(crate) fn advance(&mut self, time: f64, clock: u32) {
        self.before.record(&self.world.bodies);
        for (handle, motion) in &self.moving {
            let pose = self.pose(&motion(time), f64::from(clock));
            if let Some(body) = self.world.bodies.get_mut(*handle) {
                body.set_next_kinematic_position(pose);
            }
        }
        self.world.step();
    }

    pub(crate) fn terrain(&self) -> RapierTerrain<'_> {
        RapierTerrain::of_world(&self.world, &self.before).with_origin(self.origin)
    }

    /// Largest coordinate of any collider, metres from the origin.
    pub(crate) fn reach(&self) -> f64 {
        let colliders = self.world.colliders.iter();
        let farthest = colliders.map(|(_, collider)| {
            let bounds = collider.compute_aabb();
            let corner = bounds.mins.abs().max(bounds.maxs.abs());
            f64::from(corner.max_element())
        });
        farthest.fold(0.0, f64::max)
    }

    fn pose(&self, motion: &Similarity, clock: f64) -> Pose {
        let q = motion.rotation;
        let rotation = Quat::from_xyzw(q.x as f32, q.y as f32, q.z as f32, q.w as f32);
        let place = motion.translation * self.scale + self.step * clock;
        Pose::from_parts(place.as_vec3(), rotation)
    }

    fn mesh(&self, shape: &Shape) -> ColliderBuilder {
        let corners = shape.positions.iter().map(|p| (*p * self.scale).as_vec3());
        let corners: Vec<Vector> = corners.collect();
        ColliderBuilder::trimesh(corners, shape.triangles.clone()).unwrap()
    }
}
