//! clamber's own surface as a peer: skinned lazily, or all at once.

use std::error::Error;
use std::sync::Arc;

use clamber_surface::geometry::{Affine, Capsule, Ray, Similarity, Sphere};
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::rig::Palette;
use clamber_surface::surface::{CastOptions, SkinnedSurface, SurfacePoint};
use glam::{DVec3, Vec3};

use crate::peer::{Answer, Entry, Nearest, Peer, RayHit};

/// clamber's two peers.
pub(crate) const ENTRIES: &[Entry] = &[
    Entry {
        name: "clamber",
        make: |mesh| Ok(Box::new(Ours::new(mesh))),
    },
    Entry {
        name: "clamber, all skinned ahead",
        make: |mesh| Ok(Box::new(Ours::ahead(mesh)?)),
    },
];

/// Options of sphere casts: a tolerance of 0.1 mm for spheres of any size.
const CAST: CastOptions = CastOptions::STILL.with_tolerance(1e-4);

/// A surface whose placement is kept in f64. Queries are transformed to model space, as users of clamber do.
struct Ours {
    surface: SkinnedSurface,
    ahead: bool,
    /// The triangles of an overlap.
    found: Vec<TriangleId>,
}

impl Ours {
    fn new(mesh: &Arc<ColliderMesh>) -> Self {
        Self {
            surface: SkinnedSurface::new(Arc::clone(mesh)),
            ahead: false,
            found: Vec::new(),
        }
    }

    /// A surface that is skinned at once in each tick. Two ticks at rest fill the caches of both poses.
    fn ahead(mesh: &Arc<ColliderMesh>) -> Result<Self, Box<dyn Error>> {
        let mut ours = Self::new(mesh);
        ours.ahead = true;
        let rest = Palette::from_matrices(vec![Affine::IDENTITY; mesh.joint_count()]);
        for _ in 0..2 {
            ours.update(&rest, DVec3::ZERO)?;
        }
        Ok(ours)
    }

    fn local(&self, point: Vec3) -> Vec3 {
        let placed = self.surface.world_from_model();
        placed.inverse_transform_point_f32(point.as_dvec3())
    }

    /// A sphere in model space; `None` if it is not finite. Such a sphere touches and hits no triangle.
    fn local_ball(&self, sphere: &Sphere) -> Option<Capsule> {
        Capsule::ball(self.local(sphere.center), sphere.radius)
    }
}

impl Peer for Ours {
    fn update(&mut self, palette: &Palette, place: DVec3) -> Result<(), Box<dyn Error>> {
        let world_from_model = Similarity {
            translation: place,
            ..Similarity::IDENTITY
        };
        self.surface.advance(palette, world_from_model)?;
        if self.ahead {
            self.surface.skin_ahead();
        }
        Ok(())
    }

    fn cast_ray(&mut self, ray: &Ray, max_distance: f32) -> Answer<Option<RayHit>> {
        let local = Ray::new(self.local(ray.origin()), ray.direction());
        let hit = local.and_then(|ray| self.surface.in_model().cast_ray(&ray, max_distance));
        Ok(hit.map(|hit| RayHit {
            distance: hit.distance as f32,
            triangle: hit.triangle,
        }))
    }

    fn overlap_sphere(&mut self, sphere: &Sphere) -> Answer<usize> {
        let Some(ball) = self.local_ball(sphere) else {
            return Ok(0);
        };
        let space = self.surface.in_model();
        self.found.clear();
        space.visit_triangles_in_capsule(&ball, |triangle| self.found.push(triangle));
        Ok(self.found.len())
    }

    fn closest_point(&mut self, point: Vec3, max_distance: f32) -> Answer<Option<Nearest>> {
        let space = self.surface.in_model();
        let hit = space.closest_point(self.local(point), max_distance);
        let placed = self.surface.world_from_model();
        Ok(hit.map(|hit| Nearest {
            point: placed.transform_point_f32(hit.point).as_vec3(),
            distance: hit.distance as f32,
        }))
    }

    fn cast_sphere(&mut self, sphere: &Sphere, motion: Vec3) -> Answer<Option<f32>> {
        let space = self.surface.in_model();
        let ball = self.local_ball(sphere);
        let hit = ball.and_then(|ball| space.cast_capsule(&ball, [motion; 2], &CAST));
        Ok(hit.map(|hit| hit.fraction as f32))
    }

    fn motion(&mut self, triangle: TriangleId, barycentric: [f32; 3]) -> (Vec3, Vec3) {
        let point = SurfacePoint {
            mesh: self.surface.mesh().id(),
            triangle,
            barycentric,
        };
        let path = self.surface.in_model().path(point, 1.0);
        let placed = self.surface.world_from_model();
        path.map_or((Vec3::NAN, Vec3::NAN), |path| {
            let point = placed.transform_point_f32(path.position).as_vec3();
            (point, path.velocity)
        })
    }

    fn bytes(&self, _: usize) -> usize {
        self.surface.memory()
    }
}
