//! The thesis's method: all vertices are skinned, a sphere around each joint's part is found in linear time, and the
//! triangles of the parts whose sphere is reached are tested one by one.

use std::error::Error;
use std::sync::Arc;

use clamber_surface::geometry::{Ray, Sphere};
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::rig::Palette;
use glam::{DVec3, Vec3};

use crate::peer::{Answer, Entry, Nearest, Peer, RayHit};
use crate::skin::Skin;
use crate::triangle;

/// The peer with the thesis's method.
pub(crate) const ENTRIES: &[Entry] = &[Entry {
    name: "thesis",
    make: |mesh| Ok(Box::new(Thesis::new(mesh))),
}];

struct Thesis {
    skin: Skin,
    parts: Vec<Part>,
}

struct Part {
    vertices: Vec<u32>,
    triangles: Vec<u32>,
    sphere: Sphere,
}

impl Thesis {
    fn new(mesh: &Arc<ColliderMesh>) -> Self {
        let mut parts: Vec<Part> = (0..mesh.part_count()).map(|_| Part::default()).collect();
        for (index, corners) in mesh.triangles().iter().enumerate() {
            let Some(part) = mesh.part_of(TriangleId(index as u32)) else {
                continue;
            };
            let part = &mut parts[part.index()];
            part.triangles.push(index as u32);
            part.vertices.extend(corners.map(|v| v.0));
        }
        for part in &mut parts {
            part.vertices.sort_unstable();
            part.vertices.dedup();
        }
        Self {
            skin: Skin::new(mesh),
            parts,
        }
    }

    /// Triangles of the parts whose sphere comes within `reach` of a point.
    fn near(&self, point: Vec3, reach: f32) -> impl Iterator<Item = [Vec3; 3]> {
        let near = self.parts.iter().filter(move |part| {
            let apart = part.sphere.center.distance(point);
            apart <= part.sphere.radius + reach
        });
        near.flat_map(|part| &part.triangles)
            .map(|triangle| self.skin.corners(*triangle as usize))
    }
}

impl Default for Part {
    fn default() -> Self {
        Self {
            vertices: Vec::new(),
            triangles: Vec::new(),
            sphere: Sphere {
                center: Vec3::ZERO,
                radius: 0.0,
            },
        }
    }
}

impl Part {
    /// Fits the sphere in two loops: the mean of the vertices, and the vertex farthest from it.
    fn bound(&mut self, positions: &[Vec3]) {
        let vertices = || self.vertices.iter().map(|v| positions[*v as usize]);
        let sum: Vec3 = vertices().sum();
        let center = sum / self.vertices.len().max(1) as f32;
        let farthest = vertices().map(|p| p.distance_squared(center));
        let radius = farthest.fold(0.0, f32::max).sqrt();
        self.sphere = Sphere { center, radius };
    }
}

impl Peer for Thesis {
    fn update(&mut self, palette: &Palette, place: DVec3) -> Result<(), Box<dyn Error>> {
        self.skin.update(palette, place)?;
        for part in &mut self.parts {
            part.bound(&self.skin.positions);
        }
        Ok(())
    }

    fn cast_ray(&mut self, ray: &Ray, max_distance: f32) -> Answer<Option<RayHit>> {
        let (origin, direction) = (ray.origin(), ray.direction());
        let mut nearest: Option<RayHit> = None;
        let mut limit = max_distance;
        for part in &self.parts {
            let to = part.sphere.center - origin;
            let along = to.dot(direction).clamp(0.0, limit);
            if (to - direction * along).length() > part.sphere.radius {
                continue;
            }
            for triangle in &part.triangles {
                let corners = self.skin.corners(*triangle as usize);
                let met = triangle::cast_ray(origin, direction, corners);
                if let Some(distance) = met.filter(|distance| *distance <= limit) {
                    limit = distance;
                    nearest = Some(RayHit {
                        distance,
                        triangle: TriangleId(*triangle),
                    });
                }
            }
        }
        Ok(nearest)
    }

    fn overlap_sphere(&mut self, sphere: &Sphere) -> Answer<usize> {
        let within = |corners: &[Vec3; 3]| {
            let nearest = triangle::closest_point(sphere.center, *corners);
            nearest.distance(sphere.center) <= sphere.radius
        };
        let near = self.near(sphere.center, sphere.radius);
        Ok(near.filter(within).count())
    }

    fn closest_point(&mut self, point: Vec3, max_distance: f32) -> Answer<Option<Nearest>> {
        let mut nearest: Option<Nearest> = None;
        let mut limit = max_distance;
        for part in &self.parts {
            if part.sphere.center.distance(point) - part.sphere.radius > limit {
                continue;
            }
            for triangle in &part.triangles {
                let corners = self.skin.corners(*triangle as usize);
                triangle::offer(point, corners, &mut limit, &mut nearest);
            }
        }
        Ok(nearest)
    }

    fn skin(&self) -> Option<&Skin> {
        Some(&self.skin)
    }
}
