use glam::{DVec3, Vec3};
use parry3d::bounding_volume::Aabb;
use parry3d::math::Pose;
use parry3d::partitioning::{Bvh, TraversalAction};
use parry3d::shape::{HeightField, Shape, TypedShape};

use super::convex::Convex;
use crate::RigidPose;

/// A part of a shape.
pub(super) enum Part<'a> {
    Triangle([Vec3; 3]),
    Convex(Convex<'a>),
    /// All points whose dot product with this unit vector is not positive.
    HalfSpace(DVec3),
    /// A shape in a local space of its own, placed by a pose.
    Posed(RigidPose, &'a dyn Shape),
}

/// Calls `visit` with the parts of a shape, except those whose bounding boxes `reaches` rejects. `reaches` is called
/// anew for each box and may become stricter during the visit. The box that `bounds` returns meets every box that
/// `reaches` accepts. Neither is called for a convex shape.
pub(super) fn visit_parts(
    shape: &dyn Shape,
    bounds: &dyn Fn() -> Aabb,
    reaches: &dyn Fn(&Aabb) -> bool,
    visit: &mut dyn FnMut(Part<'_>),
) {
    match shape.as_typed_shape() {
        TypedShape::TriMesh(mesh) => visit_leaves(mesh.bvh(), reaches, &mut |id| {
            visit(Part::Triangle(corners(&mesh.triangle(id))));
        }),
        TypedShape::HeightField(field) => visit_field(field, &bounds(), reaches, visit),
        TypedShape::Triangle(triangle) => visit(Part::Triangle(corners(triangle))),
        TypedShape::Polyline(line) => visit_leaves(line.bvh(), reaches, &mut |id| {
            let segment = line.segment(id);
            visit(Part::Convex(Convex::segment(segment.a, segment.b, 0.0)));
        }),
        TypedShape::Compound(compound) => visit_leaves(compound.bvh(), reaches, &mut |id| {
            if let Some((pose, part)) = compound.shapes().get(id as usize) {
                let pose = RigidPose::new(pose.rotation, pose.translation);
                visit(Part::Posed(pose, &**part));
            }
        }),
        TypedShape::Voxels(voxels) => {
            let half = voxels.voxel_size().as_dvec3() * 0.5;
            let near = bounds().intersection(&voxels.compute_local_aabb());
            let near = near.into_iter();
            for voxel in near.flat_map(|near| voxels.voxels_intersecting_local_aabb(&near)) {
                if !voxel.state.is_empty() && reaches(&voxels.voxel_aabb(voxel.grid_coords)) {
                    let center = voxel.center.as_dvec3();
                    visit(Part::Convex(Convex::cuboid(center, half, 0.0)));
                }
            }
        }
        TypedShape::HalfSpace(half) => visit(Part::HalfSpace(half.normal.as_dvec3())),
        _ => {
            if let Some(convex) = Convex::new(shape) {
                visit(Part::Convex(convex));
            } else if let Some(composite) = shape.as_composite_shape() {
                visit_leaves(composite.bvh(), reaches, &mut |id| {
                    composite.map_part_at(id, &mut |pose, part, _| {
                        // As in parry, parts have no parts: a shape that is its own part would never end.
                        if part.as_composite_shape().is_some() {
                            return;
                        }
                        let pose = pose.copied().unwrap_or(Pose::IDENTITY);
                        let pose = RigidPose::new(pose.rotation, pose.translation);
                        visit(Part::Posed(pose, part));
                    });
                });
            }
        }
    }
}

fn corners(triangle: &parry3d::shape::Triangle) -> [Vec3; 3] {
    [triangle.a, triangle.b, triangle.c]
}

fn visit_leaves(bvh: &Bvh, reaches: &dyn Fn(&Aabb) -> bool, visit: &mut dyn FnMut(u32)) {
    bvh.traverse(|node| {
        if !reaches(&node.aabb()) {
            return TraversalAction::Prune;
        }
        if let Some(id) = node.leaf_data() {
            visit(id);
        }
        TraversalAction::Continue
    });
}

fn visit_field(
    field: &HeightField,
    bounds: &Aabb,
    reaches: &dyn Fn(&Aabb) -> bool,
    visit: &mut dyn FnMut(Part<'_>),
) {
    field.map_elements_in_local_aabb(bounds, &mut |_, triangle| {
        if reaches(&triangle.compute_local_aabb()) {
            visit(Part::Triangle(corners(triangle)));
        }
    });
}
