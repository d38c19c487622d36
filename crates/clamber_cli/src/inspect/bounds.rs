//! Checks that bounding spheres hold their skinned vertices.

use clamber_surface::geometry::Sphere;
use clamber_surface::mesh::ColliderMesh;
use clamber_surface::surface::SkinnedSurface;
use glam::Vec3;

/// Counts the skinned vertices that are outside a sphere of their part. Each part has two spheres: the one that the
/// surface computes from the palette, and the one refitted to the positions. A vertex outside both counts twice.
pub(super) fn violations(surface: &SkinnedSurface, positions: &[Vec3]) -> usize {
    let mesh = surface.mesh();
    let mut refitted = Vec::new();
    refit(mesh, positions, &mut refitted);
    let mut outside = 0;
    for (part, sphere) in surface.in_model().part_spheres() {
        let spheres = [Some(sphere), refitted.get(part.index()).copied().flatten()];
        for vertex in &mesh.parts()[part.index()].vertices {
            let position = positions[vertex.index()];
            let spheres = spheres.iter().flatten();
            outside += spheres.filter(|sphere| !sphere.contains(position)).count();
        }
    }
    outside
}

/// Writes a sphere around the mean of each part's skinned vertices, as in the thesis (5.2.4).
pub(super) fn refit(mesh: &ColliderMesh, positions: &[Vec3], spheres: &mut Vec<Option<Sphere>>) {
    spheres.clear();
    spheres.extend(mesh.parts().iter().map(|part| {
        let vertices = part.vertices.iter();
        Sphere::around_mean(vertices.filter_map(|v| positions.get(v.index()).copied()))
    }));
}
