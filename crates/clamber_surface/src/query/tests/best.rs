//! The choice among several triangles, and the data that the search for it leaves untouched.

use glam::Vec3;

use crate::geometry::Ray;
use crate::measure::BruteForce;
use crate::mesh::TriangleId;
use crate::surface::SkinnedSurface;
use crate::testing::{advance, bend, tube};

#[test]
fn the_smaller_id_wins_among_equally_near_triangles() {
    let mesh = tube(5, 24);
    let mut surface = SkinnedSurface::new(mesh.clone());
    for angle in [0.0, 0.3] {
        advance(&mut surface, &bend(5, glam::DVec3::Z, angle));
        let brute_force = BruteForce::new(surface.in_model());
        let (mut all, mut rays) = (Vec::new(), 0);
        for (vertex, p) in brute_force.positions().iter().enumerate() {
            let triangles = mesh.triangles().iter();
            let first = triangles
                .map(|corners| corners.iter().any(|corner| corner.index() == vertex))
                .position(|stands_there| stands_there)
                .map(|id| TriangleId(id as u32));
            let hit = surface.in_model().closest_point(*p, 1.0);
            assert_eq!(hit.map(|hit| hit.triangle), first, "vertex {vertex}");
            let hit = brute_force.closest_point(*p, 1.0);
            assert_eq!(hit.map(|hit| hit.triangle), first, "vertex {vertex}");
            // Along an axis, the vertex has exactly the sheared position of the ray.
            for axis in [Vec3::Y, Vec3::Z] {
                let ray = Ray::new(*p - axis, axis).unwrap();
                surface.in_model().cast_ray_all(&ray, 10.0, &mut all);
                let hit = surface.in_model().cast_ray(&ray, 10.0);
                let at_vertex = hit.is_some_and(|hit| hit.point == *p);
                if at_vertex {
                    assert_eq!(hit, all.first().copied(), "vertex {vertex}, {axis}");
                    let as_near = all.iter().filter(|other| other.distance == all[0].distance);
                    let smallest = as_near.map(|other| other.triangle).min();
                    assert_eq!(hit.map(|hit| hit.triangle), smallest, "vertex {vertex}");
                    rays += 1;
                }
            }
        }
        assert!(rays > 50, "{rays}");
    }
}

#[test]
fn a_ray_touches_few_clusters_behind_its_first_hit() {
    let surface = SkinnedSurface::new(tube(40, 24));
    // Through the end cap, then along the skin from inside.
    let ray = Ray::new(Vec3::new(-1.0, 0.48, 0.01), Vec3::X).unwrap();
    let hit = surface.in_model().cast_ray(&ray, 100.0).unwrap();
    assert!((hit.distance - 1.0).abs() < 1e-5, "{hit:?}");
    let touched = surface.diagnostics();
    assert!(
        touched.clusters_touched * 8 < touched.clusters && touched.triangles_tested < 10,
        "{touched:?}"
    );
}

#[test]
fn a_closest_point_query_touches_few_clusters_beyond_the_nearest_triangle() {
    let surface = SkinnedSurface::new(tube(40, 24));
    let place = Vec3::new(20.1, 0.6, 0.02);
    let hit = surface.in_model().closest_point(place, f32::INFINITY);
    let hit = hit.unwrap();
    assert!((hit.distance - 0.1).abs() < 0.01, "{hit:?}");
    let touched = surface.diagnostics();
    assert!(
        touched.clusters_touched * 8 < touched.clusters && touched.triangles_tested < 64,
        "{touched:?}"
    );
}
