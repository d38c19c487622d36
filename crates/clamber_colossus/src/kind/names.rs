//! Finds clips and joints by their names in a brain file.

use clamber_animation::ik::IkError;
use clamber_animation::rig::{JointId, Skeleton};
use clamber_animation::{AnimationSet, ClipId};

use crate::brain::{BrainError, BrainProblem, whole};

/// Looks names up. Errors list the known names.
pub(crate) struct Names<'a> {
    pub(crate) skeleton: &'a Skeleton,
    pub(crate) clips: &'a AnimationSet,
    /// Gravity for which the clips were made, in the model's units a second squared.
    pub(crate) gravity: f64,
}

impl Names<'_> {
    /// An error of inverse kinematics, with the joints' names.
    pub(crate) fn limb_error<'n>(
        &self,
        limb: &'static str,
        joints: impl Iterator<Item = &'n String>,
        error: IkError,
    ) -> BrainError {
        let name = |joint: JointId| {
            let joint = self.skeleton.joints().get(joint.index());
            joint.map_or("?", |joint| joint.name.as_str())
        };
        let fault = match error {
            IkError::NotAChain { joint, ancestor } => format!(
                "in the skeleton, `{}` is not below `{}`",
                name(joint),
                name(ancestor)
            ),
            IkError::NoLength(joint) => {
                format!("the bone that ends at `{}` has no length", name(joint))
            }
            IkError::NotInvertible(joint) => {
                format!("`{}` or a joint above it is scaled by 0", name(joint))
            }
            IkError::Sheared(joint) => format!(
                "`{}` or a joint above it scales its axes unevenly",
                name(joint)
            ),
            other => other.to_string(),
        };
        self.limb_fault(limb, joints, fault)
    }

    /// An error of a leg or a head, with its cause in words.
    pub(crate) fn limb_fault<'n>(
        &self,
        limb: &'static str,
        joints: impl Iterator<Item = &'n String>,
        fault: String,
    ) -> BrainError {
        let joints: Vec<String> = joints.map(|name| format!("`{name}`")).collect();
        let joints = joints.join(", ");
        whole(BrainProblem::Limb {
            limb,
            joints,
            fault,
        })
    }

    pub(crate) fn clip(&self, name: &str) -> Result<ClipId, BrainProblem> {
        let known = self.clips.clips().iter().map(|clip| &clip.name);
        let found = self.clips.find(name);
        found.ok_or_else(|| BrainProblem::unknown("clip", name, known))
    }

    pub(crate) fn joint(&self, name: &str) -> Result<JointId, BrainProblem> {
        self.skeleton.find(name).ok_or_else(|| self.no_joint(name))
    }

    /// The joints that a pattern names: one joint, or all joints that begin with the text before `*` and end with the
    /// text after it.
    pub(crate) fn joints(&self, pattern: &str) -> Result<Vec<JointId>, BrainProblem> {
        let Some((start, end)) = pattern.split_once('*') else {
            return Ok(vec![self.joint(pattern)?]);
        };
        let fits = |name: &str| {
            name.strip_prefix(start)
                .is_some_and(|rest| rest.ends_with(end))
        };
        let all = self.skeleton.joints().iter().enumerate();
        let found: Vec<JointId> = all
            .filter(|(_, joint)| fits(&joint.name))
            .map(|(index, _)| JointId(index as u32))
            .collect();
        if found.is_empty() {
            return Err(self.no_joint(pattern));
        }
        Ok(found)
    }

    fn no_joint(&self, name: &str) -> BrainProblem {
        let known = self.skeleton.joints().iter().map(|joint| &joint.name);
        BrainProblem::unknown("joint", name, known)
    }
}
