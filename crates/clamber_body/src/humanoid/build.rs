//! Builds a body from named joints: checks the hierarchy and prepares the limbs' inverse kinematics.

use clamber_animation::ik::{IkError, TwoBone};
use clamber_surface::rig::{JointId, Skeleton};
use glam::{DAffine3, DVec3};

use super::names::words;
use super::{HumanJoint, Humanoid, Limb, LimbEnd, Side, reference};
use crate::BodyError;

/// The joints of a body before they are checked.
pub(super) struct Named {
    pub(super) hips: JointId,
    pub(super) chest: Option<JointId>,
    pub(super) head: JointId,
    pub(super) arms: [NamedLimb; 2],
    pub(super) legs: [NamedLimb; 2],
}

pub(super) struct NamedLimb {
    pub(super) shoulder: Option<JointId>,
    pub(super) upper: JointId,
    pub(super) lower: JointId,
    pub(super) end: NamedEnd,
    pub(super) toes: Option<JointId>,
}

pub(super) enum NamedEnd {
    Joint(JointId),
    Between(Vec<JointId>),
}

/// Words that mark a joint below the forearm as a finger.
const FINGER_WORDS: [&str; 8] = [
    "finger", "fingers", "index", "little", "middle", "pinky", "ring", "thumb",
];

impl Humanoid {
    /// A body from a list of joints. It needs hips, head, upper and lower arms and legs, hands and feet. Shoulders,
    /// chest and toes are optional. Without a chest in the list, the chest is where the arms meet. A neck in the list
    /// is checked but not used: the joints between the chest and the head are the neck. Fingers are found by their
    /// names.
    ///
    /// # Errors
    /// [`BodyError::Missing`] with all missing joints, [`BodyError::NoJoint`] if the skeleton does not have a joint,
    /// [`BodyError::Twice`] if a role or a joint is listed twice, [`BodyError::NotBelow`] if a limb, the chest or the
    /// head has the wrong ancestor, [`BodyError::NoFacing`] if both legs begin at the same point, seen from above, and
    /// [`BodyError::Limb`] if inverse kinematics refuse a limb, such as one without length.
    pub fn from_joints(
        skeleton: &Skeleton,
        joints: &[(HumanJoint, JointId)],
    ) -> Result<Self, BodyError> {
        let count = skeleton.joints().len();
        for (index, &(what, joint)) in joints.iter().enumerate() {
            if joint.index() >= count {
                return Err(BodyError::NoJoint {
                    what,
                    joint,
                    joints: count,
                });
            }
            let before = &joints[..index];
            if before
                .iter()
                .any(|(role, other)| *role == what || *other == joint)
            {
                return Err(BodyError::Twice { what });
            }
        }
        let find = |what: HumanJoint| joints.iter().find(|(role, _)| *role == what);
        let find = |what: HumanJoint| find(what).map(|(_, joint)| *joint);
        let mut missing = Vec::new();
        let mut need = |what: HumanJoint| {
            let found = find(what);
            if found.is_none() {
                missing.push(what);
            }
            found
        };
        let hips = need(HumanJoint::Hips);
        let head = need(HumanJoint::Head);
        let arms = Side::BOTH.map(|side| {
            let parts = [
                HumanJoint::UpperArm(side),
                HumanJoint::LowerArm(side),
                HumanJoint::Hand(side),
            ]
            .map(&mut need);
            limb(parts, find(HumanJoint::Shoulder(side)), None)
        });
        let legs = Side::BOTH.map(|side| {
            let parts = [
                HumanJoint::UpperLeg(side),
                HumanJoint::LowerLeg(side),
                HumanJoint::Foot(side),
            ]
            .map(&mut need);
            limb(parts, None, find(HumanJoint::Toes(side)))
        });
        let (Some(hips), Some(head), [Some(a), Some(b)], [Some(c), Some(d)]) =
            (hips, head, arms, legs)
        else {
            return Err(BodyError::Missing(missing));
        };
        let named = Named {
            hips,
            chest: find(HumanJoint::Chest),
            head,
            arms: [a, b],
            legs: [c, d],
        };
        named.build(skeleton)
    }
}

fn limb(
    [upper, lower, end]: [Option<JointId>; 3],
    shoulder: Option<JointId>,
    toes: Option<JointId>,
) -> Option<NamedLimb> {
    Some(NamedLimb {
        shoulder,
        upper: upper?,
        lower: lower?,
        end: NamedEnd::Joint(end?),
        toes,
    })
}

/// A skeleton in its bind pose.
struct Bound<'a> {
    skeleton: &'a Skeleton,
    /// All joints in model space.
    models: Vec<DAffine3>,
    facing: DVec3,
}

impl Named {
    pub(super) fn build(self, skeleton: &Skeleton) -> Result<Humanoid, BodyError> {
        let below = |joint, ancestor| skeleton.is_descendant_or_self(joint, ancestor);
        let check = |what: HumanJoint, joint, above: HumanJoint, ancestor| {
            if below(joint, ancestor) && joint != ancestor {
                Ok(())
            } else {
                Err(BodyError::NotBelow { what, above })
            }
        };
        check(HumanJoint::Head, self.head, HumanJoint::Hips, self.hips)?;
        for side in Side::BOTH {
            let (arm, leg) = (&self.arms[side.index()], &self.legs[side.index()]);
            let (upper_arm, upper_leg) = (HumanJoint::UpperArm(side), HumanJoint::UpperLeg(side));
            check(upper_arm, arm.upper, HumanJoint::Hips, self.hips)?;
            check(upper_leg, leg.upper, HumanJoint::Hips, self.hips)?;
            check(HumanJoint::LowerArm(side), arm.lower, upper_arm, arm.upper)?;
            check(HumanJoint::LowerLeg(side), leg.lower, upper_leg, leg.upper)?;
        }
        let mut path = self.path(skeleton);
        let carries = |joint: &JointId| self.arms.iter().all(|arm| below(arm.upper, *joint));
        let chest = match self.chest {
            Some(chest) => {
                check(HumanJoint::Chest, chest, HumanJoint::Hips, self.hips)?;
                check(HumanJoint::Head, self.head, HumanJoint::Chest, chest)?;
                path.iter().position(|joint| *joint == chest)
            }
            None => path.iter().rposition(carries),
        };
        let neck = path.split_off(chest.map_or(0, |chest| chest + 1));

        let feet = [0, 1].map(|side| match &self.legs[side].end {
            NamedEnd::Joint(foot) => *foot,
            NamedEnd::Between(_) => self.legs[side].lower,
        });
        let mut bound = Bound {
            skeleton,
            models: reference(skeleton, self.hips, self.head, feet),
            facing: DVec3::Z,
        };
        let [left, right] = [&self.legs[0], &self.legs[1]].map(|leg| bound.place(leg.upper));
        let across = (left - right) * DVec3::new(1.0, 0.0, 1.0);
        let facing = across.cross(DVec3::Y).try_normalize();
        bound.facing = facing.ok_or(BodyError::NoFacing)?;
        let sides = Side::BOTH.map(|side| {
            let arm = bound.limb(&self.arms[side.index()], HumanJoint::UpperArm(side))?;
            let leg = bound.limb(&self.legs[side.index()], HumanJoint::UpperLeg(side))?;
            Ok::<_, BodyError>((arm, leg))
        });
        let [left, right] = sides;
        let ((left_arm, left_leg), (right_arm, right_leg)) = (left?, right?);
        Ok(Humanoid {
            hips: self.hips,
            spine: path,
            neck,
            head: self.head,
            arms: [left_arm, right_arm],
            legs: [left_leg, right_leg],
            facing: bound.facing,
        })
    }

    /// The joints between hips and head, without both, from below.
    fn path(&self, skeleton: &Skeleton) -> Vec<JointId> {
        let parent = |joint: &JointId| skeleton.joints()[joint.index()].parent;
        let above = core::iter::successors(parent(&self.head), parent);
        let mut path: Vec<JointId> = above.take_while(|joint| *joint != self.hips).collect();
        path.reverse();
        path
    }
}

impl Bound<'_> {
    fn model(&self, joint: JointId) -> DAffine3 {
        self.models[joint.index()]
    }

    fn place(&self, joint: JointId) -> DVec3 {
        self.model(joint).translation
    }

    fn limb(&self, named: &NamedLimb, what: HumanJoint) -> Result<Limb, BodyError> {
        let failed = |error| BodyError::Limb { limb: what, error };
        let (upper, lower) = (named.upper, named.lower);
        let is_leg = matches!(what, HumanJoint::UpperLeg(_));
        let below = |joint| self.skeleton.is_descendant_or_self(joint, lower) && joint != lower;
        let end = match &named.end {
            NamedEnd::Joint(joint) if below(*joint) => LimbEnd::Joint(*joint),
            NamedEnd::Joint(joint) => {
                LimbEnd::Beside(*joint, self.in_space_of(lower, self.place(*joint)))
            }
            NamedEnd::Between(joints) => {
                let sum: DVec3 = joints.iter().map(|joint| self.place(*joint)).sum();
                LimbEnd::Point(self.in_space_of(lower, sum / joints.len() as f64))
            }
        };
        let bends = if is_leg { self.facing } else { -self.facing };
        let ik = |bends| match end {
            LimbEnd::Joint(joint) => TwoBone::new(self.skeleton, [upper, lower, joint], bends),
            LimbEnd::Beside(_, point) | LimbEnd::Point(point) => {
                TwoBone::to_point(self.skeleton, [upper, lower], point, bends)
            }
        };
        // `bends` lies along an arm that is stretched out in front; such an arm bends downwards.
        let ik = match ik(bends) {
            Err(IkError::BadSetUp(_)) => ik(DVec3::NEG_Y),
            other => other,
        };
        let ik = ik.map_err(failed)?;
        let tip = end.place(lower, &self.models);
        let [shoulder, elbow] = [upper, lower].map(|joint| self.place(joint));
        let lengths = [shoulder.distance(elbow), elbow.distance(tip)];
        let shoulder = named.shoulder.filter(|shoulder| {
            let is_above = self.skeleton.is_descendant_or_self(upper, *shoulder);
            is_above && *shoulder != upper
        });
        Ok(Limb {
            shoulder,
            upper,
            lower,
            end,
            toes: named.toes,
            fingers: if is_leg {
                Vec::new()
            } else {
                self.fingers(lower)
            },
            ik,
            lengths,
        })
    }

    fn in_space_of(&self, joint: JointId, point: DVec3) -> DVec3 {
        self.model(joint).inverse().transform_point3(point)
    }

    /// The chains of joints below a forearm whose names contain a word of [`FINGER_WORDS`].
    fn fingers(&self, lower: JointId) -> Vec<Vec<JointId>> {
        let is_finger = |joint: &JointId| {
            let words = words(&self.skeleton.joints()[joint.index()].name);
            words
                .iter()
                .any(|word| FINGER_WORDS.contains(&word.as_str()))
        };
        let parent = |joint: JointId| self.skeleton.joints()[joint.index()].parent;
        let all = (0..self.skeleton.joints().len() as u32).map(JointId);
        let below: Vec<JointId> = all
            .filter(|joint| self.skeleton.is_descendant_or_self(*joint, lower))
            .filter(is_finger)
            .collect();
        let begins = |joint: &&JointId| parent(**joint).is_none_or(|above| !below.contains(&above));
        let next = |joint: &JointId| below.iter().find(|other| parent(**other) == Some(*joint));
        below
            .iter()
            .filter(begins)
            .map(|first| {
                core::iter::successors(Some(*first), |joint| next(joint).copied()).collect()
            })
            .collect()
    }
}
