use glam::{DVec3, Vec3};
use parry3d::math::Pose;
use parry3d::query::{PointQuery, Ray as ParryRay, RayCast};
use parry3d::shape::{FeatureId, TriMesh};

use super::PosedSurface;
use crate::geometry::{Ray, Similarity};
use crate::surface::SkinnedSurface;
use crate::testing::{bend, direction, point, tube};

fn bent() -> SkinnedSurface {
    let mut surface = SkinnedSurface::new(tube(6, 12));
    surface
        .advance(&bend(6, DVec3::Z, 0.3), Similarity::IDENTITY)
        .unwrap();
    surface
}

fn eager(surface: &SkinnedSurface) -> TriMesh {
    let mut positions = Vec::new();
    surface.skin_all(&mut positions);
    let triangles = surface.mesh().triangles().iter();
    let triangles = triangles.map(|corners| corners.map(|v| v.0)).collect();
    TriMesh::new(positions, triangles).unwrap()
}

#[test]
fn rays_meet_what_the_surface_says_in_units_of_their_direction() {
    let surface = bent();
    let (posed, mesh) = (PosedSurface(&surface), eager(&surface));
    let mut rng = fastrand::Rng::with_seed(8);
    let mut hits = 0;
    for _ in 0..10_000 {
        let origin = point(&mut rng, 4.0);
        let dir = direction(&mut rng) * (0.1 + rng.f32() * 5.0);
        let ray = ParryRay::new(origin, dir);
        let limit = rng.f32() * 3.0;
        let own = Ray::new(origin, dir).unwrap();
        let wanted = surface.cast_ray(&own, limit * dir.length()).unwrap();
        let found = posed.cast_local_ray_and_get_normal(&ray, limit, true);
        assert_eq!(found.is_some(), wanted.is_some(), "{ray:?} {limit}");
        assert_eq!(posed.intersects_local_ray(&ray, limit), found.is_some());
        let theirs = mesh.cast_local_ray_and_get_normal(&ray, limit, true);
        let (Some(found), Some(wanted)) = (found, wanted) else {
            continue;
        };
        hits += 1;
        let off = (found.time_of_impact * dir.length() - wanted.distance).abs();
        assert!(off <= 1e-6 * (1.0 + wanted.distance), "{ray:?}: {off}");
        assert_eq!(found.subshape, wanted.triangle.0);
        assert!(found.normal.dot(dir) <= 0.0, "{ray:?}: {found:?}");
        // parry's own mesh says the same, but where two triangles are met as one.
        let theirs = theirs.unwrap();
        let off = (found.time_of_impact - theirs.time_of_impact).abs();
        assert!(off < 1e-4, "{ray:?}: {found:?} {theirs:?}");
        if found.subshape == theirs.subshape {
            assert_eq!(found.feature, theirs.feature, "{ray:?}");
            assert!((found.normal - theirs.normal).length() < 1e-3, "{ray:?}");
        }
    }
    assert!(hits > 100, "{hits}");
}

#[test]
fn points_are_projected_to_where_the_surface_says_and_are_never_inside() {
    let surface = bent();
    let posed = PosedSurface(&surface);
    let mut rng = fastrand::Rng::with_seed(9);
    let mut inside = 0;
    for _ in 0..1000 {
        let p = point(&mut rng, 3.0);
        let wanted = surface.closest_point(p, f32::INFINITY).unwrap().unwrap();
        for solid in [true, false] {
            let found = posed.project_local_point(p, solid);
            assert_eq!((found.point, found.is_inside), (wanted.point, false), "{p}");
            assert_eq!(found.subshape, wanted.triangle.0, "{p}");
        }
        let (_, feature) = posed.project_local_point_and_get_feature(p);
        let behind = wanted.normal.dot(p - wanted.point) < 0.0;
        inside += u32::from(behind);
        assert_eq!(feature, FeatureId::Face(behind.into()), "{p}");
        let near = posed.project_local_point_with_max_dist(p, true, wanted.distance * 0.9);
        assert!(near.is_none(), "{p}");
        let off = posed.distance_to_local_point(p, true) - wanted.distance;
        assert!(off.abs() < 1e-5, "{p}: {off}");
        let pose = Pose::from_translation(Vec3::new(0.0, 5.0, 0.0));
        let moved = posed.project_point(&pose, p + Vec3::Y * 5.0, true);
        assert!(
            (moved.point - Vec3::Y * 5.0 - wanted.point).length() < 1e-4,
            "{p}"
        );
    }
    assert!(inside > 5, "{inside}");
}

#[test]
fn nonsense_meets_nothing() {
    let surface = bent();
    let posed = PosedSurface(&surface);
    let (nan, zero) = (Vec3::splat(f32::NAN), Vec3::ZERO);
    for (origin, dir, limit) in [
        (nan, Vec3::X, 1.0),
        (zero, nan, 1.0),
        (zero, zero, 1.0),
        (zero, Vec3::X, f32::NAN),
        (zero, Vec3::X, -1.0),
    ] {
        let ray = ParryRay::new(origin, dir);
        assert!(posed.cast_local_ray(&ray, limit, true).is_none(), "{ray:?}");
        assert!(!posed.intersects_local_ray(&ray, limit), "{ray:?}");
    }
    assert!(posed.project_local_point(nan, true).point.is_nan());
    assert!(
        posed
            .project_local_point_with_max_dist(zero, true, -1.0)
            .is_none()
    );
    let (_, feature) = posed.project_local_point_and_get_feature(nan);
    assert_eq!(feature, FeatureId::Unknown);
}
