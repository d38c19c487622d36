//! One of rapier's shapes against a sphere, in the shape's own space.

use rapier3d::geometry::{Aabb, Shape, TypedShape};
use rapier3d::math::Vector;
use rapier3d::parry::query::PointQuery;
use rapier3d::parry::shape::Triangle;

/// Where a shape is touched.
pub(super) struct LocalContact {
    pub(super) point: Vector,
    /// Out of the shape.
    pub(super) normal: Vector,
    /// Negative inside a solid.
    pub(super) distance: f32,
}

/// Calls `found` for every triangle of a mesh or height field and every convex part within
/// `radius` of `center`, with its nearest point.
pub(super) fn overlap(
    shape: &dyn Shape,
    center: Vector,
    radius: f32,
    found: &mut dyn FnMut(LocalContact),
) {
    let reach = Aabb::new(
        center - Vector::splat(radius),
        center + Vector::splat(radius),
    );
    let mut triangle = |triangle: &Triangle| {
        let point = triangle.project_local_point(center, false).point;
        let distance = (center - point).length();
        if distance <= radius {
            let normal = triangle.normal().or((center - point).try_normalize());
            found(LocalContact {
                point,
                normal: normal.unwrap_or(Vector::Y),
                distance,
            });
        }
    };
    match shape.as_typed_shape() {
        TypedShape::TriMesh(mesh) => {
            for id in mesh.bvh().intersect_aabb(&reach) {
                triangle(&mesh.triangle(id));
            }
        }
        TypedShape::HeightField(field) => {
            field.map_elements_in_local_aabb(&reach, &mut |_, t| triangle(t));
        }
        TypedShape::Triangle(single) => triangle(single),
        TypedShape::Compound(compound) => {
            for (pose, part) in compound.shapes() {
                let local = pose.inverse_transform_point(center);
                overlap(&**part, local, radius, &mut |contact| {
                    found(LocalContact {
                        point: pose.transform_point(contact.point),
                        normal: pose.transform_vector(contact.normal),
                        ..contact
                    });
                });
            }
        }
        _ => {
            let projection = shape.project_local_point(center, false);
            let between = center - projection.point;
            let apart = between.length();
            if projection.is_inside {
                found(LocalContact {
                    point: projection.point,
                    normal: (-between).try_normalize().unwrap_or(Vector::Y),
                    distance: -apart,
                });
            } else if apart <= radius {
                found(LocalContact {
                    point: projection.point,
                    normal: between.try_normalize().unwrap_or(Vector::Y),
                    distance: apart,
                });
            }
        }
    }
}
