//! Where the palm of a hand and the sole of a foot are, measured in the bind pose.

use clamber_animation::ik::TwoBone;
use clamber_animation::joint_in_model;
use clamber_surface::rig::{JointId, Pose, Skeleton};
use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::{Humanoid, Limb, LimbEnd, Side};

/// The palm's middle, as a share of the forearm from the wrist; how far its skin is from the bone; the same for the
/// ankle above the sole, the heel behind and the ball before it, as shares of the leg. The hero's, rounded.
const PALM: f64 = 0.34;
const PALM_SKIN: f64 = 0.12;
const ANKLE: f64 = 0.09;
const HEEL: f64 = 0.055;
const BALL: f64 = 0.16;

/// Angles between the bones below which elbows and knees do not fold, radians: 20° and 25°.
const LEAST: [f64; 2] = [0.35, 0.44];

/// A hand or foot in space: where its joint is, and how it is turned. The turn takes X to where fingers or toes point,
/// and Y to where the back of the hand or the top of the foot faces, which is away from what it touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) position: DVec3,
    pub(crate) rotation: DQuat,
}

impl Place {
    pub(crate) fn point(&self, offset: DVec3) -> DVec3 {
        self.position + self.rotation * offset
    }

    /// The place whose point at `offset` is at `point`.
    pub(crate) fn with_point_at(point: DVec3, offset: DVec3, rotation: DQuat) -> Self {
        let position = point - rotation * offset;
        Self { position, rotation }
    }
}

/// What a body has to know of a limb, in metres.
#[derive(Clone, Debug)]
pub(crate) struct LimbShape {
    pub(crate) ik: TwoBone,
    pub(crate) upper: JointId,
    pub(crate) lower: JointId,
    pub(crate) end: LimbEnd,
    /// Length of the straight limb.
    pub(crate) length: f64,
    /// In the end joint's own space: where fingers or toes point, and away from what it touches.
    axes: [DVec3; 2],
    /// From the end joint to what touches: the middle of the palm, or the sole below the ankle. As [`Place`] is turned.
    pub(crate) contact: DVec3,
    /// From the end joint to the ball of the foot and the heel, on the sole. The palm twice for hands.
    pub(crate) ball: DVec3,
    pub(crate) heel: DVec3,
}

impl LimbShape {
    /// `bound` are all joints in model space in the bind pose, `scale` the metres per model unit.
    pub(crate) fn new(
        skeleton: &Skeleton,
        humanoid: &Humanoid,
        bound: &[DAffine3],
        (limb, side, is_hand): (&Limb, Side, bool),
        scale: f64,
    ) -> Self {
        let place = |joint: JointId| bound[joint.index()].translation;
        let elbow = place(limb.lower);
        let (joint, tip) = match limb.end {
            LimbEnd::Joint(joint) | LimbEnd::Beside(joint, _) => (Some(joint), place(joint)),
            LimbEnd::Point(point) => (None, bound[limb.lower.index()].transform_point3(point)),
        };
        let length = limb.length() * scale;
        let lower = limb.lengths[1] * scale;
        let (along, outward, contact, ball, heel) = if is_hand {
            let along = (tip - elbow).normalize_or(DVec3::NEG_Y);
            let palm = palm(skeleton, humanoid, bound, (limb, side), tip, along);
            let center = DVec3::new(PALM * lower, -PALM_SKIN * lower, 0.0);
            // A hand without a joint cannot be turned: its end is what touches.
            let center = if joint.is_some() { center } else { DVec3::ZERO };
            (along, -palm, center, center, center)
        } else {
            let toes = limb.toes.map(|toes| place(toes) - tip);
            let level = toes
                .map(|way| DVec3::new(way.x, 0.0, way.z))
                .filter(|way| way.length() * scale > 0.02 * length);
            let along = level.map_or(humanoid.facing, DVec3::normalize);
            let height = sole_height(tip.y * scale, length);
            let ball = level.map_or(BALL * length, |way| way.length() * scale);
            let at = |ahead: f64| DVec3::new(ahead, -height, 0.0);
            (along, DVec3::Y, at(0.0), at(ball), at(-HEEL * length))
        };
        let own = bound[joint.unwrap_or(limb.lower).index()].matrix3.inverse();
        let axes = [along, outward].map(|axis| (own * axis).normalize_or(DVec3::X));
        let least = LEAST[usize::from(!is_hand)];
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

    /// The axes of [`Place`] in the end joint's own space, for [`aim`](clamber_animation::ik::aim): the second one
    /// first, since palms and soles lie on what they touch.
    pub(crate) fn aim_axes(&self) -> [DVec3; 2] {
        [self.axes[1], self.axes[0]]
    }

    /// Where the limb ends in a pose, in metres in the space of the model.
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

/// The rotation that takes Y to a vector, and X as near to another one as that allows.
pub(crate) fn turned(along: DVec3, outward: DVec3) -> DQuat {
    let y = outward.normalize_or(DVec3::Y);
    let x = (along - y * along.dot(y)).normalize_or(y.any_orthonormal_vector());
    DQuat::from_mat3(&DMat3::from_cols(x, y, x.cross(y)))
}

/// The ankle's height above the sole. A model stands at a height of 0, unless that is nowhere near its feet.
pub(crate) fn sole_height(ankle: f64, leg: f64) -> f64 {
    if (0.03 * leg..=0.25 * leg).contains(&ankle) {
        ankle
    } else {
        ANKLE * leg
    }
}

/// Where the palm faces in the bind pose. The thumb tells; without one, hands at rest face the ground or the body.
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
