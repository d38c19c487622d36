use glam::DVec3;
use parry3d::shape::{Shape, TypedShape};

use super::overlap_shape;
use crate::WorldCapsule;

/// A material point farther than this from its shape is gone, metres: the shape was replaced. More than the rounding of
/// f32 poses at 1 km, less than any change of shape that a player would see.
const GONE: f64 = 1e-3;

/// True if a point in a shape's local space is inside the shape, on it, or within 1 mm of it: a material point there
/// still exists. For triangle meshes and height fields only the triangles count, not the volume that they enclose.
pub fn holds(shape: &dyn Shape, point: DVec3) -> bool {
    match shape.as_typed_shape() {
        // Fast paths for the most common shapes.
        TypedShape::Ball(ball) => point.length() <= f64::from(ball.radius) + GONE,
        TypedShape::Cuboid(cuboid) => {
            let beyond = point.abs() - cuboid.half_extents.as_dvec3();
            beyond.max_element() <= GONE
        }
        TypedShape::Capsule(capsule) => {
            let ends = [capsule.segment.a, capsule.segment.b].map(|end| end.as_dvec3());
            let radius = f64::from(capsule.radius);
            let capsule = WorldCapsule { ends, radius };
            capsule.nearest_on_axis(point).distance(point) <= radius + GONE
        }
        _ => overlaps(shape, point),
    }
}

fn overlaps(shape: &dyn Shape, point: DVec3) -> bool {
    let mut overlaps = false;
    overlap_shape(shape, [point; 2], GONE, &mut |_| overlaps = true);
    overlaps
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use parry3d::shape::{Ball, Capsule, Cuboid};

    use super::*;

    #[test]
    fn fast_paths_agree_with_the_overlap_test() {
        let mut rng = fastrand::Rng::with_seed(5);
        let shapes: [&dyn Shape; 3] = [
            &Ball::new(0.7),
            &Cuboid::new(Vec3::new(0.3, 0.7, 0.5)),
            &Capsule::new_x(0.4, 0.3),
        ];
        for shape in shapes {
            let (mut on, mut off) = (0, 0);
            for _ in 0..20_000 {
                let mut share = || 2.0 * rng.f64() - 1.0;
                let far = DVec3::new(share(), share(), share());
                // For half of the points, within two tolerances of the surface.
                let face = shape.project_local_point(far.as_vec3(), false);
                let near = face.point.as_dvec3();
                let local = [far, near + far.normalize() * (share() * 2.0 * GONE)][rng.usize(0..2)];
                let expected = overlaps(shape, local);
                let away = shape.distance_to_local_point(local.as_vec3(), true);
                if (0.9 * GONE..1.9 * GONE).contains(&f64::from(away)) {
                    // Beside a corner, the box test accepts points slightly farther away.
                    continue;
                }
                let told = format!("{:?} at {local}", shape.shape_type());
                assert_eq!(holds(shape, local), expected, "{told}");
                on += u32::from(expected);
                off += u32::from(!expected);
            }
            assert!(on > 1_000 && off > 1_000, "{on} {off}");
        }
    }
}
