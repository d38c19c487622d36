use clamber_surface::rig::{JointId, Pose, Skeleton};
use glam::{DAffine3, DVec3};

use super::bend::ReachResult;
use super::two_bone::check_pose;
use super::{IkError, arc};
use crate::pose::{rotation_of, store_rotation};
use crate::space::{invertible, model_from_joint, model_from_parent, uniform_scale};

/// The most passes of FABRIK over a chain. It limits the work where the chain converges slowly or not at all.
const MOST_PASSES: usize = 32;
/// How near the chain's end must come to the target, as a share of the chain's length.
const TOLERANCE: f64 = 1e-4;

/// A neck, a tail or a tentacle: a chain of any number of joints, whose end is brought to a target.
///
/// FABRIK (Aristidou and Lasenby 2011, "FABRIK: A fast, iterative solver for the Inverse Kinematics problem") moves the
/// joints of the present pose forwards and backwards along their bones, so the chain stays near that pose. For two
/// bones [`TwoBone`](super::TwoBone) is exact.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    joints: Vec<JointId>,
}

impl Chain {
    /// The chain from `first` down to its descendant `end`, with all joints between them.
    ///
    /// # Errors
    /// [`IkError::NoJoint`] if the skeleton lacks a joint, and [`IkError::NotAChain`] if `end` is not below `first`.
    pub fn new(skeleton: &Skeleton, first: JointId, end: JointId) -> Result<Self, IkError> {
        let joints = skeleton.joints().len();
        for joint in [first, end] {
            if joint.index() >= joints {
                return Err(IkError::NoJoint { joint, joints });
            }
        }
        if first == end || !skeleton.is_descendant_or_self(end, first) {
            return Err(IkError::NotAChain {
                joint: end,
                ancestor: first,
            });
        }
        let parent = |joint: &JointId| skeleton.joints()[joint.index()].parent;
        let mut joints: Vec<JointId> = core::iter::successors(Some(end), parent)
            .take_while(|joint| *joint != first)
            .collect();
        joints.push(first);
        joints.reverse();
        Ok(Self { joints })
    }

    /// The joints, from the first one to the end.
    pub fn joints(&self) -> &[JointId] {
        &self.joints
    }

    /// Turns the joints so that the end is at a target in model space, to a ten-thousandth of the chain's length.
    ///
    /// # Errors
    /// [`IkError::NotFinite`] for the target or the pose, [`IkError::NoJoint`], [`IkError::NoLength`] if the chain has
    /// no length, [`IkError::NotInvertible`], and [`IkError::Sheared`] if a joint other than the end scales unevenly.
    /// The pose is then unchanged.
    pub fn solve(
        &self,
        skeleton: &Skeleton,
        pose: &mut Pose,
        target: DVec3,
    ) -> Result<ReachResult, IkError> {
        check_pose(skeleton, pose, self.joints.iter().copied())?;
        if !target.is_finite() {
            return Err(IkError::NotFinite("the target"));
        }
        let first = self.joints[0];
        let parent = model_from_parent(skeleton, pose, first);
        if !parent.is_finite() {
            return Err(IkError::NotFinite("the pose"));
        }
        invertible(&parent.matrix3, first)?;
        // The target in the space of the first joint's parent.
        let target = parent.inverse().transform_point3(target);
        let mut points = Vec::with_capacity(self.joints.len());
        let mut space = DAffine3::IDENTITY;
        for joint in &self.joints {
            let local = pose.transforms[joint.index()].to_affine();
            space *= local;
            if !space.is_finite() {
                return Err(IkError::NotFinite("the pose"));
            }
            points.push(space.translation);
            if joint != &self.joints[self.joints.len() - 1] {
                uniform_scale(&space.matrix3, *joint)?;
            }
        }
        let lengths: Vec<f64> = points
            .windows(2)
            .map(|pair| pair[0].distance(pair[1]))
            .collect();
        let full: f64 = lengths.iter().sum();
        if full.is_nan() || full < 1e-9 {
            return Err(IkError::NoLength(self.joints[self.joints.len() - 1]));
        }
        let reach = reach(&mut points, &lengths, full, target);
        self.apply(pose, &points);
        Ok(reach)
    }

    /// Turns each joint so that its bone points to the next point.
    fn apply(&self, pose: &mut Pose, points: &[DVec3]) {
        let mut space = DAffine3::IDENTITY;
        for (index, pair) in self.joints.windows(2).enumerate() {
            let [joint, child] = [pair[0], pair[1]].map(JointId::index);
            let here = space * pose.transforms[joint].to_affine();
            let tip = pose.transforms[child].translation.as_dvec3();
            // The bone in the space of the joint's parent, where the joint's rotation applies.
            let bone = rotation_of(&pose.transforms[joint])
                * (pose.transforms[joint].scale.as_dvec3() * tip);
            let wanted = space.matrix3.inverse() * (points[index + 1] - here.translation);
            if let (Some(bone), Some(wanted)) = (bone.try_normalize(), wanted.try_normalize()) {
                let rotation = arc(bone, wanted) * rotation_of(&pose.transforms[joint]);
                store_rotation(&mut pose.transforms[joint], rotation.normalize());
            }
            space *= pose.transforms[joint].to_affine();
        }
    }

    /// Position of the chain's end in model space.
    ///
    /// # Errors
    /// [`IkError::NoJoint`] if the pose or the skeleton does not fit.
    pub fn end(&self, skeleton: &Skeleton, pose: &Pose) -> Result<DVec3, IkError> {
        check_pose(skeleton, pose, self.joints.iter().copied())?;
        let end = self.joints[self.joints.len() - 1];
        let end = model_from_joint(skeleton, pose, end).translation;
        if end.is_finite() {
            Ok(end)
        } else {
            Err(IkError::NotFinite("the pose"))
        }
    }
}

/// Moves the points so that the last one is at the target, and keeps the distances between neighbours.
fn reach(points: &mut [DVec3], lengths: &[f64], full: f64, target: DVec3) -> ReachResult {
    let (start, last) = (points[0], points.len() - 1);
    let distance = start.distance(target);
    if distance >= full {
        let direction = (target - start).normalize_or(DVec3::X);
        for k in 0..last {
            points[k + 1] = points[k] + direction * lengths[k];
        }
        let gap = distance - full;
        return if gap > TOLERANCE * full {
            ReachResult::Short(gap)
        } else {
            ReachResult::Reached
        };
    }
    // A straight chain whose target lies on its line would stay straight: a small bend lets it fold.
    let line = (points[last] - start).normalize_or(DVec3::X);
    let is_straight = points[last].distance(start) > full * (1.0 - 1e-9);
    if is_straight {
        let aside = line.any_orthonormal_vector() * (full * 1e-2);
        for point in &mut points[1..last] {
            *point += aside;
        }
    }
    let follow = |from: DVec3, to: DVec3, length: f64| {
        from + (to - from).normalize_or(line.any_orthonormal_vector()) * length
    };
    for _ in 0..MOST_PASSES {
        points[last] = target;
        for k in (0..last).rev() {
            points[k] = follow(points[k + 1], points[k], lengths[k]);
        }
        points[0] = start;
        for k in 0..last {
            points[k + 1] = follow(points[k], points[k + 1], lengths[k]);
        }
        if points[last].distance(target) <= TOLERANCE * full {
            return ReachResult::Reached;
        }
    }
    let gap = points[last].distance(target);
    // The longest bone is longer than all the others together, and the chain cannot fold any further.
    if points[last].distance(start) > distance {
        ReachResult::TooNear(gap)
    } else {
        ReachResult::Short(gap)
    }
}
