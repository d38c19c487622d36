//! The contenders: clamber lazily, clamber eagerly, and parry with clamber's skinning kernel.

use std::sync::Arc;

use clamber::geometry::{Capsule, Sphere};
use clamber::prelude::*;
use clamber::skin::skin_into;
use clamber::world::rapier3d::parry::bounding_volume::Aabb;
use clamber::world::rapier3d::parry::query::{PointQuery, Ray as ParryRay, RayCast};
use clamber::world::rapier3d::parry::shape::TriMesh;
use glam::Vec3;

use clamber_scenes::riders::Tick;

/// Answers all queries of a tick; returns the number of hits.
pub(crate) trait Contender {
    fn tick(&mut self, tick: &Tick) -> usize;
}

/// clamber's surface, which skins only the clusters that queries touch.
pub(crate) struct Lazy {
    pub(crate) surface: SkinnedSurface,
    hits: Vec<SurfaceHit>,
}

/// clamber's surface, which skins all vertices and refits all bounds before it answers.
pub(crate) struct Eager(pub(crate) Lazy);

/// parry's triangle mesh, with its vertices set each tick.
pub(crate) struct Parry {
    mesh: Arc<ColliderMesh>,
    positions: Vec<Vec3>,
    before: Vec<Vec3>,
    pub(crate) shape: TriMesh,
}

impl Lazy {
    pub(crate) fn new(mesh: &Arc<ColliderMesh>) -> Self {
        Self {
            surface: SkinnedSurface::new(mesh.clone()),
            hits: Vec::new(),
        }
    }

    fn answer(&mut self, tick: &Tick) -> usize {
        let mut found = 0;
        let space = self.surface.in_model();
        for rider in &tick.riders {
            for sphere in [&rider.body, &rider.foot] {
                if let Some(ball) = Capsule::ball(sphere.center, sphere.radius) {
                    space.overlap_capsule(&ball, &mut self.hits);
                    found += self.hits.len();
                }
            }
            let hit = space.cast_ray(&rider.ray, rider.reach);
            found += usize::from(hit.is_some());
            let motion = self.surface.in_model().motion(&rider.anchor, 1.0 / 60.0);
            found += usize::from(motion.is_ok());
        }
        found
    }

    pub(crate) fn advance(&mut self, palette: &Palette) {
        let advanced = self.surface.advance(palette, Similarity::IDENTITY);
        assert_eq!(advanced, Ok(()));
    }
}

impl Contender for Lazy {
    fn tick(&mut self, tick: &Tick) -> usize {
        self.advance(&tick.palette);
        self.answer(tick)
    }
}

impl Contender for Eager {
    fn tick(&mut self, tick: &Tick) -> usize {
        self.0.advance(&tick.palette);
        self.0.surface.skin_ahead();
        self.0.answer(tick)
    }
}

impl Parry {
    pub(crate) fn new(mesh: &Arc<ColliderMesh>) -> Result<Self, Box<dyn std::error::Error>> {
        let triangles = mesh.triangles().iter();
        let triangles = triangles.map(|corners| corners.map(|v| v.0)).collect();
        let positions = mesh.positions().to_vec();
        Ok(Self {
            mesh: mesh.clone(),
            shape: TriMesh::new(positions.clone(), triangles)?,
            before: positions.clone(),
            positions,
        })
    }

    fn overlaps(&self, sphere: &Sphere) -> usize {
        let reach = Vec3::splat(sphere.radius);
        let near = Aabb::new(sphere.center - reach, sphere.center + reach);
        let touches = |triangle: &u32| {
            let triangle = self.shape.triangle(*triangle);
            let nearest = triangle.project_local_point(sphere.center, false).point;
            nearest.distance(sphere.center) <= sphere.radius
        };
        self.shape
            .bvh()
            .intersect_aabb(&near)
            .filter(touches)
            .count()
    }
}

impl Contender for Parry {
    fn tick(&mut self, tick: &Tick) -> usize {
        std::mem::swap(&mut self.positions, &mut self.before);
        let palette = tick.palette.matrices();
        let skinned = skin_into(&self.mesh, palette, &mut self.positions);
        assert_eq!(skinned, Ok(()));
        self.shape.set_vertices(&self.positions);
        let mut found = 0;
        for rider in &tick.riders {
            found += self.overlaps(&rider.body) + self.overlaps(&rider.foot);
            let ray = ParryRay::new(rider.ray.origin(), rider.ray.direction());
            let hit = self
                .shape
                .cast_local_ray_and_get_normal(&ray, rider.reach, false);
            found += usize::from(hit.is_some());
            // The anchor's position and its motion over the tick, without frame and stretch.
            let corners = self.mesh.triangles()[rider.anchor.triangle.index()];
            let at = |positions: &[Vec3]| {
                let weighted = corners.iter().zip(rider.anchor.barycentric);
                weighted.fold(Vec3::ZERO, |sum, (v, w)| sum + positions[v.index()] * w)
            };
            found += usize::from((at(&self.positions) - at(&self.before)).is_finite());
        }
        found
    }
}
