use clamber_animation::joint_in_model;
use clamber_animation::rig::{JointId, Pose, Skeleton};
use clamber_surface::geometry::Affine;
use clamber_surface::mesh::{ColliderMesh, VertexId};
use glam::{DAffine3, DVec3};

/// The low vertices of a foot. Many of them also follow the shin, so their places depend on the bend of the leg. They
/// are skinned in f64 by the same method as the surface.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlendedSole {
    /// The joints that move it, with their inverse bind matrices.
    joints: Vec<(JointId, DAffine3)>,
    /// Per vertex: its place in mesh space, and its influences as indices into `joints` with weights.
    vertices: Vec<(DVec3, Vec<(usize, f64)>)>,
}

impl BlendedSole {
    pub(crate) fn new(
        skeleton: &Skeleton,
        mesh: &ColliderMesh,
        vertices: impl Iterator<Item = VertexId>,
    ) -> Self {
        let mut sole = Self::default();
        for vertex in vertices {
            let influences = mesh.influences(vertex).map(|(joint, weight)| {
                let known = sole.joints.iter().position(|(known, _)| *known == joint);
                let index = known.unwrap_or_else(|| {
                    let inverse_bind: &Affine = &skeleton.joints()[joint.index()].inverse_bind;
                    sole.joints.push((joint, inverse_bind.to_f64()));
                    sole.joints.len() - 1
                });
                (index, f64::from(weight))
            });
            let influences = influences.collect();
            let place = mesh.positions()[vertex.index()].as_dvec3();
            sole.vertices.push((place, influences));
        }
        sole
    }

    /// True if the sole is taken to move with the foot alone.
    pub(crate) fn is_empty(&self) -> bool {
        self.vertices.is_empty()
    }

    /// Writes the places of the vertices in a pose, in model space, into `places`.
    pub(crate) fn skin(&self, skeleton: &Skeleton, pose: &Pose, places: &mut Vec<DVec3>) {
        let palette: Vec<DAffine3> = (self.joints.iter())
            .map(|(joint, inverse_bind)| {
                joint_in_model(skeleton, pose, *joint).unwrap_or_default() * *inverse_bind
            })
            .collect();
        places.clear();
        places.extend(self.vertices.iter().map(|(place, influences)| {
            let moved = influences.iter();
            moved
                .map(|(joint, weight)| palette[*joint].transform_point3(*place) * *weight)
                .sum::<DVec3>()
        }));
    }
}
