//! What bodies of one kind share: skeleton, clips, and measures taken from them.

mod clips;
mod error;
mod extremity;
mod gait;
mod limb_shape;
mod posture;

use clamber_animation::ik::LookAt;
use clamber_animation::{AnimationSet, JointMask, MaskId};
use clamber_surface::rig::{Clip, Skeleton};
use glam::DVec3;

pub use clips::BodyClip;
pub use error::FigureError;
pub use extremity::Extremity;

pub(crate) use clips::Clips;
pub(crate) use gait::{Gait, STRIDES, Stride};
pub(crate) use limb_shape::{LimbShape, Place, sole_height, turned};
pub(crate) use posture::Postures;

use crate::humanoid::reference;
use crate::{Humanoid, Side};

/// What all [bodies](crate::Body) of one kind share: the skeleton, which joint is what, and the clips.
///
/// Clips are found by name; [`BodyClip`] lists the names. A file without clips gets those of another figure by
/// [`Retarget`](crate::Retarget).
#[derive(Clone, Debug)]
pub struct Figure {
    skeleton: Skeleton,
    humanoid: Humanoid,
    set: AnimationSet,
    clips: Clips,
    scale: f64,
    /// Left hand, right hand, left foot, right foot.
    limbs: [LimbShape; 4],
    look: LookAt,
    gait: Gait,
    postures: Postures,
    upper_body: MaskId,
}

/// How much of a gaze's turn the joints of the neck take, each of what is left.
const NECK: f64 = 0.4;

impl Figure {
    /// A figure from a skeleton, its humanoid and clips, whose model units are metres.
    ///
    /// # Errors
    /// [`FigureError::NoIdle`] if no clip is called `idle`, [`FigureError::Animation`] and [`FigureError::Rig`] if the
    /// clips or the humanoid are another skeleton's, [`FigureError::Ik`] for a head that cannot be turned.
    pub fn new(
        skeleton: Skeleton,
        humanoid: Humanoid,
        clips: Vec<Clip>,
    ) -> Result<Self, FigureError> {
        Self::with_scale(skeleton, humanoid, clips, 1.0)
    }

    /// [`Figure::new`] at another size: `scale` is how many metres a unit of the model is. Steps are timed as for something
    /// of this size.
    ///
    /// # Errors
    /// As [`Figure::new`], and [`FigureError::Scale`] if the scale is not finite and more than 0.
    pub fn with_scale(
        skeleton: Skeleton,
        humanoid: Humanoid,
        clips: Vec<Clip>,
        scale: f64,
    ) -> Result<Self, FigureError> {
        if !(scale.is_finite() && scale > 0.0) {
            return Err(FigureError::Scale(scale));
        }
        crate::retarget::check(&humanoid, &skeleton)?;
        let mut set = AnimationSet::new(&skeleton, clips)?;
        let found = Clips::find(&set).ok_or(FigureError::NoIdle)?;
        let feet = [0, 1].map(|side| {
            let leg = &humanoid.legs[side];
            leg.end.joint().unwrap_or(leg.lower)
        });
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
        chain.extend(humanoid.neck.iter().rev().map(|joint| (*joint, NECK)));
        let look = LookAt::new(&skeleton, &chain, eye, own * humanoid.facing, DVec3::Y)?;
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

    /// Which joint is what.
    pub fn humanoid(&self) -> &Humanoid {
        &self.humanoid
    }

    /// The clips, and masks for layers.
    pub fn animations(&self) -> &AnimationSet {
        &self.set
    }

    /// Metres per unit of the model.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// True if a clip was found under its name; for the others, the nearest one is played.
    pub fn has(&self, clip: BodyClip) -> bool {
        self.clips.has(clip)
    }

    /// The mask of the joints above the hips, for layers that are added to [`Figure::animations`].
    pub fn upper_body(&self) -> MaskId {
        self.upper_body
    }

    /// Length of a straight leg, metres.
    pub fn leg_length(&self) -> f64 {
        self.limb(Extremity::Foot(Side::Left)).length
    }

    /// Length of a straight arm, metres, from shoulder to wrist.
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
