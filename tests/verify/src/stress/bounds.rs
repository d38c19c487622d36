//! Checks that every bound holds its skinned vertices.

use clamber_surface::geometry::Capsule;
use clamber_surface::mesh::ColliderMesh;
use clamber_surface::surface::CastOptions;
use glam::Vec3;

use super::posed::Posed;

/// Random vertices, chosen once. Queries are checked at them in every pose.
pub(super) struct Bounds {
    /// Each vertex with the ids of the triangles around it.
    around: Vec<(usize, Vec<u32>)>,
}

impl Bounds {
    pub(super) fn new(mesh: &ColliderMesh, rng: &mut fastrand::Rng) -> Self {
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
        Self { around }
    }

    /// Checks all bounds; returns the number of comparisons of a vertex with a bound.
    pub(super) fn check(&self, posed: &Posed<'_>) -> usize {
        check_parts(posed) + check_ball(posed) + self.check_tree(posed)
    }

    /// Checks that queries at a vertex find the triangles around it, so that the hierarchy rules none of them out.
    fn check_tree(&self, posed: &Posed<'_>) -> usize {
        let space = posed.surface.in_model();
        let touching = CastOptions::STILL.with_tolerance(0.0);
        let mut hits = Vec::new();
        for (vertex, triangles) in &self.around {
            let p = posed.positions[*vertex];
            let Some(point) = Capsule::ball(p, 0.0) else {
                panic!("no ball at {p}");
            };
            space.overlap_capsule(&point, &mut hits);
            for triangle in triangles {
                let found = hits.iter().any(|hit| hit.triangle.0 == *triangle);
                assert!(
                    found,
                    "the overlap at corner {p} misses triangle {triangle}"
                );
            }
            let nearest = space.closest_point(p, 0.0);
            assert!(nearest.is_some(), "no closest point at vertex {p}");
            let cast = space.cast_capsule(&point, [Vec3::ZERO; 2], &touching);
            assert!(cast.is_some(), "no contact of a cast at vertex {p}");
        }
        self.around.len() * 3
    }
}

/// Checks the sphere of every part.
fn check_parts(posed: &Posed<'_>) -> usize {
    let parts = posed.surface.mesh().parts();
    let mut bounded = vec![false; parts.len()];
    let mut checked = 0;
    for (id, sphere) in posed.surface.in_model().part_spheres() {
        let vertices = &parts[id.index()].vertices;
        for vertex in vertices {
            let p = posed.positions[vertex.index()];
            let held = sphere.contains(p);
            assert!(
                held,
                "vertex {vertex} at {p} is outside {sphere:?} of part {id}"
            );
        }
        let twice = std::mem::replace(&mut bounded[id.index()], true);
        assert!(!twice, "part {id} has two spheres");
        checked += vertices.len();
    }
    for (index, bounded) in bounded.into_iter().enumerate() {
        let has_sphere = bounded || parts[index].triangles.is_empty();
        assert!(has_sphere, "part {index} has no sphere");
    }
    checked
}

/// Checks the world-space ball around all skin at both ends of the tick.
fn check_ball(posed: &Posed<'_>) -> usize {
    let Some((center, radius)) = posed.surface.bounding_ball() else {
        panic!("the surface has no bounding ball");
    };
    let place = posed.surface.world_from_model();
    let both = posed.positions.iter().chain(&posed.previous);
    for p in both {
        let away = place.transform_point_f32(*p).distance(center);
        assert!(
            away <= radius,
            "{p} is {away} from {center}, more than {radius}"
        );
    }
    posed.positions.len() * 2
}
