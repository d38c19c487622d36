use glam::DAffine3;

use super::JointId;
#[cfg(feature = "serde")]
use super::RigError;
use crate::geometry::Affine;

/// One matrix per joint that maps mesh space at rest to model space now: `model_from_joint * joint_from_mesh`.
/// Skinning reads it.
///
/// Comes from [`crate::rig::Skeleton::palette`], or from the matrices of an engine through [`Palette::from_matrices`].
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "StoredPalette"))]
pub struct Palette {
    pub(super) matrices: Vec<Affine>,
    pub(super) model_from_joint: Vec<DAffine3>,
}

impl Palette {
    /// A palette from matrices in joint order, for engines that pose their skeletons themselves.
    pub fn from_matrices(matrices: impl IntoIterator<Item = Affine>) -> Self {
        Self {
            matrices: matrices.into_iter().collect(),
            model_from_joint: Vec::new(),
        }
    }

    /// Replaces the palette by [`Palette::from_matrices`] of these matrices, and keeps its memory.
    pub fn set_matrices(&mut self, matrices: impl IntoIterator<Item = Affine>) {
        self.matrices.clear();
        self.matrices.extend(matrices);
        self.model_from_joint.clear();
    }

    /// The matrices, in joint order.
    pub fn matrices(&self) -> &[Affine] {
        &self.matrices
    }

    /// The transform of a joint in model space. `None` for a joint out of range, and for a palette made by
    /// [`Palette::from_matrices`], which does not know it.
    pub fn model_from_joint(&self, joint: JointId) -> Option<&DAffine3> {
        self.model_from_joint.get(joint.0 as usize)
    }
}

/// [`Palette::from_matrices`], for `collect`.
impl FromIterator<Affine> for Palette {
    fn from_iter<I: IntoIterator<Item = Affine>>(matrices: I) -> Self {
        Self::from_matrices(matrices)
    }
}

/// A deserialised palette that is still to be checked.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct StoredPalette {
    matrices: Vec<Affine>,
    model_from_joint: Vec<DAffine3>,
}

#[cfg(feature = "serde")]
impl TryFrom<StoredPalette> for Palette {
    type Error = RigError;

    fn try_from(stored: StoredPalette) -> Result<Self, RigError> {
        let StoredPalette {
            matrices,
            model_from_joint,
        } = stored;
        let (expected, found) = (matrices.len(), model_from_joint.len());
        if found != 0 && found != expected {
            return Err(RigError::JointCount { expected, found });
        }
        Ok(Self {
            matrices,
            model_from_joint,
        })
    }
}
