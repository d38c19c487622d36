//! Every bound holds every vertex as it is skinned.

use std::sync::Arc;

use clamber_surface::geometry::Sphere;
use clamber_surface::mesh::{ColliderMesh, PartId, VertexId};
use clamber_surface::rig::Palette;
use clamber_surface::surface::{JointMaps, NodeBounds, PartBounds};
use glam::Vec3;

use super::posed::Posed;

/// What bounds a mesh in any pose, made once.
pub(super) struct Bounds {
    parts: PartBounds,
    /// Bounds of some sets of vertices that no part is.
    sets: Vec<(Vec<VertexId>, NodeBounds)>,
    /// For vertices that are looked at closely: the triangles around them.
    around: Vec<(usize, Vec<u32>)>,
    maps: JointMaps,
}

impl Bounds {
    pub(super) fn new(mesh: &Arc<ColliderMesh>, rng: &mut fastrand::Rng) -> Self {
        let count = mesh.positions().len();
        let mut sets = Vec::new();
        for size in [1, 3, 20, 200] {
            let first = rng.usize(0..count);
            // Neighbours, and vertices from all over.
            let next = (0..size).map(|k| VertexId(((first + k) % count) as u32));
            let any = (0..size).map(|_| VertexId(rng.usize(0..count) as u32));
            for set in [next.collect::<Vec<_>>(), any.collect()] {
                sets.extend(NodeBounds::new(mesh, &set).map(|node| (set, node)));
            }
        }
        let mut around: Vec<(usize, Vec<u32>)> = (0..24)
            .map(|_| {
                let corners = mesh.triangles()[rng.usize(0..mesh.triangles().len())];
                (corners[rng.usize(0..3)].index(), Vec::new())
            })
            .collect();
        for (id, corners) in mesh.triangles().iter().enumerate() {
            for (vertex, triangles) in &mut around {
                if corners.iter().any(|corner| corner.index() == *vertex) {
                    triangles.push(id as u32);
                }
            }
        }
        Self {
            parts: PartBounds::new(mesh),
            sets,
            around,
            maps: JointMaps::default(),
        }
    }

    /// Gives how often a vertex was held against a bound.
    pub(super) fn check(&mut self, posed: &Posed<'_>, palette: &Palette) -> usize {
        let mesh = posed.surface.mesh();
        if let Err(error) = self.maps.update(mesh, palette) {
            panic!("bounds refuse what the surface took: {error}");
        }
        let mut checked = 0;
        for (index, part) in mesh.parts().iter().enumerate() {
            if let Some(node) = self.parts.node(PartId(index as u32)) {
                checked += self.check_node(node, &part.vertices, posed);
            }
        }
        for (set, node) in &self.sets {
            checked += self.check_node(node, set, posed);
        }
        checked + check_ball(posed) + self.check_tree(posed)
    }

    fn check_node(&self, node: &NodeBounds, vertices: &[VertexId], posed: &Posed<'_>) -> usize {
        let maps = &self.maps;
        let (hull, interval) = (node.hull(maps), node.weight_interval(maps));
        let (capsule, volume) = (node.capsule(maps), node.volume(maps));
        for vertex in vertices {
            let p = posed.positions[vertex.index()];
            let held = [
                hull.contains(p),
                interval.contains(p),
                node.sphere(maps).contains(p),
                capsule.contains(p),
                volume.contains(p),
            ];
            assert_eq!(held, [true; 5], "vertex {vertex} at {p} escapes");
        }
        5 * vertices.len()
    }

    /// The hierarchy lets a query through that asks at a vertex.
    fn check_tree(&self, posed: &Posed<'_>) -> usize {
        let surface = posed.surface;
        let mut hits = Vec::new();
        for (vertex, triangles) in &self.around {
            let p = posed.positions[*vertex];
            let touching = Sphere {
                center: p,
                radius: 0.0,
            };
            let overlapped = surface.overlap_sphere(&touching, &mut hits);
            assert!(overlapped.is_ok(), "{overlapped:?}");
            for triangle in triangles {
                let found = hits.iter().any(|hit| hit.triangle.0 == *triangle);
                assert!(found, "triangle {triangle} does not touch its corner {p}");
            }
            let nearest = surface.closest_point(p, 0.0);
            assert!(matches!(nearest, Ok(Some(_))), "nothing is at vertex {p}");
            let cast = surface.cast_sphere(&touching, Vec3::ZERO, 0.0);
            assert!(matches!(cast, Ok(Some(_))), "no cast starts at vertex {p}");
        }
        self.around.len() * 3
    }
}

/// The ball about all skin over the tick, in the world.
fn check_ball(posed: &Posed<'_>) -> usize {
    let Some((center, radius)) = posed.surface.bounding_ball() else {
        panic!("skin without bounds");
    };
    let place = posed.surface.world_from_model();
    let both = posed.positions.iter().chain(&posed.previous);
    for p in both {
        let away = place.transform_point_f32(*p).distance(center);
        assert!(away <= radius, "{p} is {away} from {center}, not {radius}");
    }
    posed.positions.len() * 2
}
