use clamber_surface::rig::{JointId, Pose, Skeleton};
use glam::{DAffine3, DMat3, DVec3};

use super::bend::{ReachResult, bend};
use super::{IkError, PoleMemory, arc, frame_turn};
use crate::pose::{rotation_of, store_rotation};
use crate::space::{invertible, model_from_joint, model_from_parent, uniform_inverse};

/// An arm or a leg of a skeleton, solved as two bones.
///
/// Other joints, such as twist joints, may lie between its three joints. They keep their pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoBone {
    upper: JointId,
    lower: JointId,
    /// The joint in whose space `tip` is: the lower joint or one of its descendants.
    end: JointId,
    /// The limb's end, a point in the space of the joint `end`.
    tip: DVec3,
    /// The axis about which the elbow bends if the pose does not give one, in the upper joint's own space.
    hinge: DVec3,
    /// Cosine of the least angle between the bones.
    least_cos: f64,
}

/// A target for a limb, and how the limb bends to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoBoneGoal {
    /// The target of the limb's end, in model space.
    pub target: DVec3,
    /// The side of the line from shoulder to target to which the elbow points: a vector in model space of any length.
    /// With `None`, the limb keeps the side to which the pose bends it.
    pub pole: Option<DVec3>,
    /// The share of the limb's length from which the limb approaches a far target softly, more than 0 to 1. 0.97 keeps
    /// elbows from snapping straight. 1 reaches as far as the bones do, for hands and feet that must not slip.
    pub soft: f64,
}

impl TwoBoneGoal {
    /// Reaches for a point in model space as far as the bones do, and keeps the side to which the pose bends the limb.
    pub const fn reach(target: DVec3) -> Self {
        Self {
            target,
            pole: None,
            soft: 1.0,
        }
    }
}

/// A limb in one pose, in the space of the upper joint's parent.
struct Posed {
    /// The origin of that space in model space.
    origin: DVec3,
    /// Maps vectors from model space to that space.
    parent_from_model: DMat3,
    shoulder: DVec3,
    /// Unit vectors along the bones, from shoulder to elbow and from elbow to end.
    bones: [DVec3; 2],
    /// The lengths of both bones.
    lengths: [f64; 2],
    /// The unit vector about which the elbow bends.
    hinge: DVec3,
    /// Maps vectors from the space of the upper joint, without its rotation, to the space of the lower joint's parent.
    lower_from_upper: DMat3,
}

impl Posed {
    /// The vector from the shoulder to the end.
    fn line(&self) -> DVec3 {
        self.bones[0] * self.lengths[0] + self.bones[1] * self.lengths[1]
    }
}

impl TwoBone {
    /// The limb from shoulder to elbow to hand, or from hip to knee to foot. `bends_towards` is the direction in which
    /// the elbow or knee points at rest, in model space: forward for knees, backward for elbows. Only its part
    /// perpendicular to the limb counts.
    ///
    /// # Errors
    /// [`IkError::NoJoint`], [`IkError::NotAChain`], [`IkError::NoLength`] if a bone has no length at rest,
    /// [`IkError::NotInvertible`] and [`IkError::Sheared`] for scales, and [`IkError::BadSetUp`] if `bends_towards` is
    /// not finite or lies along the limb.
    pub fn new(
        skeleton: &Skeleton,
        [upper, lower, end]: [JointId; 3],
        bends_towards: DVec3,
    ) -> Result<Self, IkError> {
        if end == lower {
            let (joint, ancestor) = (end, lower);
            return Err(IkError::NotAChain { joint, ancestor });
        }
        Self::with_tip(skeleton, [upper, lower, end], DVec3::ZERO, bends_towards)
    }

    /// The limb of a rig whose foot is not a descendant of the knee but a separate target beside the leg, as in files
    /// with baked controls. The limb ends at `point` in the space of the lower joint; pass the foot's position at rest.
    ///
    /// # Errors
    /// As [`TwoBone::new`]; [`IkError::BadSetUp`] also if the point is not finite.
    pub fn to_point(
        skeleton: &Skeleton,
        [upper, lower]: [JointId; 2],
        point: DVec3,
        bends_towards: DVec3,
    ) -> Result<Self, IkError> {
        Self::to_point_of(skeleton, [upper, lower, lower], point, bends_towards)
    }

    /// As [`TwoBone::to_point`] for a limb with more joints: it ends at a point in the space of the joint `end`, which
    /// is the lower joint or one of its descendants.
    ///
    /// # Errors
    /// As [`TwoBone::to_point`].
    pub fn to_point_of(
        skeleton: &Skeleton,
        [upper, lower, end]: [JointId; 3],
        point: DVec3,
        bends_towards: DVec3,
    ) -> Result<Self, IkError> {
        if !point.is_finite() {
            return Err(IkError::BadSetUp("where the limb ends is not finite"));
        }
        Self::with_tip(skeleton, [upper, lower, end], point, bends_towards)
    }

    fn with_tip(
        skeleton: &Skeleton,
        [upper, lower, end]: [JointId; 3],
        tip: DVec3,
        bends_towards: DVec3,
    ) -> Result<Self, IkError> {
        let joints = skeleton.joints().len();
        if let Some(joint) = [upper, lower, end]
            .into_iter()
            .find(|j| j.index() >= joints)
        {
            return Err(IkError::NoJoint { joint, joints });
        }
        for (joint, ancestor) in [(lower, upper), (end, lower)] {
            let is_same = joint == ancestor && joint != end;
            if is_same || !skeleton.is_descendant_or_self(joint, ancestor) {
                return Err(IkError::NotAChain { joint, ancestor });
            }
        }
        let mut limb = Self {
            upper,
            lower,
            end,
            tip,
            hinge: DVec3::X,
            least_cos: 1.0,
        };
        let rest = skeleton.rest_pose();
        let posed = limb.posed(skeleton, &rest)?;
        let line = posed.line().normalize_or(posed.bones[0]);
        let side = posed.parent_from_model * bends_towards;
        let hinge = (side - line * side.dot(line)).cross(line).try_normalize();
        let hinge = hinge.filter(|_| bends_towards.is_finite());
        let hinge = hinge.ok_or(IkError::BadSetUp(
            "where the limb bends to is not finite, or lies along the limb",
        ))?;
        let upper_rotation = rotation_of(&rest.transforms[upper.index()]);
        limb.hinge = upper_rotation.conjugate() * hinge;
        Ok(limb)
    }

    /// The same limb with a least angle between its bones, radians: 0 is folded flat, pi is straight.
    ///
    /// # Errors
    /// [`IkError::BadSetUp`] if the angle is not from 0 to pi.
    pub fn with_least_angle(self, angle: f64) -> Result<Self, IkError> {
        if !(0.0..=core::f64::consts::PI).contains(&angle) {
            return Err(IkError::BadSetUp(
                "a limb's least angle is not from 0 to pi",
            ));
        }
        Ok(Self {
            least_cos: libm::cos(angle),
            ..self
        })
    }

    /// The joints: shoulder, elbow and hand, or hip, knee and foot. If the limb ends at a [point](TwoBone::to_point) in
    /// the lower joint's space, the elbow or knee comes twice.
    pub fn joints(&self) -> [JointId; 3] {
        [self.upper, self.lower, self.end]
    }

    /// The lengths of both bones in a pose, in the space of the upper joint's parent. These are model units if the
    /// parents do not scale.
    ///
    /// # Errors
    /// As [`TwoBone::solve`], for the pose.
    pub fn lengths(&self, skeleton: &Skeleton, pose: &Pose) -> Result<[f64; 2], IkError> {
        check_pose(skeleton, pose, self.joints())?;
        Ok(self.posed(skeleton, pose)?.lengths)
    }

    /// Turns the upper and the lower joint so that the end is at the target. With a `memory`, the elbow does not flip
    /// when the limb passes its pole; pass with it the seconds since the last call with this memory.
    ///
    /// The limb bends in the plane of the pose's bones. If they are straight, it bends in the plane in which it bends
    /// at rest. If they are bent the wrong way, it bends in their plane the right way. A pose that is at the target
    /// already is kept.
    ///
    /// # Errors
    /// [`IkError::NotFinite`] for the target, the pole or the pose; [`IkError::BadSetUp`] if `soft` is not more than 0
    /// and at most 1; [`IkError::NoJoint`] if the pose is not the skeleton's; [`IkError::NoLength`],
    /// [`IkError::NotInvertible`] and [`IkError::Sheared`] for the pose. The pose is then unchanged.
    pub fn solve(
        &self,
        skeleton: &Skeleton,
        pose: &mut Pose,
        goal: &TwoBoneGoal,
        memory: Option<(&mut PoleMemory, f64)>,
    ) -> Result<ReachResult, IkError> {
        check_pose(skeleton, pose, self.joints())?;
        if !goal.target.is_finite() {
            return Err(IkError::NotFinite("the target"));
        }
        if goal.pole.is_some_and(|pole| !pole.is_finite()) {
            return Err(IkError::NotFinite("the pole"));
        }
        if !(goal.soft > 0.0 && goal.soft <= 1.0) {
            return Err(IkError::BadSetUp(
                "a softness is not more than 0 and at most 1",
            ));
        }
        let posed = self.posed(skeleton, pose)?;
        let target = posed.parent_from_model * (goal.target - posed.origin) - posed.shoulder;
        let lengths = posed.lengths;
        let wanted = match goal.pole {
            Some(pole) => posed.parent_from_model * pole,
            None => self.side_of(&posed, target),
        };
        let direction = target.try_normalize();
        let pole = match (memory, direction) {
            (Some((memory, dt)), Some(direction)) => memory.side(direction, wanted, dt),
            _ => wanted,
        };
        let [a, b] = lengths;
        let least = (a * a + b * b - 2.0 * a * b * self.least_cos)
            .max(0.0)
            .sqrt();
        let solved = bend(lengths, target, pole, goal.soft, least);
        // Unit vectors, because the bones keep their lengths.
        let wanted = [solved.elbow / a, (solved.end - solved.elbow) / b];
        self.apply(pose, &posed, wanted);
        Ok(solved.reach)
    }

    /// The side to which the limb would bend if it were turned as it is to the target.
    fn side_of(&self, posed: &Posed, target: DVec3) -> DVec3 {
        let reach = posed.line();
        let (Some(from), Some(to)) = (reach.try_normalize(), target.try_normalize()) else {
            return posed.hinge.cross(posed.bones[0]);
        };
        // The hinge turned along with the line to the end. The elbow's side is perpendicular to both.
        let hinge = arc(from, to) * posed.hinge;
        to.cross(hinge)
    }

    /// Turns the two joints so that the bones point along the unit vectors `now`.
    fn apply(&self, pose: &mut Pose, posed: &Posed, now: [DVec3; 2]) {
        let [upper, lower] = [self.upper, self.lower].map(JointId::index);
        let was = posed.bones;
        let across = |hinge: DVec3, bone: DVec3| {
            (hinge - bone * hinge.dot(bone))
                .try_normalize()
                .unwrap_or_else(|| bone.any_orthonormal_vector())
        };
        let bent = now[0].cross(now[1]);
        let hinge_now = if bent.length() > STRAIGHT {
            bent
        } else {
            arc(was[0], now[0]) * posed.hinge
        };
        let turn = frame_turn(
            [was[0], across(posed.hinge, was[0])],
            [now[0], across(hinge_now, now[0])],
        );
        let upper_before = rotation_of(&pose.transforms[upper]);
        let upper_rotation = turn * upper_before;
        // The lower bone in the space of its joint's parent, before and after.
        let bone_was = posed.lower_from_upper * (upper_before.conjugate() * was[1]);
        let bone_now = posed.lower_from_upper * (upper_rotation.conjugate() * now[1]);
        let turn = arc(
            bone_was.normalize_or(DVec3::X),
            bone_now.normalize_or(DVec3::X),
        );
        let lower_rotation = turn * rotation_of(&pose.transforms[lower]);
        store_rotation(&mut pose.transforms[upper], upper_rotation);
        store_rotation(&mut pose.transforms[lower], lower_rotation);
    }

    fn posed(&self, skeleton: &Skeleton, pose: &Pose) -> Result<Posed, IkError> {
        let upper = &pose.transforms[self.upper.index()];
        let lower = &pose.transforms[self.lower.index()];
        // The transform from the lower joint's parent to the upper joint, over the joints between them.
        let between = between(skeleton, pose, self.upper, self.lower);
        let below = self.tip_below(skeleton, pose);
        let [upper_scale, lower_scale] = [upper, lower].map(|joint| joint.scale.as_dvec3());
        let linear = between.matrix3;
        let columns = [linear.x_axis, linear.y_axis, linear.z_axis];
        let [x, y, z] = columns.map(|column| upper_scale * column);
        let upper_from_lower = DMat3::from_cols(x, y, z);
        if !upper_from_lower.is_finite() {
            return Err(IkError::NotFinite("the pose"));
        }
        let lower_from_upper = uniform_inverse(&upper_from_lower, self.lower)?;
        let model_from_parent = model_from_parent(skeleton, pose, self.upper);
        if !model_from_parent.is_finite() {
            return Err(IkError::NotFinite("the pose"));
        }
        let parent_from_model = invertible(&model_from_parent.matrix3, self.upper)?;

        let rotation = rotation_of(upper);
        let elbow = between.transform_point3(lower.translation.as_dvec3());
        let first = rotation * (upper_scale * elbow);
        let tip = lower_scale * below;
        let second = rotation * (upper_from_lower * (rotation_of(lower) * tip));
        let lengths = [first.length(), second.length()];
        for (joint, length) in [(self.lower, lengths[0]), (self.end, lengths[1])] {
            if !length.is_finite() {
                return Err(IkError::NotFinite("the pose"));
            }
            if length < 1e-9 {
                return Err(IkError::NoLength(joint));
            }
        }
        let bones = [first / lengths[0], second / lengths[1]];
        // The hinge is perpendicular to the bones, in the sense of the natural hinge. Nearly straight bones use the
        // natural hinge itself.
        let natural = rotation * self.hinge;
        let bent = bones[0].cross(bones[1]);
        let sine = bent.length();
        let hinge = if sine <= STRAIGHT {
            natural
        } else {
            bent / sine.copysign(bent.dot(natural))
        };
        Ok(Posed {
            origin: model_from_parent.translation,
            parent_from_model,
            shoulder: upper.translation.as_dvec3(),
            bones,
            lengths,
            hinge,
            lower_from_upper,
        })
    }
}

/// The sine of the angle between two bones below which they count as straight. Rotations of poses are rounded to f32,
/// so the angle of the bones' plane is uncertain by 1e-7 divided by this.
const STRAIGHT: f64 = 1e-3;

/// The composed transform of the joints strictly between `upper` and `lower`.
fn between(skeleton: &Skeleton, pose: &Pose, upper: JointId, lower: JointId) -> DAffine3 {
    let mut product = DAffine3::IDENTITY;
    let mut next = skeleton.joints()[lower.index()].parent;
    while let Some(joint) = next.filter(|joint| *joint != upper) {
        product = pose.transforms[joint.index()].to_affine() * product;
        next = skeleton.joints()[joint.index()].parent;
    }
    product
}

/// Refuses a pose that does not have the skeleton's number of joints, and a skeleton that lacks one of the joints.
pub(super) fn check_pose(
    skeleton: &Skeleton,
    pose: &Pose,
    used: impl IntoIterator<Item = JointId>,
) -> Result<(), IkError> {
    let joints = skeleton.joints().len();
    if pose.transforms.len() != joints {
        return Err(IkError::NoJoint {
            joint: JointId(pose.transforms.len() as u32),
            joints,
        });
    }
    match used.into_iter().find(|joint| joint.index() >= joints) {
        Some(joint) => Err(IkError::NoJoint { joint, joints }),
        None => Ok(()),
    }
}

impl TwoBone {
    /// The limb's end in the space of the lower joint.
    fn tip_below(&self, skeleton: &Skeleton, pose: &Pose) -> DVec3 {
        if self.end == self.lower {
            return self.tip;
        }
        let end = pose.transforms[self.end.index()].to_affine();
        let below = between(skeleton, pose, self.lower, self.end) * end;
        below.transform_point3(self.tip)
    }

    /// Position of the limb's end in a pose, in model space.
    ///
    /// # Errors
    /// [`IkError::NoJoint`] and [`IkError::NotFinite`] for the pose.
    pub fn end(&self, skeleton: &Skeleton, pose: &Pose) -> Result<DVec3, IkError> {
        check_pose(skeleton, pose, self.joints())?;
        let model_from_end = model_from_joint(skeleton, pose, self.end);
        let end = model_from_end.transform_point3(self.tip);
        if end.is_finite() {
            Ok(end)
        } else {
            Err(IkError::NotFinite("the pose"))
        }
    }
}
