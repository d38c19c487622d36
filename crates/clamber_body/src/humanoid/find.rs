//! Finds the joints of a body by their names and their hierarchy.

use clamber_surface::rig::{JointId, Skeleton};

use super::build::{Named, NamedEnd, NamedLimb};
use super::names::{Meaning, Part};
use super::{HumanJoint, Humanoid, Side};
use crate::BodyError;

impl Humanoid {
    /// Finds the body in a skeleton. Limbs, fingers and the head are found by the joints' names. Without a joint named
    /// head, the topmost joint of neck or spine that carries no arm counts as the head.
    ///
    /// The rest is found by the hierarchy alone, whatever its names: the hips, where legs and spine meet; the chest,
    /// where the arms meet; and the joints between hips, chest and head, which are [`Humanoid::spine`] and
    /// [`Humanoid::neck`].
    ///
    /// # Errors
    /// [`BodyError::Missing`] with all missing joints, and the errors of [`Humanoid::from_joints`].
    pub fn find(skeleton: &Skeleton) -> Result<Self, BodyError> {
        Search::new(skeleton).named()?.build(skeleton)
    }
}

struct Search<'a> {
    skeleton: &'a Skeleton,
    /// Joints whose names have a meaning, by rank, then by depth.
    joints: Vec<(JointId, Meaning)>,
}

impl<'a> Search<'a> {
    fn new(skeleton: &'a Skeleton) -> Self {
        let meant = skeleton.joints().iter().enumerate();
        let mut joints: Vec<(JointId, Meaning)> = meant
            .filter_map(|(index, joint)| Some((JointId(index as u32), Meaning::of(&joint.name)?)))
            .collect();
        joints.sort_by_key(|(joint, meaning)| (meaning.rank, depth(skeleton, *joint), *joint));
        Self { skeleton, joints }
    }

    /// All joints with a meaning, the best first: deforming joints, then those nearest to the root.
    fn all(&self, part: Part, side: Option<Side>) -> impl Iterator<Item = JointId> {
        let is_it = move |meaning: &Meaning| meaning.part == part && meaning.side == side;
        let found = self
            .joints
            .iter()
            .filter(move |(_, meaning)| is_it(meaning));
        found.map(|(joint, _)| *joint)
    }

    fn best(&self, part: Part, side: Side) -> Option<JointId> {
        self.all(part, Some(side)).next()
    }

    fn is_below(&self, joint: JointId, ancestor: JointId) -> bool {
        self.skeleton.is_descendant_or_self(joint, ancestor)
    }

    fn named(&self) -> Result<Named, BodyError> {
        let mut missing = Vec::new();
        let mut need = |found: Option<JointId>, what: HumanJoint| {
            if found.is_none() {
                missing.push(what);
            }
            found
        };
        let arms = Side::BOTH.map(|side| {
            let [upper, lower, hand] = self.arm(side);
            let upper = need(upper, HumanJoint::UpperArm(side));
            let lower = need(lower, HumanJoint::LowerArm(side));
            let end = match hand {
                Some(hand) => Some(NamedEnd::Joint(hand)),
                None => self.palms(side),
            };
            if end.is_none() {
                need(None, HumanJoint::Hand(side));
            }
            Some(NamedLimb {
                shoulder: self.best(Part::Shoulder, side),
                upper: upper?,
                lower: lower?,
                end: end?,
                toes: None,
            })
        });
        let legs = Side::BOTH.map(|side| {
            let [upper, lower, foot, toes] = self.leg(side);
            let upper = need(upper, HumanJoint::UpperLeg(side));
            let lower = need(lower, HumanJoint::LowerLeg(side));
            let foot = need(foot, HumanJoint::Foot(side));
            Some(NamedLimb {
                shoulder: None,
                upper: upper?,
                lower: lower?,
                end: NamedEnd::Joint(foot?),
                toes,
            })
        });
        let head = need(self.head(&arms), HumanJoint::Head);
        let ([Some(left), Some(right)], [Some(left_leg), Some(right_leg)], Some(head)) =
            (arms, legs, head)
        else {
            return Err(BodyError::Missing(missing));
        };
        let ends = [left_leg.upper, right_leg.upper, head];
        let mut above = core::iter::successors(Some(head), |joint| self.parent(*joint));
        let hips = above.find(|joint| ends.iter().all(|end| self.is_below(*end, *joint)));
        let hips = hips.ok_or_else(|| BodyError::Missing(vec![HumanJoint::Hips]))?;
        Ok(Named {
            hips,
            chest: None,
            head,
            arms: [left, right],
            legs: [left_leg, right_leg],
        })
    }

    fn parent(&self, joint: JointId) -> Option<JointId> {
        self.skeleton.joints()[joint.index()].parent
    }

    /// Upper arm, forearm and hand.
    fn arm(&self, side: Side) -> [Option<JointId>; 3] {
        let (upper, lower) = (
            self.best(Part::UpperArm, side),
            self.best(Part::LowerArm, side),
        );
        let hand = self.best(Part::Hand, side);
        let hand = hand.or_else(|| self.best(Part::Wrist, side));
        let chain: Vec<JointId> = self.all(Part::Arm, Some(side)).collect();
        let link = |index: usize| chain.get(index).copied();
        match (upper, lower) {
            (None, None) if chain.len() > 1 => [link(0), link(1), hand.or(link(2))],
            (None, None) => [None, None, hand],
            (upper, lower) => [upper.or(link(0)), lower.or(link(0)), hand],
        }
    }

    /// Thigh, shin, foot and toes.
    fn leg(&self, side: Side) -> [Option<JointId>; 4] {
        let (upper, lower) = (
            self.best(Part::UpperLeg, side),
            self.best(Part::LowerLeg, side),
        );
        let (foot, toes) = (self.best(Part::Foot, side), self.best(Part::Toes, side));
        let chain: Vec<JointId> = self.all(Part::Leg, Some(side)).collect();
        let link = |index: usize| chain.get(index).copied();
        match (upper, lower) {
            (None, None) if chain.len() > 1 => {
                [link(0), link(1), foot.or(link(2)), toes.or(link(3))]
            }
            (None, None) => [None, None, foot, toes],
            (upper, lower) => [upper.or(link(0)), lower.or(link(0)), foot, toes],
        }
    }

    /// The hand of a skeleton that has palm joints instead, one for each finger.
    fn palms(&self, side: Side) -> Option<NamedEnd> {
        let palms: Vec<JointId> = self.all(Part::Palm, Some(side)).collect();
        match palms.as_slice() {
            [] => None,
            [palm] => Some(NamedEnd::Joint(*palm)),
            _ => Some(NamedEnd::Between(palms)),
        }
    }

    /// The joint named head. Without one, the topmost joint of neck or spine that carries no arm.
    fn head(&self, arms: &[Option<NamedLimb>; 2]) -> Option<JointId> {
        let carries = |joint: JointId| {
            let uppers = arms.iter().flatten().map(|arm| arm.upper);
            uppers.into_iter().any(|upper| self.is_below(upper, joint))
        };
        let named = self.all(Part::Head, None).next();
        named.or_else(|| {
            let above = [Part::Neck, Part::Spine]
                .into_iter()
                .flat_map(|part| self.all(part, None))
                .filter(|joint| !carries(*joint));
            above.max_by_key(|joint| (depth(self.skeleton, *joint), core::cmp::Reverse(*joint)))
        })
    }
}

/// Number of joints from the root to a joint, both included.
pub(crate) fn depth(skeleton: &Skeleton, joint: JointId) -> usize {
    let parent = |joint: &JointId| skeleton.joints()[joint.index()].parent;
    core::iter::successors(Some(joint), parent).count()
}
