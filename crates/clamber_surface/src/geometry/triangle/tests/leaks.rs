//! Rays from inside a closed mesh, aimed at its edges and vertices: each of them must hit, since the mesh is closed.

use core::f32::consts::PI;

use super::*;

/// Number of columns of the sphere, around Y.
const COLUMNS: usize = 200;

/// Number of rows of the sphere, from pole to pole.
const ROWS: usize = 100;

/// A closed mesh by index, and the triangles at each vertex.
struct Mesh {
    positions: Vec<Vec3>,
    triangles: Vec<[usize; 3]>,
    around: Vec<Vec<usize>>,
}

/// A sphere of 200 columns by 100 rows around `centre`, with bumps of the given height. They are so gentle that every
/// triangle is seen from its back from near the centre.
fn sphere(bumps: f32, centre: Vec3) -> Mesh {
    let mut positions = vec![centre + Vec3::Y, centre - Vec3::Y];
    for row in 1..ROWS {
        let polar = PI * row as f32 / ROWS as f32;
        for column in 0..COLUMNS {
            let azimuth = 2.0 * PI * column as f32 / COLUMNS as f32;
            let radius = 1.0 + bumps * libm::sinf(4.0 * polar) * libm::sinf(5.0 * azimuth);
            let ring = libm::sinf(polar) * radius;
            let (x, z) = (ring * libm::cosf(azimuth), ring * libm::sinf(azimuth));
            positions.push(centre + Vec3::new(x, libm::cosf(polar) * radius, z));
        }
    }
    let at = |row: usize, column: usize| 2 + (row - 1) * COLUMNS + column % COLUMNS;
    let mut triangles = Vec::new();
    for column in 0..COLUMNS {
        triangles.push([0, at(1, column + 1), at(1, column)]);
        triangles.push([1, at(ROWS - 1, column), at(ROWS - 1, column + 1)]);
        for row in 1..ROWS - 1 {
            let (a, b) = (at(row, column), at(row, column + 1));
            let (c, d) = (at(row + 1, column), at(row + 1, column + 1));
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
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
        let origin = centre + random_point(&mut rng) * 0.15;
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
