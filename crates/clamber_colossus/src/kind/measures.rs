use clamber_animation::joint_in_model;
use clamber_animation::rig::{JointId, Skeleton};
use clamber_surface::mesh::{ColliderMesh, VertexId};
use clamber_surface::skin::skin;
use clamber_surface::surface::SurfaceError;
use glam::{DVec3, Vec3};

use crate::error::ColossusError;

/// The skin of a kind of creature, posed at rest, in model space. All sizes come from it, since the positions of a mesh
/// in its file may have another scale and another origin.
#[derive(Clone, Debug)]
pub(crate) struct RestSkin {
    pub(crate) positions: Vec<Vec3>,
    /// Least and largest coordinates of all triangles.
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
    /// Half the width of the body on the ground: the largest `min(|x|, |z|)` of the skin, so that arms that are held
    /// aside do not count.
    pub(crate) girth: f64,
}

impl RestSkin {
    pub(crate) fn new(skeleton: &Skeleton, mesh: &ColliderMesh) -> Result<Self, ColossusError> {
        let palette = skeleton.palette(&skeleton.rest_pose())?;
        let positions = skin(mesh, palette.matrices()).map_err(SurfaceError::from)?;
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut girth = 0f64;
        for corner in mesh.triangles().iter().flatten() {
            let p = positions[corner.index()].as_dvec3();
            (low, high) = (low.min(p), high.max(p));
            girth = girth.max(p.x.abs().min(p.z.abs()));
        }
        Ok(Self {
            positions,
            low,
            high,
            girth,
        })
    }

    /// Height along Y.
    pub(crate) fn height(&self) -> f64 {
        self.high.y - self.low.y
    }

    /// One ball for each joint that moves some vertices by at least half.
    pub(crate) fn balls(&self, skeleton: &Skeleton, mesh: &ColliderMesh) -> Vec<JointBall> {
        let joints = skeleton.joints().len();
        let mut ours: Vec<Vec<DVec3>> = vec![Vec::new(); joints];
        for (index, place) in self.positions.iter().enumerate() {
            for (joint, weight) in mesh.influences(VertexId(index as u32)) {
                if weight >= 0.5 {
                    ours[joint.index()].push(place.as_dvec3());
                }
            }
        }
        let rest = skeleton.rest_pose();
        let all = (0..).map(JointId).zip(&ours);
        let balls = all.filter(|(_, ours)| !ours.is_empty());
        let balls = balls.filter_map(|(joint, ours)| {
            let frame = joint_in_model(skeleton, &rest, joint)?;
            let count = ours.len() as f64;
            let middle = ours.iter().sum::<DVec3>() / count;
            let squares = ours.iter().map(|place| place.distance_squared(middle));
            Some(JointBall {
                joint,
                middle: frame.inverse().transform_point3(middle),
                radius: (squares.sum::<f64>() / count).sqrt(),
            })
        });
        balls.collect()
    }
}

/// A ball that approximates the vertices that follow a joint by at least half. The radius is the root mean square of
/// their distances from the middle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JointBall {
    pub(crate) joint: JointId,
    /// Centre of the ball, in the joint's space.
    pub(crate) middle: DVec3,
    pub(crate) radius: f64,
}
