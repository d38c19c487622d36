use glam::Vec3;

use crate::mesh::TriangleId;
use crate::query::ModelSpace;
use crate::skin::skin_checked;

impl ModelSpace<'_> {
    /// The lowest and the highest coordinates of the skin in its current pose, in model space: exact over the corners
    /// of all enabled triangles. `None` if no triangle is enabled.
    ///
    /// Skins every vertex, as [`SkinnedSurface::skin_all`](super::SkinnedSurface::skin_all) does, into newly allocated
    /// memory. [`SkinnedSurface::bounding_ball`](super::SkinnedSurface::bounding_ball) is coarser and costs nothing.
    pub fn extent(&self) -> Option<[Vec3; 2]> {
        let instance = self.instance;
        let mesh = &instance.mesh;
        let mut positions = Vec::new();
        let palette = instance.current.palette();
        skin_checked(mesh, palette, instance.simd_level, &mut positions);
        let triangles = (0..).map(TriangleId).zip(mesh.triangles());
        let seen = triangles.filter(|(triangle, _)| instance.is_enabled(*triangle));
        let corners = seen.flat_map(|(_, corners)| corners);
        let points = corners.map(|vertex| positions[vertex.index()]);
        points.fold(None, |extent, point| {
            let [low, high] = extent.unwrap_or([point; 2]);
            Some([low.min(point), high.max(point)])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Similarity;
    use crate::mesh::PartId;
    use crate::surface::SkinnedSurface;
    use crate::testing::{bend, tube};
    use glam::DVec3;

    /// Sorts each coordinate by itself, over positions that are read one by one.
    fn extent_reference(surface: &SkinnedSurface) -> Option<[Vec3; 2]> {
        let space = surface.in_model();
        let ids = (0..surface.mesh().triangles().len() as u32).map(TriangleId);
        let seen: Vec<Vec3> = ids
            .filter(|triangle| surface.is_enabled(*triangle))
            .flat_map(|triangle| surface.mesh().triangles()[triangle.index()])
            .map(|vertex| space.position(vertex).unwrap())
            .collect();
        let along = |axis: usize| {
            let mut sorted: Vec<f32> = seen.iter().map(|p| p[axis]).collect();
            sorted.sort_by(f32::total_cmp);
            Some([*sorted.first()?, *sorted.last()?])
        };
        let [x, y, z] = [along(0)?, along(1)?, along(2)?];
        Some([0, 1].map(|end| Vec3::new(x[end], y[end], z[end])))
    }

    #[test]
    fn the_extent_is_exact_over_the_enabled_triangles() {
        let mut rng = fastrand::Rng::with_seed(17);
        let mesh = tube(5, 7);
        let mut surface = SkinnedSurface::new(mesh.clone());
        let mut extents = Vec::new();
        for round in 0..40 {
            let axis = crate::testing::direction(&mut rng).as_dvec3().normalize();
            let pose = bend(5, axis, rng.f64() * 1.5);
            surface
                .advance(&pose, Similarity::from_translation(DVec3::X * 9.0))
                .unwrap();
            for triangle in (0..mesh.triangles().len() as u32).map(TriangleId) {
                if rng.u32(0..20) == 0 {
                    surface.disable_triangle(triangle).unwrap();
                }
            }
            let expected = extent_reference(&surface);
            assert_eq!(surface.in_model().extent(), expected, "round {round}");
            extents.push(expected.is_some());
        }
        assert!(extents[0]);
        for part in (0..mesh.part_count() as u32).map(PartId) {
            surface.disable_part(part).unwrap();
        }
        assert_eq!(surface.in_model().extent(), None);
    }
}
