//! One order of hits along a ray: by exact distance, then by triangle id, both for the first hit alone and for all
//! hits.

use std::sync::Arc;

use clamber_verify::agreement::Question;
use glam::Vec3;

use crate::geometry::Ray;
use crate::geometry::triangle::ShearedRay;
use crate::measure::BruteForce;
use crate::mesh::{ColliderBuildOptions, ColliderMesh, MeshSource, TriangleId};
use crate::surface::SkinnedSurface;
use crate::surface::agreement::assert_same_answers;
use crate::testing::{direction, point, separate};

/// Triangles of one joint at rest.
fn still(positions: &[Vec3], triangles: &[[u32; 3]]) -> Option<SkinnedSurface> {
    let source = MeshSource::rigid(positions, triangles);
    let (mesh, _) = ColliderMesh::build(&source, &ColliderBuildOptions::default()).ok()?;
    Some(SkinnedSurface::new(Arc::new(mesh)))
}

/// Number of rays that met something, and of those whose two nearest triangles are at distances that are equal in f32.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    met: usize,
    tied: usize,
}

/// Compares `cast_ray` and `cast_ray_all` with brute force, the first with the first of all, and the order of all hits
/// with the exact distances.
fn assert_one_order(surface: &SkinnedSurface, ray: &Ray, count: &mut Count) {
    let (origin, direction, max_distance) = (ray.origin(), ray.direction(), f32::INFINITY);
    let brute_force = BruteForce::new(surface.in_model());
    let questions = Question::along_ray(origin, direction, max_distance);
    assert_same_answers(surface, &brute_force, &questions);
    let mut all = Vec::new();
    surface.in_model().cast_ray_all(ray, max_distance, &mut all);
    let first = surface.in_model().cast_ray(ray, max_distance);
    assert_eq!(first.as_ref(), all.first(), "{ray:?}");

    let sheared = ShearedRay::new(ray);
    let distance = |triangle: TriangleId| {
        let found = sheared.intersect(surface.instance.corners(triangle), f64::INFINITY);
        found.unwrap().distance
    };
    for pair in all.windows(2) {
        let [a, b] = [pair[0].triangle, pair[1].triangle];
        let [near, far] = [a, b].map(distance);
        assert!(
            near < far || near == far && a < b,
            "{near} {far}: {ray:?}, {all:#?}"
        );
    }
    count.met += usize::from(!all.is_empty());
    count.tied += usize::from(all.len() > 1 && all[0].distance as f32 == all[1].distance as f32);
}

#[test]
fn the_nearer_triangle_is_first_even_if_f32_cannot_tell_the_distances_apart() {
    let z = -(1.0 + f32::EPSILON);
    let positions = [
        Vec3::new(-1.0, -0.1, -1.0),
        Vec3::new(1.0, -0.1, -1.0),
        Vec3::new(0.0, 0.9, z),
        Vec3::new(-1.0, -1.0, -1.0),
        Vec3::new(1.0, -1.0, -1.0),
        Vec3::new(0.0, 1.0, -1.0),
    ];
    let surface = still(&positions, &[[0, 1, 2], [3, 4, 5]]).unwrap();
    let ray = Ray::new(Vec3::ZERO, -Vec3::Z).unwrap();
    let hit = surface.in_model().cast_ray(&ray, 10.0).unwrap();
    assert_eq!(hit.triangle, TriangleId(1));
    assert_one_order(&surface, &ray, &mut Count::default());
}

#[test]
fn at_distance_zero_the_smaller_id_is_first_whatever_the_sign_of_zero() {
    // The ray starts at a corner of all triangles. Weights of -0 give some of them the distance -0.
    let mut count = Count::default();
    for axis in [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z] {
        let (u, v) = axis.any_orthonormal_pair();
        let rim = [u, v, -u, -v].map(|corner| corner + axis * 0.25);
        let positions: Vec<Vec3> = [Vec3::ZERO].into_iter().chain(rim).collect();
        let surface = still(&positions, &[[0, 1, 2], [3, 0, 2], [3, 4, 0], [0, 4, 1]]).unwrap();
        for towards in [axis, u, axis + u * 0.5, axis - v * 0.25, -axis - u * 0.75] {
            let ray = Ray::new(Vec3::ZERO, towards).unwrap();
            assert_one_order(&surface, &ray, &mut count);
        }
    }
    assert_eq!([count.met, count.tied], [30, 30]);
}

/// A fan of triangles around a vertex, with heights up to `flatness`: shared edges, and one shared corner.
fn fan(rng: &mut fastrand::Rng, flatness: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let sides = rng.u32(3..9);
    let mut positions = vec![point(rng, flatness)];
    for side in 0..sides {
        let angle = (side as f32 + rng.f32() * 0.5) / sides as f32 * core::f32::consts::TAU;
        let rim = Vec3::new(libm::cosf(angle), libm::sinf(angle), 0.0);
        positions.push(rim + Vec3::Z * point(rng, flatness).z);
    }
    let mut triangles: Vec<[u32; 3]> = (0..sides)
        .map(|side| [0, 1 + side, 1 + (side + 1) % sides])
        .collect();
    rng.shuffle(&mut triangles);
    (positions, triangles)
}

/// Large triangles in one plane, or a few units in the last place beside it, all of them across its middle. A ray that
/// meets one meets nearly all, at distances that f32 cannot tell apart.
fn stack(rng: &mut fastrand::Rng, tilt: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let count = rng.u32(2..12);
    let [u, v] = [Vec3::X, Vec3::Y].map(|axis| axis + Vec3::Z * point(rng, tilt).z);
    let mut positions = Vec::new();
    for _ in 0..count {
        let first = rng.f32() * core::f32::consts::TAU;
        for corner in 0..3 {
            let angle = first + (corner as f32 + rng.f32() * 0.3) / 3.0 * core::f32::consts::TAU;
            let place = u * libm::cosf(angle) + v * libm::sinf(angle);
            let ulps = rng.i32(-2..3) as f32 * f32::EPSILON;
            positions.push(place * (1.0 + rng.f32()) + Vec3::Z * ulps);
        }
    }
    (positions, separate(count))
}

#[test]
fn shared_edges_coplanar_duplicates_and_grazing_rays_keep_one_order() {
    let mut rng = fastrand::Rng::with_seed(75);
    let mut count = Count::default();
    for _ in 0..1_500 {
        let size = [1e-3, 1.0, 1.0, 1e3][rng.usize(0..4)];
        let flatness = [0.0, f32::EPSILON, 1e-3, 0.5][rng.usize(0..4)];
        let (mut positions, mut triangles) = match rng.bool() {
            true => fan(&mut rng, flatness),
            false => stack(&mut rng, flatness),
        };
        let away = [0.0, 1.0, 100.0][rng.usize(0..3)];
        let offset = point(&mut rng, away);
        positions.iter_mut().for_each(|p| *p = (*p + offset) * size);
        if rng.bool() {
            // The same triangles again, with their own corners and reversed.
            let first = positions.len() as u32;
            positions.extend_from_within(..);
            triangles.extend_from_within(..);
            let half = triangles.len() / 2;
            for triangle in &mut triangles[half..] {
                *triangle = triangle.map(|corner| corner + first);
                triangle.reverse();
            }
        }
        let Some(surface) = still(&positions, &triangles) else {
            continue;
        };
        for _ in 0..12 {
            let triangles = surface.mesh().triangles().len() as u32;
            let [a, b, c] = surface.instance.corners(TriangleId(rng.u32(0..triangles)));
            let target = match rng.u32(0..4) {
                0 => a,
                1 => a + (b - a) * 0.5,
                2 => b + (c - b) * rng.f32(),
                _ => (a + b + c) / 3.0,
            };
            let towards = match rng.u32(0..4) {
                0 => Vec3::NEG_Z,
                1 => direction(&mut rng),
                // Nearly along the triangle.
                2 => (b - a).normalize_or(Vec3::X) + Vec3::Z * point(&mut rng, 1e-5).z,
                _ => (c - a) + (b - a),
            };
            let distance = [0.0, 1.0, 3.0, 50.0][rng.usize(0..4)] * size;
            if let Some(ray) = Ray::new(target - towards.normalize_or(Vec3::Z) * distance, towards)
            {
                assert_one_order(&surface, &ray, &mut count);
            }
        }
    }
    assert!(count.met > 10_000 && count.tied > 5_000, "{count:?}");
}
