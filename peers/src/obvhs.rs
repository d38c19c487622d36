//! obvhs: a bounding volume hierarchy that is refitted each frame.
//!
//! obvhs has queries for rays and boxes. This file adds a search over obvhs's nodes for the closest point.
#![allow(
    clippy::disallowed_types,
    reason = "obvhs uses Vec3A; a peer need not give the same bits everywhere"
)]

use std::error::Error;
use std::sync::Arc;
use std::time::Duration;

use ::obvhs::BvhBuildParams;
use ::obvhs::aabb::Aabb;
use ::obvhs::bvh2::Bvh2;
use ::obvhs::bvh2::builder::build_bvh2_from_tris;
use ::obvhs::ray::Ray as BvhRay;
use ::obvhs::triangle::Triangle;
use clamber_surface::geometry::{Ray, Sphere};
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::rig::Palette;
use glam::{DVec3, Vec3, Vec3A};

use crate::peer::{Answer, Entry, Nearest, Peer, RayHit};
use crate::skin::Skin;
use crate::triangle;

/// The peer obvhs.
pub(crate) const ENTRIES: &[Entry] = &[Entry {
    name: "obvhs, refitted",
    make: |mesh| Ok(Box::new(Obvhs::new(mesh))),
}];

struct Obvhs {
    skin: Skin,
    bvh: Bvh2,
    /// Nodes to visit, with their distances.
    stack: Vec<(f32, u32)>,
}

impl Obvhs {
    fn new(mesh: &Arc<ColliderMesh>) -> Self {
        let skin = Skin::new(mesh);
        let triangles: Vec<Triangle> = (0..mesh.triangles().len())
            .map(|index| triangle_of(skin.corners(index)))
            .collect();
        // A leaf for each triangle, as the refit from the leaves requires.
        let params = BvhBuildParams {
            max_prims_per_leaf: 1,
            pre_split: false,
            ..BvhBuildParams::medium_build()
        };
        let mut bvh = build_bvh2_from_tris(&triangles, params, &mut Duration::default());
        // In this order, a refit is one pass over the nodes.
        bvh.reorder_in_stack_traversal_order();
        bvh.update_primitives_to_nodes();
        Self {
            skin,
            bvh,
            stack: Vec::new(),
        }
    }
}

impl Peer for Obvhs {
    fn update(&mut self, palette: &Palette, place: DVec3) -> Result<(), Box<dyn Error>> {
        self.skin.update(palette, place)?;
        for (triangle, node) in self.bvh.primitives_to_nodes.iter().enumerate() {
            let bounds = triangle_of(self.skin.corners(triangle)).aabb();
            self.bvh.nodes[*node as usize].set_aabb(bounds);
        }
        self.bvh.refit_all();
        Ok(())
    }

    fn cast_ray(&mut self, ray: &Ray, max_distance: f32) -> Answer<Option<RayHit>> {
        let (origin, direction) = (ray.origin().into(), ray.direction().into());
        let ray = BvhRay::new(origin, direction, 0.0, max_distance);
        let mut hit = ::obvhs::ray::RayHit::none();
        let of = &self.bvh.primitive_indices;
        self.bvh.ray_traverse(ray, &mut hit, |ray, slot| {
            triangle_of(self.skin.corners(of[slot] as usize)).intersect(ray)
        });
        // Without a hit, the triangle's slot stays out of range. The distance does not show it.
        let met = of.get(hit.primitive_id as usize);
        Ok(met.map(|triangle| RayHit {
            distance: hit.t,
            triangle: TriangleId(*triangle),
        }))
    }

    fn overlap_sphere(&mut self, sphere: &Sphere) -> Answer<usize> {
        let reach = Vec3::splat(sphere.radius);
        let near = Aabb {
            min: (sphere.center - reach).into(),
            max: (sphere.center + reach).into(),
        };
        let mut found = 0;
        self.bvh.aabb_traverse(near, |bvh, node| {
            let node = &bvh.nodes[node as usize];
            for slot in node.first_index..node.first_index + node.prim_count {
                let corners = self
                    .skin
                    .corners(bvh.primitive_indices[slot as usize] as usize);
                let nearest = triangle::closest_point(sphere.center, corners);
                found += usize::from(nearest.distance(sphere.center) <= sphere.radius);
            }
            true
        });
        Ok(found)
    }

    fn closest_point(&mut self, point: Vec3, max_distance: f32) -> Answer<Option<Nearest>> {
        let mut nearest: Option<Nearest> = None;
        let mut limit = max_distance;
        let (nodes, of) = (&self.bvh.nodes, &self.bvh.primitive_indices);
        self.stack.clear();
        self.stack.push((0.0, 0));
        while let Some((bound, node)) = self.stack.pop() {
            if bound > limit {
                continue;
            }
            let node = &nodes[node as usize];
            if !node.is_leaf() {
                let apart = |child: u32| distance(nodes[child as usize].aabb(), point);
                let (left, right) = (node.first_index, node.first_index + 1);
                let (left, right) = ((apart(left), left), (apart(right), right));
                // The nearer child is visited first.
                let [first, second] = if left.0 <= right.0 {
                    [left, right]
                } else {
                    [right, left]
                };
                self.stack.extend([second, first]);
                continue;
            }
            for slot in node.first_index..node.first_index + node.prim_count {
                let corners = self.skin.corners(of[slot as usize] as usize);
                triangle::offer(point, corners, &mut limit, &mut nearest);
            }
        }
        Ok(nearest)
    }

    fn skin(&self) -> Option<&Skin> {
        Some(&self.skin)
    }
}

fn triangle_of(corners: [Vec3; 3]) -> Triangle {
    let [v0, v1, v2] = corners.map(Vec3A::from);
    Triangle { v0, v1, v2 }
}

/// Distance from a point to a box.
fn distance(bounds: &Aabb, point: Vec3) -> f32 {
    let point = Vec3A::from(point);
    point.distance(point.clamp(bounds.min, bounds.max))
}
