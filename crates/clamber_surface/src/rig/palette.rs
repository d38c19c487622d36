use glam::DAffine3;

use super::JointId;
use crate::geometry::Affine;

/// One matrix per joint that takes mesh space at rest to model space now:
/// `model_from_joint * joint_from_mesh`. What skinning reads.
///
/// Comes from [`crate::rig::Skeleton::palette`], or from an engine's own matrices through
/// [`Palette::from_matrices`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Palette {
    pub(super) matrices: Vec<Affine>,
    pub(super) model_from_joint: Vec<DAffine3>,
}

impl Palette {
    /// A palette from matrices in joint order, of an engine that poses its skeletons itself.
    pub fn from_matrices(matrices: impl IntoIterator<Item = Affine>) -> Self {
        Self {
            matrices: matrices.into_iter().collect(),
            model_from_joint: Vec::new(),
        }
    }

    /// Becomes [`Palette::from_matrices`] of others, and keeps its memory.
    pub fn set_matrices(&mut self, matrices: impl IntoIterator<Item = Affine>) {
        self.matrices.clear();
        self.matrices.extend(matrices);
        self.model_from_joint.clear();
    }

    /// The matrices, in joint order.
    pub fn matrices(&self) -> &[Affine] {
        &self.matrices
    }

    /// Where a joint stands in model space; `None` for a joint out of range and for a palette made
    /// by [`Palette::from_matrices`], which does not know.
    pub fn model_from_joint(&self, joint: JointId) -> Option<&DAffine3> {
        self.model_from_joint.get(joint.0 as usize)
    }
}
