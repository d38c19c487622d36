//! A set as a rapier world.

use std::error::Error;

use clamber_scenes::controllers::{Motion, Set, Solid};
use clamber_surface::geometry::Similarity;
use clamber_world::rapier3d::prelude::{
    ColliderBuilder, PhysicsWorld, Pose, RigidBodyBuilder, RigidBodyHandle, TriMeshFlags, Vector,
};
use glam::Quat;

/// A world, and its moving bodies.
pub(super) struct Bodies {
    pub(super) world: PhysicsWorld,
    pub(super) moving: Vec<(RigidBodyHandle, Motion)>,
}

impl Bodies {
    /// The world of a set. `kinematic` makes a moving body.
    pub(super) fn new(
        set: &Set,
        kinematic: fn() -> RigidBodyBuilder,
    ) -> Result<Self, Box<dyn Error>> {
        let mut world = PhysicsWorld::default();
        world.integration_parameters.dt = set.dt as f32;
        let mut moving = Vec::new();
        for piece in &set.pieces {
            let body = if piece.moves {
                kinematic()
            } else {
                RigidBodyBuilder::fixed()
            };
            let body = body.pose(pose(&(piece.motion)(0.0)));
            let (handle, _) = world.insert(body, collider(&piece.solid)?);
            if piece.moves {
                moving.push((handle, piece.motion.clone()));
            }
        }
        world.detect_collisions(&(), &());
        Ok(Self { world, moving })
    }
}

pub(super) fn pose(motion: &Similarity) -> Pose {
    let q = motion.rotation;
    let rotation = Quat::from_xyzw(q.x as f32, q.y as f32, q.z as f32, q.w as f32);
    Pose::from_parts(motion.translation.as_vec3(), rotation)
}

/// The collider of a solid. Meshes get pseudo-normals, with which rapier avoids contacts with inner edges.
fn collider(solid: &Solid) -> Result<ColliderBuilder, Box<dyn Error>> {
    Ok(match solid {
        Solid::Block { low, high } => {
            let half = ((*high - *low) * 0.5).as_vec3();
            let middle = ((*high + *low) * 0.5).as_vec3();
            ColliderBuilder::cuboid(half.x, half.y, half.z).translation(middle)
        }
        Solid::Mesh(mesh) => {
            let corners: Vec<Vector> = mesh.positions.iter().map(|p| p.as_vec3()).collect();
            let flags = TriMeshFlags::FIX_INTERNAL_EDGES;
            ColliderBuilder::trimesh_with_flags(corners, mesh.triangles.clone(), flags)?
        }
    })
}
