//! Whether a point is inside a mesh, by the solid angle that the mesh covers as seen from the point.
//!
//! It sums over all triangles and uses none of the library's queries, so that tests can judge them by it.

use clamber_surface::measure::{winding_number, winding_of};
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, Vec3};

/// True if the mesh's winding number around `p` is above one half. `positions` are the mesh's vertices, posed or at
/// rest, in the space of `p`.
pub fn is_inside(positions: &[Vec3], mesh: &ColliderMesh, p: DVec3) -> bool {
    winding_number(positions, mesh, p) > 0.5
}

/// [`is_inside`] of the skin that queries see: without hidden triangles. `positions` are all its vertices.
pub fn is_inside_skin(positions: &[Vec3], surface: &SkinnedSurface, p: DVec3) -> bool {
    let all = (0..).map(TriangleId).zip(surface.mesh().triangles());
    let seen = all.filter(|(triangle, _)| surface.is_enabled(*triangle));
    let corners = seen.map(|(_, corners)| corners.map(|vertex| positions[vertex.index()]));
    winding_of(corners, p) > 0.5
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use clamber_animation::joint_in_model;
    use clamber_surface::skin::skin;

    use super::*;
    use crate::giant::giant;

    #[test]
    fn the_trunk_is_inside_and_the_gap_between_the_legs_outside() {
        let giant = giant().unwrap();
        let (skeleton, mesh) = (&giant.rig.skeleton, &giant.rig.collider);
        let rest = skeleton.rest_pose();
        let palette = skeleton.palette(&rest).unwrap();
        let positions = skin(mesh, palette.matrices()).unwrap();
        let surface = SkinnedSurface::new(Arc::clone(mesh));
        let place = |name: &str| {
            let joint = joint_in_model(skeleton, &rest, skeleton.find(name).unwrap());
            joint.unwrap().translation
        };
        let gap = (place("shin.L") + place("shin.R")) * 0.5;
        for (point, inside) in [(place("spine.2"), true), (gap, false)] {
            let found = [
                is_inside(&positions, mesh, point),
                is_inside_skin(&positions, &surface, point),
            ];
            assert_eq!(found, [inside; 2], "{point}");
        }
    }
}
