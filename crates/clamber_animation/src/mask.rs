use clamber_surface::rig::{JointId, Skeleton};

use crate::AnimationError;
use crate::error::within;

/// The share of a layer that each joint gets, 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct JointMask {
    shares: Vec<f32>,
}

impl JointMask {
    /// A mask with share 0 for every joint.
    pub fn none(skeleton: &Skeleton) -> Self {
        Self {
            shares: vec![0.0; skeleton.joints().len()],
        }
    }

    /// A mask with share 1 for a joint and its descendants, and 0 for all others.
    ///
    /// # Errors
    /// As [`JointMask::with_branch`].
    pub fn branch(skeleton: &Skeleton, joint: JointId) -> Result<Self, AnimationError> {
        Self::none(skeleton).with_branch(skeleton, joint, 1.0)
    }

    /// The same mask with another share for a joint and all of its descendants. To blend a layer in along the spine,
    /// call it for one spine joint after the other, from the lowest up, with rising shares.
    ///
    /// # Errors
    /// [`AnimationError::NoJoint`] and [`AnimationError::JointCount`] if the joint or the mask do not fit the skeleton,
    /// [`AnimationError::OutOfRange`] if the share is not from 0 to 1.
    pub fn with_branch(
        mut self,
        skeleton: &Skeleton,
        joint: JointId,
        share: f64,
    ) -> Result<Self, AnimationError> {
        let joints = skeleton.joints().len();
        self.check(joints)?;
        if joint.index() >= joints {
            let found = joint;
            return Err(AnimationError::NoJoint { found, joints });
        }
        within("a mask's share", "from 0 to 1", share, 0.0, 1.0)?;
        for (index, mine) in self.shares.iter_mut().enumerate() {
            if skeleton.is_descendant_or_self(JointId(index as u32), joint) {
                *mine = share as f32;
            }
        }
        Ok(self)
    }

    /// The share of each joint, in joint order.
    pub fn shares(&self) -> &[f32] {
        &self.shares
    }

    pub(crate) fn check(&self, joints: usize) -> Result<(), AnimationError> {
        if self.shares.len() == joints {
            return Ok(());
        }
        Err(AnimationError::JointCount {
            expected: joints,
            found: self.shares.len(),
        })
    }
}
