use glam::{DVec3, Vec3};
use parry3d::bounding_volume::Aabb;
use parry3d::query::PointQuery;
use parry3d::shape::TriMeshFlags;

use super::SurfacePatch;
use crate::geometry::Similarity;
use crate::surface::{PatchChange, SkinnedSurface};
use crate::testing::{bend, tube};

#[test]
fn the_mesh_follows_the_skin_whether_moved_or_made_anew() {
    let mut surface = SkinnedSurface::new(tube(6, 12));
    let mut patch = SurfacePatch::default();
    let mut changes = [0; 2];
    for tick in 0..60 {
        let angle = f64::from(tick) * 0.005;
        surface
            .advance(&bend(6, DVec3::Z, angle), Similarity::IDENTITY)
            .unwrap();
        let center = Vec3::new(1.0 + tick as f32 * 0.01, 0.5, 0.0);
        let near = Aabb::new(center - 0.3, center + 0.3);
        let change = patch.update(&surface, &near, 0.1).unwrap();
        changes[usize::from(change == PatchChange::Rebuilt)] += 1;
        let mesh = patch.mesh().unwrap();
        assert!(mesh.flags().contains(TriMeshFlags::DEFORMABLE));
        assert_eq!(mesh.vertices(), patch.patch().positions(), "{tick}");
        assert_eq!(mesh.indices(), patch.patch().indices(), "{tick}");
        // The tree was refitted: what is nearest in the patch is nearest on the skin.
        let wanted = surface.closest_point(center, 0.3).unwrap().unwrap();
        let found = mesh.project_local_point(center, true);
        let off = (found.point.distance(center) - wanted.distance).abs();
        assert!(off < 1e-5, "{tick}: {found:?} {wanted:?}");
    }
    assert!(changes.iter().all(|count| *count > 3), "{changes:?}");
}

#[test]
fn away_from_the_skin_there_is_no_mesh() {
    let surface = SkinnedSurface::new(tube(4, 8));
    let mut patch = SurfacePatch::default();
    let on = Aabb::new(Vec3::splat(-1.0), Vec3::ONE);
    patch.update(&surface, &on, 0.0).unwrap();
    assert!(patch.mesh().is_some());
    let off = Aabb::new(Vec3::splat(20.0), Vec3::splat(21.0));
    patch.update(&surface, &off, 0.0).unwrap();
    assert!(patch.mesh().is_none());
}
