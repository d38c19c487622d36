//! A figure: the data that all bodies of one kind share.

mod clips;
mod extremity;
mod gait;
mod limb_shape;
mod posture;

use clamber_animation::ik::LookAt;
use clamber_animation::{AnimationSet, JointMask, MaskId};
use clamber_surface::rig::{Clip, Skeleton};
use glam::DVec3;

pub use clips::BodyClip;
pub use extremity::Extremity;

pub(crate) use clips::Clips;
pub(crate) use gait::{Gait, STRIDES, Stride};
pub(crate) use limb_shape::{LimbShape, Place, sole_height, turned};
pub(crate) use posture::Postures;

use crate::humanoid::reference;
use crate::{BodyError, Humanoid, Side};

/// The data that all [bodies](crate::Body) of one kind share: the skeleton, the roles of its joints, and the clips.
///
/// Clips are found by name; [`BodyClip`] lists the names. For a file without clips, [`Retarget`](crate::Retarget)
/// converts the clips of another figure.
#[derive(Clone, Debug)]
pub struct Figure {
    skeleton: Skeleton,
    humanoid: Humanoid,
    set: AnimationSet,
    clips: Clips,
    scale: f64,
    /// In the order of [`Extremity::ALL`].
    limbs: [LimbShape; 4],
    look: LookAt,
    gait: Gait,
    postures: Postures,
    upper_body: MaskId,
}

/// Share of the gaze's remaining turn that each joint of the neck takes. The last joint of the chain takes the rest.
const NECK_TURN_SHARE: f64 = 0.4;

impl Figure {
    /// A figure from a skeleton, its humanoid and its clips, with metres as model units.
    ///
    /// # Errors
    /// [`BodyError::NoIdle`] if no clip is called `idle`, [`BodyError::Animation`] or [`BodyError::Rig`] if the
    /// clips or the humanoid belong to another skeleton, [`BodyError::Head`] if the head cannot be turned.
    pub fn new(
        skeleton: Skeleton,
        humanoid: Humanoid,
        clips: Vec<Clip>,
    ) -> Result<Self, BodyError> {
        Self::with_scale(skeleton, humanoid, clips, 1.0)
    }

    /// [`Figure::new`] at another size: `scale` is the length of a model unit in metres. Clips play at the rate that
    /// suits a body of the resulting size.
    ///
    /// # Errors
    /// As [`Figure::new`], and [`BodyError::Scale`] if the scale is not a finite number above 0.
    pub fn with_scale(
        skeleton: Skeleton,
        humanoid: Humanoid,
        clips: Vec<Clip>,
        scale: f64,
    ) -> Result<Self, BodyError> {
        if !(scale.is_finite() && scale > 0.0) {
            return Err(BodyError::Scale(scale));
        }
        crate::retarget::check(&humanoid, &skeleton)?;
        let mut set = AnimationSet::new(&skeleton, clips)?;
        let found = Clips::find(&set).ok_or(BodyError::NoIdle)?;
        let feet = crate::retarget::feet(&humanoid);
        let bound = reference(&skeleton, humanoid.hips, humanoid.head, feet);
        let limb = |extremity: Extremity| {
            let limb = match extremity {
                Extremity::Hand(side) => (humanoid.arm(side), side, true),
                Extremity::Foot(side) => (humanoid.leg(side), side, false),
            };
            LimbShape::new(&skeleton, &humanoid, &bound, limb, scale)
        };
        let limbs = Extremity::ALL.map(limb);
        let head = &bound[humanoid.head.index()];
        let own = head.matrix3.inverse();
        let eye =
            own * (humanoid.facing * 0.5 + DVec3::Y * 0.5) * (0.1 * humanoid.legs[0].length());
        let mut chain = vec![(humanoid.head, 0.6)];
        chain.extend(
            humanoid
                .neck
                .iter()
                .rev()
                .map(|joint| (*joint, NECK_TURN_SHARE)),
        );
        let look = LookAt::new(&skeleton, &chain, eye, own * humanoid.facing, DVec3::Y)
            .map_err(BodyError::Head)?;
        let from = humanoid.spine.first().copied().unwrap_or(humanoid.hips);
        let mask = JointMask::branch(&skeleton, from)?;
        let upper_body = set.add_mask(mask)?;
        let gait = Gait::new(&skeleton, &set, &found, &limbs, humanoid.facing, scale)?;
        let postures = Postures::new(&skeleton, &humanoid, &set, &found, &limbs, scale)?;
        Ok(Self {
            skeleton,
            humanoid,
            set,
            clips: found,
            scale,
            limbs,
            look,
            gait,
            postures,
            upper_body,
        })
    }

    /// The skeleton.
    pub fn skeleton(&self) -> &Skeleton {
        &self.skeleton
    }

    /// Which joint of the skeleton is which part of a human body.
    pub fn humanoid(&self) -> &Humanoid {
        &self.humanoid
    }

    /// The clips of the figure, and the masks of joints for layers.
    pub fn animations(&self) -> &AnimationSet {
        &self.set
    }

    /// Length of a model unit, metres.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// True if the clip was found under its name. Otherwise another motion's clip replaces it.
    pub fn has(&self, clip: BodyClip) -> bool {
        self.clips.has(clip)
    }

    /// The mask of the joints above the hips, in [`Figure::animations`], for layers that move the upper body alone.
    pub fn upper_body(&self) -> MaskId {
        self.upper_body
    }

    /// Length of the left leg when it is straight, metres, from the hip joint to the ankle.
    pub fn leg_length(&self) -> f64 {
        self.limb(Extremity::Foot(Side::Left)).length
    }

    /// Length of the left arm when it is straight, metres, from the shoulder joint to the wrist.
    pub fn arm_length(&self) -> f64 {
        self.limb(Extremity::Hand(Side::Left)).length
    }

    pub(crate) fn limb(&self, extremity: Extremity) -> &LimbShape {
        &self.limbs[extremity.index()]
    }

    pub(crate) fn clips(&self) -> &Clips {
        &self.clips
    }

    pub(crate) fn look(&self) -> &LookAt {
        &self.look
    }

    pub(crate) fn gait(&self) -> &Gait {
        &self.gait
    }

    pub(crate) fn postures(&self) -> &Postures {
        &self.postures
    }
}
