//! The same rocks against the whole skin as one deformable mesh in rapier.

use std::error::Error;
use std::time::Instant;

use clamber::world::rapier3d::prelude::*;
use glam::Vec3;

use crate::scene::Rocks;

pub(crate) struct Whole<'a> {
    scene: Rocks<'a>,
    skin: ColliderHandle,
    positions: Vec<Vec3>,
}

impl<'a> Whole<'a> {
    pub(crate) fn new(mut scene: Rocks<'a>) -> Result<Self, Box<dyn Error>> {
        let mut positions = Vec::new();
        scene.surface.skin_all(&mut positions);
        let triangles = scene.surface.mesh().triangles().iter();
        let triangles = triangles.map(|corners| corners.map(|v| v.0)).collect();
        let root = scene.surface.world_from_model().translation.as_vec3();
        let body = RigidBodyBuilder::kinematic_velocity_based().translation(root);
        let flags = TriMeshFlags::DEFORMABLE;
        let mesh = ColliderBuilder::trimesh_with_flags(positions.clone(), triangles, flags)?;
        let (_, skin) = scene.world.insert(body, mesh.friction(0.8).density(0.0));
        Ok(Self {
            scene,
            skin,
            positions,
        })
    }

    pub(crate) fn play(&mut self, clip: Option<&str>) {
        self.scene.play(clip);
    }

    /// Runs one tick; returns the time to skin the mesh and set its vertices, microseconds.
    pub(crate) fn step(&mut self) -> Result<f64, Box<dyn Error>> {
        self.scene.pose()?;
        let start = Instant::now();
        self.scene.surface.skin_all(&mut self.positions);
        let collider = self.scene.world.colliders.get_mut(self.skin);
        let mesh = collider.and_then(|collider| collider.shape_mut().as_trimesh_mut());
        mesh.ok_or("the skin's collider is not a mesh")?
            .set_vertices(&self.positions);
        let set = start.elapsed().as_secs_f64() * 1e6;
        self.scene.world.step();
        Ok(set)
    }
}
