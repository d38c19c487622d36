//! Bounding spheres of parts, refitted from skinned vertices: the thesis's way (5.2.4).

use glam::Vec3;

use crate::geometry::Sphere;
use crate::mesh::{ColliderMesh, Part};

/// One sphere per part, around the mean of its skinned vertices; `None` for a part that has lost
/// all its triangles. `positions` are the mesh's vertices, skinned. Costs two passes over every
/// vertex of every part.
pub fn refit_part_spheres(
    mesh: &ColliderMesh,
    positions: &[Vec3],
    spheres: &mut Vec<Option<Sphere>>,
) {
    spheres.clear();
    spheres.extend(mesh.parts().iter().map(|part| part_sphere(part, positions)));
}

/// The sphere of one part.
pub(super) fn part_sphere(part: &Part, positions: &[Vec3]) -> Option<Sphere> {
    let vertices = part.vertices.iter();
    Sphere::around_mean(vertices.filter_map(|v| positions.get(v.index()).copied()))
}
