//! The bones of a leg, and how they bend.

use clamber_animation::ik::{Chain, IkError, TwoBone, TwoBoneGoal};
use clamber_animation::joint_in_model;
use clamber_animation::rig::{JointId, Pose, Skeleton};
use glam::{DAffine3, DVec3, Vec3};

use super::Names;
use super::file::{Knee, LegFile};
use crate::brain::{check, whole};
use crate::error::ColossusError;

/// Smallest angle between the two bones of a leg, radians: 20 degrees, a deep squat.
const LEAST_KNEE: f64 = 0.349;

/// Scales along the axes that differ by more than this share of the largest one are uneven.
const UNEVEN_SCALE: f32 = 1e-5;

/// A knee is bent at rest if its distance from the line between hip and foot is more than this share of the leg's
/// length.
const BENT_KNEE: f64 = 0.02;

/// The bones of a leg, from its hip to its foot.
#[derive(Clone, Debug)]
pub(crate) struct Limb {
    pub(crate) hip: JointId,
    /// The joint that bends. In a leg of one bone it is the foot.
    pub(crate) knee: JointId,
    pub(crate) foot: JointId,
    /// End of the leg: a point in the space of a joint.
    pub(crate) end: (JointId, DVec3),
    /// All joints from the hip down to the end of the leg, foot and toe included.
    path: Vec<JointId>,
    bones: Bones,
}

#[derive(Clone, Debug)]
enum Bones {
    /// Two bones that bend at the knee. Joints between keep their pose.
    Two(TwoBone),
    /// A single bone that is turned.
    One(Chain),
}

impl Limb {
    /// Finds the leg's joints in the skeleton. `toe` is the joint at the ball of its foot, if it has one.
    pub(crate) fn new(
        names: &Names<'_>,
        file: &LegFile,
        toe: Option<JointId>,
    ) -> Result<Self, ColossusError> {
        let (count, range) = (file.joints.len(), "from 2 to 5 joints of a leg");
        check((2..=5).contains(&count), "joints", range, count as f64).map_err(whole)?;
        let mut joints = Vec::with_capacity(file.joints.len());
        for name in &file.joints {
            joints.push(names.joint(name).map_err(whole)?);
        }
        let limb = Self::of_joints(names.skeleton, &joints, file.knee);
        let error = |error| names.limb_error("leg", file.joints.iter(), error);
        let mut limb = limb.map_err(error)?;
        limb.path.extend(toe);
        Ok(limb)
    }

    fn of_joints(
        skeleton: &Skeleton,
        joints: &[JointId],
        knee: Option<Knee>,
    ) -> Result<Self, IkError> {
        let (hip, foot) = (joints[0], joints[joints.len() - 1]);
        let above = joints[joints.len() - 2];
        let is_beside = joints.len() > 2 && !skeleton.is_descendant_or_self(foot, above);
        let chain = if is_beside {
            &joints[..joints.len() - 1]
        } else {
            joints
        };
        for pair in chain.windows(2) {
            let [ancestor, joint] = [pair[0], pair[1]];
            if joint == ancestor || !skeleton.is_descendant_or_self(joint, ancestor) {
                return Err(IkError::NotAChain { joint, ancestor });
            }
        }
        let parent = |joint: &JointId| skeleton.joints()[joint.index()].parent;
        let last = chain[chain.len() - 1];
        let up = core::iter::successors(Some(last), parent);
        let mut path: Vec<JointId> = up.take_while(|joint| *joint != hip).collect();
        path.extend(is_beside.then_some(foot));
        path.push(hip);
        if joints.len() == 2 {
            return Ok(Self {
                path,
                hip,
                knee: foot,
                foot,
                end: (foot, DVec3::ZERO),
                bones: Bones::One(Chain::new(skeleton, hip, foot)?),
            });
        }
        let rest = skeleton.rest_pose();
        let frame = |joint| joint_in_model(skeleton, &rest, joint).unwrap_or_default();
        let place = |joint| frame(joint).translation;
        let [from, to] = [hip, foot].map(place);
        let evenly = |joint: &JointId| {
            let at = place(*joint);
            at.distance(from).min(at.distance(to))
        };
        let between = joints[1..joints.len() - 1].iter().copied();
        let middle = between.max_by(|a, b| evenly(a).total_cmp(&evenly(b)));
        let middle = middle.unwrap_or(above);
        let line = (to - from).normalize_or(DVec3::NEG_Y);
        let out = (place(middle) - from).reject_from_normalized(line);
        let length = place(middle).distance(from) + place(middle).distance(to);
        let side = match knee {
            Some(Knee::Forward) => DVec3::Z,
            Some(Knee::Backward) => DVec3::NEG_Z,
            None if out.length() > BENT_KNEE * length => out,
            None => DVec3::Z,
        };
        let end = if is_beside {
            (above, frame(above).inverse().transform_point3(to))
        } else {
            (foot, DVec3::ZERO)
        };
        let bones = if is_beside {
            TwoBone::to_point_of(skeleton, [hip, middle, above], end.1, side)?
        } else {
            TwoBone::new(skeleton, [hip, middle, foot], side)?
        };
        Ok(Self {
            path,
            hip,
            knee: middle,
            foot,
            end,
            bones: Bones::Two(bones.with_least_angle(LEAST_KNEE)?),
        })
    }

    /// True if the foot is not below the leg in the skeleton.
    fn is_beside(&self) -> bool {
        self.end.0 != self.foot
    }

    /// Makes uneven scales of the leg's joints in a pose uniform, with the volume that the joint has at rest. Exporters
    /// bake legs that were stretched along their bones, and the solvers turn only rigid bones.
    pub(crate) fn make_rigid(&self, skeleton: &Skeleton, pose: &mut Pose) {
        let is_even = |scale: &Vec3| {
            scale.max_element() - scale.min_element() <= UNEVEN_SCALE * scale.max_element()
        };
        for joint in &self.path {
            let scale = &mut pose.transforms[joint.index()].scale;
            if !is_even(scale) {
                let rest = skeleton.joints()[joint.index()].rest.scale;
                let volume = rest.as_dvec3().element_product();
                *scale = Vec3::splat(libm::cbrt(volume) as f32);
            }
        }
    }

    /// Length of both bones together, with hip, knee and end at these places.
    pub(crate) fn length(&self, [hip, knee, end]: [DVec3; 3]) -> f64 {
        hip.distance(knee) + knee.distance(end)
    }

    /// Bends the leg of a pose so that it ends at a place in model space. Returns false, and leaves the pose, if the
    /// leg cannot be bent.
    pub(crate) fn bend(&self, skeleton: &Skeleton, pose: &mut Pose, to: DVec3, soft: f64) -> bool {
        let goal = TwoBoneGoal {
            soft,
            ..TwoBoneGoal::reach(to)
        };
        let bent = match &self.bones {
            Bones::Two(bones) => bones.solve(skeleton, pose, &goal, None).is_ok(),
            Bones::One(bone) => bone.solve(skeleton, pose, to).is_ok(),
        };
        if bent && self.is_beside() {
            self.carry_foot(skeleton, pose);
        }
        bent
    }

    /// Puts a foot that is not below the leg in the skeleton to the end of the leg.
    fn carry_foot(&self, skeleton: &Skeleton, pose: &mut Pose) {
        let (joint, point) = self.end;
        let parent = skeleton.joints()[self.foot.index()].parent;
        let frames = joint_in_model(skeleton, pose, joint);
        let parent = parent.and_then(|parent| joint_in_model(skeleton, pose, parent));
        let inverse = parent.unwrap_or(DAffine3::IDENTITY).inverse();
        let at = frames.map(|frame| inverse.transform_point3(frame.transform_point3(point)));
        if let Some(at) = at.filter(|at| at.is_finite()) {
            pose.transforms[self.foot.index()].translation = at.as_vec3();
        }
    }
}
