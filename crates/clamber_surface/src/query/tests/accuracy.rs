//! Closest points on the whole surface, compared with all triangles by another method.

use clamber_verify::brute_force::distance;
use glam::{DVec3, Vec3};

use crate::geometry::widen;
use crate::mesh::MeshSource;
use crate::surface::SkinnedSurface;
use crate::testing::{built, direction, point, positions_of, separate};

/// Slivers of length 1 and height `height` around `center`, each with its own three vertices.
fn slivers(rng: &mut fastrand::Rng, height: f32, center: Vec3) -> SkinnedSurface {
    let mut positions = Vec::new();
    for _ in 0..400 {
        let first = center + point(rng, 3.0);
        let along = direction(rng);
        positions.push(first);
        positions.push(first + along);
        positions.push(first + along * rng.f32() + direction(rng) * height);
    }
    SkinnedSurface::new(built(&MeshSource::rigid(&positions, &separate(400))).into())
}

#[test]
fn closest_points_agree_with_brute_force_on_slivers_and_far_out() {
    let mut rng = fastrand::Rng::with_seed(92);
    let mut worst = 0.0f64;
    for height in [1e-1, 1e-3, 1e-5, 1e-7] {
        for center in [Vec3::ZERO, Vec3::new(1000.0, -600.0, 500.0)] {
            let surface = slivers(&mut rng, height, center);
            let positions = positions_of(&surface);
            for _ in 0..300 {
                let away = [0.01, 1.0, 10.0][rng.usize(0..3)];
                let near = positions[rng.usize(0..positions.len())];
                let place = near + point(&mut rng, away);
                let space = surface.in_model();
                let hit = space.closest_point(place, f32::INFINITY).unwrap();
                let local = |id: usize| {
                    let corners = surface.mesh().triangles()[id];
                    corners.map(|v| widen(positions[v.index()]) - widen(place))
                };
                let all = 0..surface.mesh().triangles().len();
                let wanted = all
                    .map(|id| distance(DVec3::ZERO, &local(id)))
                    .fold(f64::INFINITY, f64::min);
                // The distance of the material point that the hit names, not of its rounded position.
                let corners = local(hit.triangle.index());
                let [u, v, w] = hit.barycentric.map(f64::from);
                let met = (corners[0] * u + corners[1] * v + corners[2] * w).length();
                for found in [hit.distance, met] {
                    // As a share of the longest edge and the distance.
                    let share = (found - wanted).abs() / (1.0 + wanted);
                    assert!(share <= 2e-7, "height {height}, {place}: {share} {hit:?}");
                    worst = worst.max(share);
                }
            }
        }
    }
    println!("worst error {worst:e} of edge and distance");
}
