use clamber_climber::ClimberMode;
use clamber_surface::mesh::{ColliderMesh, TriangleId, VertexId};
use foxglove::messages::{
    Color, Point3, SceneEntity, SceneUpdate, SpherePrimitive, TriangleListPrimitive,
};
use glam::{DVec3, Vec3};

use super::{CREATURE, WORLD, color, pose, timestamp, vector};
use crate::taken::{Taken, TakenSkin};

/// Marks a vertex without a place among the points.
const NOWHERE: u32 = u32::MAX;

/// Skin that this tick's queries touched, the triangle underfoot, the climber.
pub(crate) struct Scene {
    radius: f64,
    /// By vertex: its place among the points. Kept for its memory, all [`NOWHERE`] between ticks.
    places: Vec<u32>,
}

impl Scene {
    pub(crate) fn new(climber_radius: f64) -> Self {
        Self {
            radius: climber_radius,
            places: Vec::new(),
        }
    }

    /// `positions` are those of all vertices of the surface, in model space.
    pub(crate) fn message(
        &mut self,
        nanoseconds: u64,
        taken: &Taken,
        skin: &TakenSkin,
        positions: &[Vec3],
    ) -> SceneUpdate {
        let (state, scale) = (&taken.state, taken.world_from_model.scale);
        let mesh = &*skin.mesh;
        let entity = |id: &str, frame: &str| SceneEntity {
            timestamp: Some(timestamp(nanoseconds)),
            frame_id: frame.to_owned(),
            id: id.to_owned(),
            frame_locked: true,
            ..SceneEntity::default()
        };
        let mut touched = entity("touched", CREATURE);
        let triangles = skin.triangles.iter().copied();
        let tint = color(0.95, 0.7, 0.2, 0.5);
        touched.triangles = vec![self.list(mesh, scale, positions, triangles, tint)];

        let mut underfoot = entity("underfoot", CREATURE);
        // A footing on another obstacle has a key of its own meaning, which may name a triangle by chance:
        // only one that the contact lies on counts.
        let key = state.footing.map(|footing| footing.point.key);
        let on = key.filter(|_| contact_is_on(taken, mesh, positions));
        let triangle = on.map(|key| TriangleId(key as u32)).into_iter();
        let tint = color(0.9, 0.1, 0.1, 1.0);
        underfoot.triangles = vec![self.list(mesh, scale, positions, triangle, tint)];

        let mut climber = entity("climber", WORLD);
        climber.spheres = vec![SpherePrimitive {
            pose: Some(pose(state.position)),
            size: Some(vector(DVec3::splat(2.0 * self.radius))),
            color: Some(match state.mode {
                ClimberMode::Standing => color(0.2, 0.7, 0.3, 0.9),
                ClimberMode::Falling => color(0.2, 0.4, 0.9, 0.9),
            }),
        }];
        SceneUpdate {
            deletions: Vec::new(),
            entities: vec![touched, underfoot, climber],
        }
    }

    /// Triangles as a list of points and corners, in the creature's frame.
    fn list(
        &mut self,
        mesh: &ColliderMesh,
        scale: f64,
        positions: &[Vec3],
        triangles: impl Iterator<Item = TriangleId>,
        tint: Color,
    ) -> TriangleListPrimitive {
        self.places.resize(positions.len(), NOWHERE);
        let (mut points, mut indices) = (Vec::new(), Vec::new());
        let mut used: Vec<VertexId> = Vec::new();
        let all = mesh.triangles();
        for corners in triangles.filter_map(|triangle| all.get(triangle.index())) {
            for corner in corners {
                let vertex = corner.index();
                let (Some(place), Some(p)) = (self.places.get_mut(vertex), positions.get(vertex))
                else {
                    continue;
                };
                if *place == NOWHERE {
                    *place = points.len() as u32;
                    used.push(*corner);
                    let p = p.as_dvec3() * scale;
                    points.push(Point3 {
                        x: p.x,
                        y: p.y,
                        z: p.z,
                    });
                }
                indices.push(*place);
            }
        }
        for vertex in used {
            self.places[vertex.index()] = NOWHERE;
        }
        TriangleListPrimitive {
            pose: Some(pose(DVec3::ZERO)),
            points,
            color: Some(tint),
            colors: Vec::new(),
            indices,
        }
    }
}

/// True if the climber's footing names a triangle of the surface that its contact lies near.
fn contact_is_on(taken: &Taken, mesh: &ColliderMesh, positions: &[Vec3]) -> bool {
    let named = || {
        let footing = taken.state.footing?;
        let triangle = usize::try_from(footing.point.key).ok()?;
        let corners = mesh.triangles().get(triangle)?;
        let mut position = DVec3::ZERO;
        for (corner, weight) in corners.iter().zip(footing.point.coordinates) {
            position += positions.get(corner.index())?.as_dvec3() * weight;
        }
        let in_world = taken.world_from_model.transform_point(position);
        Some(in_world.distance(footing.contact) < 0.01 * taken.world_from_model.scale.max(1.0))
    };
    named().unwrap_or(false)
}
