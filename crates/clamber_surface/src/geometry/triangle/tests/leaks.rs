//! Rays from inside a closed mesh, aimed at its edges and vertices: each of them must hit, since the mesh is closed.

use super::*;

/// A closed mesh by index, and the triangles at each vertex.
struct Mesh {
    positions: Vec<Vec3>,
    triangles: Vec<[usize; 3]>,
    around: Vec<Vec<usize>>,
}

/// A sphere around `centre`, with bumps of the given height. They are so gentle that every
/// triangle is seen from its back from near the centre.
fn sphere(bumps: f32, centre: Vec3) -> Mesh {
    let (positions, triangles) = crate::testing::sphere(|polar, azimuth| {
        1.0 + bumps * libm::sinf(4.0 * polar) * libm::sinf(5.0 * azimuth)
    });
    let positions: Vec<Vec3> = positions.into_iter().map(|p| centre + p).collect();
    let triangles = triangles.into_iter().map(|t| t.map(|v| v as usize));
    let triangles: Vec<[usize; 3]> = triangles.collect();
    let mut around = vec![Vec::new(); positions.len()];
    for (id, corners) in triangles.iter().enumerate() {
        for corner in corners {
            around[*corner].push(id);
        }
    }
    Mesh {
        positions,
        triangles,
        around,
    }
}

/// The number of rays that meet no triangle around their target, out of `rays` rays at points of edges or at vertices.
fn leaks(mesh: &Mesh, centre: Vec3, rays: u32, at_vertices: bool) -> u32 {
    let mut rng = fastrand::Rng::with_seed(60);
    let mut leaks = 0;
    for _ in 0..rays {
        let corners = mesh.triangles[rng.usize(0..mesh.triangles.len())];
        let side = rng.usize(0..3);
        let (a, b) = (corners[side], corners[(side + 1) % 3]);
        let along = if at_vertices { 0.0 } else { rng.f32() };
        let target = mesh.positions[a] + (mesh.positions[b] - mesh.positions[a]) * along;
        let origin = centre + point(&mut rng, 1.0) * 0.15;
        let ray = ShearedRay::new(&Ray::new(origin, target - origin).unwrap());
        let met = mesh.around[a].iter().chain(&mesh.around[b]).any(|id| {
            let corners = mesh.triangles[*id].map(|v| mesh.positions[v]);
            ray.intersect(corners, f64::INFINITY).is_some()
        });
        leaks += u32::from(!met);
    }
    leaks
}

fn assert_watertight(rays: u32) {
    for centre in [Vec3::ZERO, Vec3::new(1000.0, -1000.0, 1000.0)] {
        for bumps in [0.0, 0.05] {
            let mesh = sphere(bumps, centre);
            for at_vertices in [false, true] {
                let leaks = leaks(&mesh, centre, rays, at_vertices);
                assert_eq!(
                    leaks, 0,
                    "around {centre}, bumps {bumps}, vertices {at_vertices}"
                );
            }
        }
    }
}

#[test]
fn no_ray_at_an_edge_or_a_vertex_leaks() {
    assert_watertight(100_000);
}

#[test]
#[ignore = "a million rays per case: run it in release"]
fn no_ray_of_a_million_leaks() {
    assert_watertight(1_000_000);
}
