//! Positions of the palm of a hand and the sole of a foot relative to their joints, measured in the bind pose.

use clamber_animation::ik::TwoBone;
use clamber_animation::joint_in_model;
use clamber_surface::rig::{JointId, Pose, Skeleton};
use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::{Humanoid, Limb, LimbEnd, Side};

/// Distance of the palm's middle from the wrist along the hand, as a share of the forearm's length. The value is the
/// hero's, rounded.
const PALM_DISTANCE: f64 = 0.34;

/// Distance of the palm's skin from the hand's bone, as a share of the forearm's length. The value is the hero's,
/// rounded.
const PALM_SKIN: f64 = 0.12;

/// Height of the ankle above the sole, as a share of the leg's length. The value is the hero's, rounded.
const ANKLE_HEIGHT: f64 = 0.09;

/// Distance of the heel behind the ankle, as a share of the leg's length. The value is the hero's, rounded.
const HEEL_DISTANCE: f64 = 0.055;

/// Distance of the ball of the foot ahead of the ankle, as a share of the leg's length, for skeletons without toes. The
/// value is the hero's, rounded.
const BALL_DISTANCE: f64 = 0.16;

/// Least angles between the two bones of an arm and of a leg, radians: 20° and 25°. Elbows and knees do not fold
/// further.
const LEAST_BEND_ANGLES: [f64; 2] = [0.35, 0.44];

/// Position of a hand's or foot's joint, and its rotation. The rotation takes X to the direction of the fingers or
/// toes, and Y to the outward direction of the back of the hand or the top of the foot, away from the touched surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) position: DVec3,
    pub(crate) rotation: DQuat,
}

impl Place {
    pub(crate) fn point(&self, offset: DVec3) -> DVec3 {
        self.position + self.rotation * offset
    }

    /// The place at which the point at `offset` from the joint is at `point`.
    pub(crate) fn with_point_at(point: DVec3, offset: DVec3, rotation: DQuat) -> Self {
        let position = point - rotation * offset;
        Self { position, rotation }
    }
}

/// Measures of an arm or a leg. Lengths are metres.
#[derive(Clone, Debug)]
pub(crate) struct LimbShape {
    pub(crate) ik: TwoBone,
    pub(crate) upper: JointId,
    pub(crate) lower: JointId,
    pub(crate) end: LimbEnd,
    /// Length of the straight limb.
    pub(crate) length: f64,
    /// Directions in the end joint's own space: along the fingers or toes, and away from the touched surface.
    axes: [DVec3; 2],
    /// From the end joint to the point that touches, in the axes of [`Place`]: the middle of the palm, or the sole
    /// below the ankle.
    pub(crate) contact: DVec3,
    /// From the end joint to the ball of the foot on the sole, in the axes of [`Place`]. For a hand, the palm.
    pub(crate) ball: DVec3,
    /// From the end joint to the heel on the sole, in the axes of [`Place`]. For a hand, the palm.
    pub(crate) heel: DVec3,
}

impl LimbShape {
    /// `bound` holds all joints in model space in the bind pose. `scale` is the length of a model unit in metres.
    pub(crate) fn new(
        skeleton: &Skeleton,
        humanoid: &Humanoid,
        bound: &[DAffine3],
        (limb, side, is_hand): (&Limb, Side, bool),
        scale: f64,
    ) -> Self {
        let place = |joint: JointId| bound[joint.index()].translation;
        let elbow = place(limb.lower);
        let (joint, tip) = (limb.end.joint(), limb.end.place(limb.lower, bound));
        let length = limb.length() * scale;
        let lower = limb.lengths[1] * scale;
        let (along, outward, contact, ball, heel) = if is_hand {
            let along = (tip - elbow).normalize_or(DVec3::NEG_Y);
            let palm = palm(skeleton, humanoid, bound, (limb, side), tip, along);
            let center = DVec3::new(PALM_DISTANCE * lower, -PALM_SKIN * lower, 0.0);
            // A hand without a joint cannot be turned, so its end itself is the point that touches.
            let center = if joint.is_some() { center } else { DVec3::ZERO };
            (along, -palm, center, center, center)
        } else {
            let toes = limb.toes.map(|toes| place(toes) - tip);
            let level = toes
                .map(|way| DVec3::new(way.x, 0.0, way.z))
                .filter(|way| way.length() * scale > 0.02 * length);
            let along = level.map_or(humanoid.facing, DVec3::normalize);
            let height = sole_height(tip.y * scale, length);
            let ball = level.map_or(BALL_DISTANCE * length, |way| way.length() * scale);
            let at = |ahead: f64| DVec3::new(ahead, -height, 0.0);
            (
                along,
                DVec3::Y,
                at(0.0),
                at(ball),
                at(-HEEL_DISTANCE * length),
            )
        };
        let own = bound[joint.unwrap_or(limb.lower).index()].matrix3.inverse();
        let axes = [along, outward].map(|axis| (own * axis).normalize_or(DVec3::X));
        let least = LEAST_BEND_ANGLES[usize::from(!is_hand)];
        Self {
            ik: limb.ik.with_least_angle(least).unwrap_or(limb.ik),
            upper: limb.upper,
            lower: limb.lower,
            end: limb.end,
            length,
            axes,
            contact,
            ball,
            heel,
        }
    }

    /// The axes of [`Place`] in the end joint's own space, for [`aim`](clamber_animation::ik::aim). The outward one
    /// comes first and is met exactly, since palms and soles lie on the touched surface.
    pub(crate) fn aim_axes(&self) -> [DVec3; 2] {
        [self.axes[1], self.axes[0]]
    }

    /// The place of the limb's end in a pose, metres in model space.
    pub(crate) fn place(&self, skeleton: &Skeleton, pose: &Pose, scale: f64) -> Option<Place> {
        let lower = || joint_in_model(skeleton, pose, self.lower);
        let (model, tip) = match self.end {
            LimbEnd::Joint(joint) => {
                let model = joint_in_model(skeleton, pose, joint)?;
                (model, model.translation)
            }
            LimbEnd::Beside(joint, point) => (
                joint_in_model(skeleton, pose, joint)?,
                lower()?.transform_point3(point),
            ),
            LimbEnd::Point(point) => {
                let lower = lower()?;
                (lower, lower.transform_point3(point))
            }
        };
        let [along, outward] = self.axes.map(|axis| model.matrix3 * axis);
        Some(Place {
            position: tip * scale,
            rotation: turned(along, outward),
        })
    }
}

/// The rotation that takes Y to `outward`, and X as near to `along` as possible.
pub(crate) fn turned(along: DVec3, outward: DVec3) -> DQuat {
    let y = outward.normalize_or(DVec3::Y);
    let x = (along - y * along.dot(y)).normalize_or(y.any_orthonormal_vector());
    DQuat::from_mat3(&DMat3::from_cols(x, y, x.cross(y)))
}

/// Height of the ankle above the sole. The sole is at a height of 0 in model space, unless the ankle's height is
/// unlikely for a leg of this length; then the hero's share applies.
pub(crate) fn sole_height(ankle: f64, leg: f64) -> f64 {
    if (0.03 * leg..=0.25 * leg).contains(&ankle) {
        ankle
    } else {
        ANKLE_HEIGHT * leg
    }
}

/// Direction that the palm faces in the bind pose. The thumb's side decides it. Without a thumb, the palm faces the
/// ground and a little the body.
fn palm(
    skeleton: &Skeleton,
    humanoid: &Humanoid,
    bound: &[DAffine3],
    (limb, side): (&Limb, Side),
    wrist: DVec3,
    along: DVec3,
) -> DVec3 {
    let is_thumb = |joint: &JointId| {
        skeleton.joints()[joint.index()]
            .name
            .to_lowercase()
            .contains("thumb")
    };
    let thumb = limb.fingers.iter().find_map(|finger| {
        let last = finger.iter().rfind(|joint| is_thumb(joint))?;
        let way = bound[last.index()].translation - wrist;
        (way - along * way.dot(along)).try_normalize()
    });
    let sign = if side == Side::Left { 1.0 } else { -1.0 };
    let inward = humanoid.facing.cross(DVec3::Y) * sign;
    let guess = DVec3::NEG_Y + inward * 0.3;
    let wanted = thumb.map_or(guess, |thumb| along.cross(thumb) * sign);
    (wanted - along * wanted.dot(along)).normalize_or(along.any_orthonormal_vector())
}
