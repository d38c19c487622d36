//! parry's triangle mesh: built anew each frame, or with new vertices set, which refits its hierarchy.

use std::error::Error;
use std::sync::Arc;

use clamber_surface::geometry::{Ray, Sphere};
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::rig::Palette;
use glam::{DVec3, Vec3};
use parry3d::bounding_volume::Aabb;
use parry3d::math::Pose;
use parry3d::query::{PointQuery, RayCast, ShapeCastOptions, cast_shapes};
use parry3d::shape::{Ball, TriMesh};

use crate::peer::{Answer, Entry, Nearest, Peer, RayHit};
use crate::skin::Skin;

/// The two peers with parry's mesh.
pub(crate) const ENTRIES: &[Entry] = &[
    Entry {
        name: "parry, new each frame",
        make: |mesh| Ok(Box::new(Parry::new(mesh, true)?)),
    },
    Entry {
        name: "parry, vertices set",
        make: |mesh| Ok(Box::new(Parry::new(mesh, false)?)),
    },
];

struct Parry {
    skin: Skin,
    shape: TriMesh,
    anew: bool,
}

impl Parry {
    fn new(mesh: &Arc<ColliderMesh>, anew: bool) -> Result<Self, Box<dyn Error>> {
        let skin = Skin::new(mesh);
        Ok(Self {
            shape: TriMesh::new(skin.positions.clone(), skin.triangles())?,
            skin,
            anew,
        })
    }
}

impl Peer for Parry {
    fn update(&mut self, palette: &Palette, place: DVec3) -> Result<(), Box<dyn Error>> {
        self.skin.update(palette, place)?;
        if self.anew {
            let indices = self.shape.indices().to_vec();
            self.shape = TriMesh::new(self.skin.positions.clone(), indices)?;
        } else {
            self.shape.set_vertices(&self.skin.positions);
        }
        Ok(())
    }

    fn cast_ray(&mut self, ray: &Ray, max_distance: f32) -> Answer<Option<RayHit>> {
        let ray = parry3d::query::Ray::new(ray.origin(), ray.direction());
        let hit = self
            .shape
            .cast_local_ray_and_get_normal(&ray, max_distance, false);
        let triangles = self.shape.indices().len() as u32;
        Ok(hit.map(|hit| RayHit {
            distance: hit.time_of_impact,
            // parry numbers the back faces after all front faces.
            triangle: TriangleId(hit.feature.unwrap_face() % triangles),
        }))
    }

    /// parry's query tells whether a ball touches the mesh, but not which triangles it touches. So each triangle whose
    /// box is near is tested.
    fn overlap_sphere(&mut self, sphere: &Sphere) -> Answer<usize> {
        let reach = Vec3::splat(sphere.radius);
        let near = Aabb::new(sphere.center - reach, sphere.center + reach);
        let touches = |triangle: &u32| {
            let triangle = self.shape.triangle(*triangle);
            let nearest = triangle.project_local_point(sphere.center, false).point;
            nearest.distance(sphere.center) <= sphere.radius
        };
        let near = self.shape.bvh().intersect_aabb(&near);
        Ok(near.filter(touches).count())
    }

    fn closest_point(&mut self, point: Vec3, max_distance: f32) -> Answer<Option<Nearest>> {
        let found = self
            .shape
            .project_local_point_with_max_dist(point, false, max_distance);
        Ok(found.map(|found| Nearest {
            point: found.point,
            distance: found.point.distance(point),
        }))
    }

    fn cast_sphere(&mut self, sphere: &Sphere, motion: Vec3) -> Answer<Option<f32>> {
        let options = ShapeCastOptions {
            max_time_of_impact: 1.0,
            ..ShapeCastOptions::default()
        };
        let start = Pose::from_translation(sphere.center);
        let ball = Ball::new(sphere.radius);
        let mesh = Pose::IDENTITY;
        let hit = cast_shapes(
            &start,
            motion,
            &ball,
            &mesh,
            Vec3::ZERO,
            &self.shape,
            options,
        );
        Ok(hit.ok().flatten().map(|hit| hit.time_of_impact))
    }

    fn skin(&self) -> Option<&Skin> {
        Some(&self.skin)
    }
}
