//! Checks of a surface in its current pose: answers against brute force, skinning against f64, bounds against vertices.

use clamber_surface::geometry::{Affine, Sphere};
use clamber_surface::measure::{BruteForce, error_bound, skin_vertex_reference};
use clamber_surface::mesh::{ColliderMesh, VertexId};
use clamber_surface::surface::SkinnedSurface;
use glam::Vec3;

use crate::agreement::{Agreement, Aims, Comparison, extent};

/// Compares answers with brute force, for one question of every kind and aim. Each question is asked twice: of the
/// surface, which skins only the vertices that the query touches, and of a copy that has all vertices skinned ahead.
pub fn compare_queries(
    surface: &SkinnedSurface,
    rng: &mut fastrand::Rng,
    agreement: &mut Agreement,
) {
    let mut ahead = surface.clone();
    ahead.skin_ahead();
    let brute_force = BruteForce::new(surface.in_model());
    let triangles = brute_force.posed_triangles();
    let (mut questions, mut comparison) = (Vec::new(), Comparison::default());
    Aims::new(&triangles, extent(&triangles), rng).all(&mut questions);
    for question in &questions {
        comparison.ask(&brute_force, question);
        for surface in [surface, &ahead] {
            agreement.count(comparison.hold(&surface.in_model()));
        }
    }
}

/// The largest error of a vertex coordinate against skinning in f64, as a share of its bound. It is infinite if a
/// position is NaN or a bound of 0 is exceeded. `positions` are the mesh's vertices, skinned with `matrices`.
pub fn skinning_error_share(mesh: &ColliderMesh, matrices: &[Affine], positions: &[Vec3]) -> f64 {
    let mut worst = 0.0f64;
    for (index, position) in positions.iter().enumerate() {
        let vertex = VertexId(index as u32);
        let exact = skin_vertex_reference(mesh, matrices, vertex);
        let bound = error_bound(mesh, matrices, vertex);
        if let (Some(exact), Some(bound)) = (exact, bound) {
            let error = (position.as_dvec3() - exact).abs();
            for (error, bound) in error.to_array().into_iter().zip(bound.to_array()) {
                // A bound of zero allows no error at all, and NaN is the worst error.
                let share = if error == 0.0 { 0.0 } else { error / bound };
                worst = worst.max(if share.is_nan() { f64::INFINITY } else { share });
            }
        }
    }
    worst
}

/// Counts the skinned vertices that are outside a sphere of their part. Each part has two spheres: the one that the
/// surface computes from the palette, and the one around the mean of the positions. A vertex outside both counts twice.
pub fn bound_violations(surface: &SkinnedSurface, positions: &[Vec3]) -> usize {
    let parts = surface.mesh().parts();
    let mut outside = 0;
    for (part, sphere) in surface.in_model().part_spheres() {
        let vertices = &parts[part.index()].vertices;
        let skinned = vertices.iter().map(|vertex| positions[vertex.index()]);
        for sphere in [Some(sphere), Sphere::around_mean(skinned.clone())] {
            let Some(sphere) = sphere else { continue };
            outside += skinned.clone().filter(|p| !sphere.contains(*p)).count();
        }
    }
    outside
}
