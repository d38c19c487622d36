//! Ground, outcrop and rocks of a battle, for its recording.

use std::io::Write;

use clamber_record::{RecordError, Recorder, SceneryView};
use clamber_surface::geometry::Similarity;
use clamber_world::rapier3d::prelude::*;
use glam::Vec3;

use super::super::{Battle, outcrop};
use crate::valley;

/// Distance between neighbouring corners of the ground, metres.
const CELL: f64 = 4.0;

/// A mesh, and the body that moves it.
struct Mesh {
    name: String,
    body: Option<RigidBodyHandle>,
    points: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    color: [f32; 3],
}

/// All meshes of a battle but the creature's.
pub(super) struct Scenery {
    meshes: Vec<Mesh>,
    /// What stands still is recorded once.
    is_recorded: bool,
}

impl Scenery {
    pub(super) fn of(battle: &Battle<'_>) -> Self {
        let still = |name: &str, (points, triangles), color| Mesh {
            name: name.to_owned(),
            body: None,
            points,
            triangles,
            color,
        };
        let mut meshes = vec![still("ground", valley::mesh(CELL), [0.42, 0.47, 0.33])];
        if battle.has_outcrop() {
            meshes.push(still("outcrop", outcrop(), [0.4, 0.38, 0.35]));
        }
        let world = battle.world();
        for (number, body) in battle.rocks().bodies().iter().enumerate() {
            for collider in world.bodies[*body].colliders() {
                let shape = world.colliders[*collider].shared_shape();
                let mesh = match shape.as_typed_shape() {
                    TypedShape::Ball(ball) => ball.to_trimesh(12, 8),
                    TypedShape::Cuboid(cuboid) => cuboid.to_trimesh(),
                    TypedShape::Capsule(capsule) => capsule.to_trimesh(12, 6),
                    _ => continue,
                };
                let name = format!("rock {number}");
                meshes.push(Mesh {
                    body: Some(*body),
                    ..still(&name, mesh, [0.36, 0.34, 0.31])
                });
            }
        }
        Self {
            meshes,
            is_recorded: false,
        }
    }

    /// Records what moves, and the first time all of it.
    pub(super) fn record<W: Write>(
        &mut self,
        battle: &Battle<'_>,
        recorder: &mut Recorder<W>,
    ) -> Result<(), RecordError> {
        let first = !core::mem::replace(&mut self.is_recorded, true);
        if !first && !recorder.is_due()? {
            return Ok(());
        }
        for mesh in &self.meshes {
            let body = mesh.body.map(|body| &battle.world().bodies[body]);
            if body.is_none() && !first {
                continue;
            }
            let world_from_own = body.map_or(Similarity::IDENTITY, |body| Similarity {
                rotation: body.rotation().as_dquat().normalize(),
                scale: 1.0,
                translation: body.translation().as_dvec3(),
            });
            recorder.scenery(&SceneryView {
                name: &mesh.name,
                world_from_own,
                points: &mesh.points,
                triangles: &mesh.triangles,
                color: mesh.color,
            })?;
        }
        Ok(())
    }
}
