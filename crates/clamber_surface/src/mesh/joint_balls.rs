//! For each joint, a ball around the vertices that it moves. [`crate::bounds`] computes a box around the whole
//! surface from these balls.

use glam::Vec3;

use super::summary::{Summarizer, Summary, reach_of};
use super::{ColliderMesh, VertexId};
use crate::geometry::Sphere;
use crate::rig::JointId;

/// A ball around the rest positions of the vertices that a joint moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct JointBall {
    pub(crate) joint: JointId,
    pub(crate) ball: Sphere,
    /// The largest distance from the mesh's origin to a vertex or to the ball's centre, rounded up.
    pub(crate) reach: f32,
}

/// The rest data from which a box around the whole surface is computed.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct JointBalls {
    /// In ascending joint order; only joints that move a vertex.
    pub(crate) balls: Vec<JointBall>,
    /// The most influences that one vertex has.
    pub(crate) influences: usize,
}

impl JointBalls {
    /// Computes the balls from all vertices of a mesh, including those without triangles. Takes some 66 passes over
    /// the vertices.
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

    /// Size of the balls in bytes.
    pub(super) fn memory(&self) -> usize {
        size_of_val(&self.balls[..])
    }

    /// Enlarges the balls of `joints` to hold one more vertex, which these joints move. The centres stay where they
    /// are. A joint that has no ball yet gets one.
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
