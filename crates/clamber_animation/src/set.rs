use core::fmt;

use clamber_surface::rig::{Clip, JointId, Playback, Pose, RigError, Skeleton, Transform};

use crate::root_motion::RootMotion;
use crate::{AnimationError, JointMask};

/// Index of a clip in its [`AnimationSet`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ClipId(pub u32);

impl fmt::Display for ClipId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)
    }
}

/// Index of a mask in its [`AnimationSet`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MaskId(pub u32);

/// The data that all animators of one kind of creature share: clips, masks, and the rest pose. It does not change while
/// they play, so an animator is small, and a clone of an animator is a complete snapshot.
#[derive(Clone, Debug)]
pub struct AnimationSet {
    rest: Pose,
    clips: Vec<Clip>,
    /// For each clip, the joints that it moves, in ascending order, with their transforms at the clip's start.
    starts: Vec<Vec<(JointId, Transform)>>,
    masks: Vec<JointMask>,
    root: Option<RootMotion>,
}

impl AnimationSet {
    /// A set of clips for a skeleton.
    ///
    /// # Errors
    /// [`RigError::JointOutOfRange`] if a clip moves a joint that the skeleton does not have.
    pub fn new(skeleton: &Skeleton, clips: Vec<Clip>) -> Result<Self, AnimationError> {
        let joints = skeleton.joints().len();
        let mut channels = clips.iter().flat_map(|clip| clip.channels());
        if let Some(bad) = channels.find(|channel| channel.joint().index() >= joints) {
            let joint = bad.joint();
            return Err(RigError::JointOutOfRange { joint, joints }.into());
        }
        let rest = skeleton.rest_pose();
        let starts = clips.iter().map(|clip| start_of(clip, &rest));
        Ok(Self {
            starts: starts.collect::<Result<_, _>>()?,
            rest,
            clips,
            masks: Vec::new(),
            root: None,
        })
    }

    /// The same set with root motion from a joint: the joint's motion along the ground and its rotation about Y, the up
    /// axis of model space, are removed from poses and reported by [`Animator::advance`](crate::Animator::advance).
    /// Pass the topmost joint that the clips move, such as the hips.
    ///
    /// # Errors
    /// [`AnimationError::NoJoint`] if the skeleton does not have the joint, [`AnimationError::JointCount`] if the
    /// skeleton has another number of joints than the set's skeleton.
    pub fn with_root_motion(
        mut self,
        skeleton: &Skeleton,
        joint: JointId,
    ) -> Result<Self, AnimationError> {
        let (expected, found) = (self.rest.transforms.len(), skeleton.joints().len());
        if expected != found {
            return Err(AnimationError::JointCount { expected, found });
        }
        if joint.index() >= found {
            return Err(AnimationError::NoJoint {
                found: joint,
                joints: found,
            });
        }
        self.root = Some(RootMotion::new(skeleton, joint));
        Ok(self)
    }

    /// Adds a mask for layers.
    ///
    /// # Errors
    /// [`AnimationError::JointCount`] if the mask is for another number of joints.
    pub fn add_mask(&mut self, mask: JointMask) -> Result<MaskId, AnimationError> {
        mask.check(self.rest.transforms.len())?;
        self.masks.push(mask);
        Ok(MaskId(self.masks.len() as u32 - 1))
    }

    /// The first clip of this name; `None` if the set has no such clip.
    pub fn find(&self, name: &str) -> Option<ClipId> {
        let index = self.clips.iter().position(|clip| clip.name == name)?;
        Some(ClipId(index as u32))
    }

    /// The clips, indexed by [`ClipId`].
    pub fn clips(&self) -> &[Clip] {
        &self.clips
    }

    /// The pose in which every joint has its rest transform.
    pub fn rest(&self) -> &Pose {
        &self.rest
    }

    /// A clip.
    ///
    /// # Errors
    /// [`AnimationError::NoClip`] if the set does not have it.
    pub fn clip(&self, id: ClipId) -> Result<&Clip, AnimationError> {
        self.clips.get(id.0 as usize).ok_or(AnimationError::NoClip {
            found: id,
            clips: self.clips.len(),
        })
    }

    /// The joints that a clip moves, in ascending order, with their transforms at the clip's start. Root motion is
    /// measured from these.
    pub(crate) fn start(&self, id: ClipId) -> &[(JointId, Transform)] {
        self.starts.get(id.0 as usize).map_or(&[], Vec::as_slice)
    }

    pub(crate) fn mask(&self, id: MaskId) -> Result<&JointMask, AnimationError> {
        self.masks.get(id.0 as usize).ok_or(AnimationError::NoMask {
            found: id.0,
            masks: self.masks.len(),
        })
    }

    pub(crate) fn root(&self) -> Option<&RootMotion> {
        self.root.as_ref()
    }
}

fn start_of(clip: &Clip, rest: &Pose) -> Result<Vec<(JointId, Transform)>, RigError> {
    let mut joints: Vec<JointId> = clip.channels().iter().map(|c| c.joint()).collect();
    joints.sort_unstable();
    joints.dedup();
    let pose = clip.sample(rest, 0.0, Playback::Clamp)?;
    let start = |joint: JointId| (joint, pose.transforms[joint.index()]);
    Ok(joints.into_iter().map(start).collect())
}
