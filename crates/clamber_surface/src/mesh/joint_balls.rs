//! For each joint the ball of the vertices that it moves: from them follows a box around the whole surface, see
//! [`crate::bounds`].

use glam::Vec3;

use super::summary::{Summarizer, Summary, reach_of};
use super::{ColliderMesh, VertexId};
use crate::geometry::Sphere;
use crate::rig::JointId;

/// The ball of the vertices that a joint moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct JointBall {
    pub(crate) joint: JointId,
    pub(crate) ball: Sphere,
    /// The largest distance of a vertex or of the ball's centre from the mesh's origin, rounded up.
    pub(crate) reach: f32,
}

/// Rest data for a box around the whole surface.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct JointBalls {
    /// By ascending joint.
    pub(crate) balls: Vec<JointBall>,
    /// The most that one vertex has.
    pub(crate) influences: usize,
}

impl JointBalls {
    /// Reads all vertices of a mesh, those without triangles included: some 66 passes over them.
    pub(super) fn new(mesh: &ColliderMesh) -> Self {
        let mut moved: Vec<Vec<VertexId>> = vec![Vec::new(); mesh.joint_count()];
        for vertex in (0..mesh.positions().len() as u32).map(VertexId) {
            for (joint, _) in mesh.influences(vertex) {
                moved[joint.index()].push(vertex);
            }
        }
        let mut summarizer = Summarizer::new(mesh);
        let joints = (0..).map(JointId).zip(&moved);
        let moving = joints.filter(|(_, vertices)| !vertices.is_empty());
        Self {
            balls: moving
                .map(|(joint, vertices)| {
                    let Summary { ball, reach, .. } = summarizer.of_vertices(vertices);
                    JointBall { joint, ball, reach }
                })
                .collect(),
            influences: mesh.max_influences(),
        }
    }

    /// In bytes.
    pub(super) fn memory(&self) -> usize {
        size_of_val(&self.balls[..])
    }

    /// Grows so as to hold one more vertex, which these joints move. The balls stay where they are.
    pub(super) fn hold(&mut self, position: Vec3, joints: impl ExactSizeIterator<Item = JointId>) {
        self.influences = self.influences.max(joints.len());
        for joint in joints {
            let place = self.balls.binary_search_by_key(&joint, |known| known.joint);
            let place = place.unwrap_or_else(|place| {
                let ball = Sphere {
                    center: position,
                    radius: 0.0,
                };
                let reach = 0.0;
                self.balls.insert(place, JointBall { joint, ball, reach });
                place
            });
            let JointBall { ball, reach, .. } = &mut self.balls[place];
            let grown = Sphere::around(ball.center, [position].into_iter());
            ball.radius = ball.radius.max(grown.radius);
            *reach = reach.max(reach_of(position));
        }
    }
}
