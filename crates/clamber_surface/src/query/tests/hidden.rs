//! Hidden triangles must not narrow the search for visible ones.

use super::places::{Place, assert_agree};
use crate::measure::BruteForce;
use crate::mesh::{ColliderMesh, TriangleId, VertexId};
use crate::surface::SkinnedSurface;
use crate::testing::{advance, ball, bend, direction, tube};

fn around(mesh: &ColliderMesh, vertex: VertexId) -> Vec<TriangleId> {
    let triangles = mesh.triangles().iter().enumerate();
    let around = triangles.filter(|(_, corners)| corners.contains(&vertex));
    around.map(|(id, _)| TriangleId(id as u32)).collect()
}

/// Hides the triangles around each vertex in turn, and queries from near that vertex.
fn check(mut hide: impl FnMut(&mut SkinnedSurface, TriangleId)) {
    let mesh = tube(4, 12);
    let mut rng = fastrand::Rng::with_seed(81);
    let mut posed = SkinnedSurface::new(mesh.clone());
    advance(&mut posed, &bend(4, glam::DVec3::Z, 0.3));
    for vertex in (0..mesh.positions().len() as u32).map(VertexId) {
        let mut surface = posed.clone();
        for triangle in around(&mesh, vertex) {
            hide(&mut surface, triangle);
        }
        let brute_force = BruteForce::new(surface.in_model());
        for reach in [0.05, 0.3, f32::INFINITY] {
            let place = Place {
                origin: brute_force.positions()[vertex.index()] + direction(&mut rng) * 0.01,
                towards: direction(&mut rng),
                reach,
            };
            assert_agree(&surface, &brute_force, place, &format!("vertex {vertex}"));
        }
    }
}

#[test]
fn a_vertex_of_disabled_triangles_alone_hides_no_enabled_triangle() {
    check(|surface, triangle| surface.disable_triangle(triangle).unwrap());
}

#[test]
fn a_vertex_of_removed_triangles_alone_hides_no_remaining_triangle() {
    check(|surface, triangle| {
        surface.edit(|edit| edit.remove_triangle(triangle)).unwrap();
    });
}

#[test]
fn a_hidden_triangle_is_hidden_until_it_is_shown_again() {
    // Also if it is hidden or shown twice in a row: flags and count agree.
    let mesh = tube(4, 12);
    let mut rng = fastrand::Rng::with_seed(82);
    let mut surface = SkinnedSurface::new(mesh.clone());
    let mut shown = vec![true; mesh.triangles().len()];
    for round in 0..400 {
        let id = TriangleId(rng.u32(0..shown.len() as u32));
        for _ in 0..rng.usize(1..3) {
            shown[id.index()] = rng.u32(0..3) == 0 || round > 300;
            if shown[id.index()] {
                surface.enable_triangle(id).unwrap();
            } else {
                surface.disable_triangle(id).unwrap();
            }
        }
        let hidden = shown.iter().filter(|shown| !**shown).count();
        assert_eq!(surface.instance.hidden_triangles, hidden, "round {round}");
        let corners = surface.instance.corners(id);
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let mut hits = Vec::new();
        let around = ball(middle, 1e-4);
        surface.in_model().overlap_capsule(&around, &mut hits);
        let found = hits.iter().any(|hit| hit.triangle == id);
        assert_eq!(found, shown[id.index()], "round {round}, {id}");
    }
}
