//! Precomputed bounds, the baseline of the comparison: for each part a sphere and a capsule in the space of its joint,
//! made once, that hold its vertices in every sampled pose. A tick only moves them with the joint. In poses that were
//! not sampled, vertices may be outside.

use clamber::geometry::Sphere;
use clamber::mesh::{ColliderMesh, Part};
use clamber::rig::Palette;
use clamber::skin::skin;
use clamber_scenes::part_bounds::{BoundingCapsule, BoundingVolume};
use glam::{DAffine3, Vec3};

/// Relative margin for the rounding of a vertex of a sampled pose on its way into the joint's space and back.
const MARGIN: f32 = 1e-4;

/// One sphere and capsule per part, in joint space.
#[derive(Default)]
pub(crate) struct Precomputed {
    shapes: Vec<Option<(Sphere, BoundingCapsule)>>,
}

impl Precomputed {
    pub(crate) fn new(mesh: &ColliderMesh, palettes: &[Palette]) -> Self {
        let mut points: Vec<Vec<Vec3>> = vec![Vec::new(); mesh.parts().len()];
        for palette in palettes {
            let Ok(skinned) = skin(mesh, palette.matrices()) else {
                continue;
            };
            for (part, points) in mesh.parts().iter().zip(&mut points) {
                let joint_from_model = model_from_joint(palette, part).inverse();
                // A joint that is scaled to 0 has no inverse.
                if joint_from_model.is_finite() {
                    let positions = part.vertices.iter().map(|v| skinned[v.index()].as_dvec3());
                    let local = positions.map(|p| joint_from_model.transform_point3(p).as_vec3());
                    points.extend(local);
                }
            }
        }
        let shapes = points.iter().map(|points| {
            let mut sphere = Sphere::nearly_smallest(points.iter().copied())?;
            let mut capsule = BoundingCapsule::around_principal_axis(points.iter().copied())?;
            sphere.radius *= 1.0 + MARGIN;
            capsule.radius += capsule.radius.max(capsule.a.distance(capsule.b)) * MARGIN;
            Some((sphere, capsule))
        });
        Self {
            shapes: shapes.collect(),
        }
    }

    pub(crate) fn sphere(&self, part: usize, moved: &DAffine3) -> Option<BoundingVolume> {
        let (sphere, _) = self.shapes[part]?;
        Some(BoundingVolume::Sphere(Sphere {
            center: place(moved, sphere.center),
            radius: sphere.radius * scale(moved),
        }))
    }

    pub(crate) fn capsule(&self, part: usize, moved: &DAffine3) -> Option<BoundingVolume> {
        let (_, capsule) = self.shapes[part]?;
        Some(BoundingVolume::Capsule(BoundingCapsule {
            a: place(moved, capsule.a),
            b: place(moved, capsule.b),
            radius: capsule.radius * scale(moved),
        }))
    }
}

/// The transform of the part's joint.
pub(crate) fn model_from_joint(palette: &Palette, part: &Part) -> DAffine3 {
    let found = palette.model_from_joint(part.joint);
    *found.unwrap_or(&DAffine3::IDENTITY)
}

fn place(model_from_joint: &DAffine3, point: Vec3) -> Vec3 {
    model_from_joint
        .transform_point3(point.as_dvec3())
        .as_vec3()
}

/// The largest scale of a joint without shear.
fn scale(model_from_joint: &DAffine3) -> f32 {
    let linear = model_from_joint.matrix3;
    let columns = [linear.x_axis, linear.y_axis, linear.z_axis];
    let longest = columns
        .map(|c| c.length_squared())
        .into_iter()
        .fold(0.0, f64::max);
    longest.sqrt() as f32
}
