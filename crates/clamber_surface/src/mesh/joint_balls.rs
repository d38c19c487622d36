//! For each joint the ball of the vertices that it moves: from them follows a box around the whole surface, see
//! [`crate::bounds`].

use glam::Vec3;

use super::summary::{Summarizer, Summary};
use super::{ColliderMesh, VertexId};
use crate::rig::JointId;

/// Rest data for a box around the whole surface.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct JointBalls {
    /// By ascending joint, of the vertices that it moves, without their weights.
    pub(crate) balls: Vec<(JointId, Summary)>,
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
                    let mut ball = summarizer.of_vertices(vertices);
                    ball.spans = Vec::new();
                    (joint, ball)
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
            match self.balls.binary_search_by_key(&joint, |(known, _)| *known) {
                Ok(place) => self.balls[place].1.hold(position),
                Err(place) => {
                    let ball = Summary::default().bound(&[position]);
                    self.balls.insert(place, (joint, ball));
                }
            }
        }
    }
}
