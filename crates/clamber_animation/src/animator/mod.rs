mod layer;
mod play;
mod sample;

use clamber_surface::rig::{Playback, Pose};

pub use layer::{Layer, LayerKind};
pub use play::AnimationEvent;
pub use sample::PoseBuffers;

use crate::error::{finite, within};
use crate::inertialize::{Course, Offsets};
use crate::{AnimationError, AnimationSet, ClipId};

/// Plays clips on one creature: layers, transitions, time.
///
/// An animator is a plain value without references. The clips are in an [`AnimationSet`], which every call takes; the
/// pose is a function of the animator and its set. So a clone is a snapshot, and two equal animators play the same
/// poses.
///
/// ```
/// use clamber_animation::{AnimationSet, Animator, Layer, PoseBuffers};
/// # use clamber_surface::geometry::Affine;
/// # use clamber_surface::rig::*;
/// # let joint = Joint {
/// #     name: "root".into(), parent: None, rest: Transform::IDENTITY, inverse_bind: Affine::IDENTITY,
/// # };
/// # let skeleton = Skeleton::new(vec![joint])?;
/// # let times = vec![0.0, 1.0];
/// # let values = Keyframes::Translation(vec![glam::Vec3::ZERO, glam::Vec3::Y]);
/// # let channel = Channel::new(JointId(0), Interpolation::Linear, times, values)?;
/// # let clips = vec![Clip::new("idle", vec![]), Clip::new("walk", vec![channel])];
/// let set = AnimationSet::new(&skeleton, clips)?;
/// let (idle, walk) = (set.find("idle").ok_or("no idle")?, set.find("walk").ok_or("no walk")?);
///
/// let mut animator = Animator::new(vec![Layer::new(idle)]);
/// let (mut pose, mut buffers, mut events) = (set.rest().clone(), PoseBuffers::default(), Vec::new());
/// animator.play(&set, 0, walk, 0.3)?; // within 0.3 s
/// for _ in 0..60 {
///     events.clear();
///     animator.advance(&set, 1.0 / 60.0, &mut events)?; // events: markers that were passed
///     animator.pose_into(&set, &mut pose, &mut buffers)?;
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Animator {
    layers: Vec<Layer>,
    /// Seconds of the layers' time per second.
    rate: f64,
    /// Offsets from the present layers' pose to the pose before the last change. They decay.
    offsets: Offsets,
}

impl Default for Animator {
    /// An animator without layers: it plays the rest pose.
    fn default() -> Self {
        Self::new(Vec::new())
    }
}

/// Seconds between the two poses whose difference gives velocities. Poses are f32: a shorter step would show their
/// rounding, a longer one the change of velocity within it.
const STEP: f64 = 1.0 / 4096.0;

impl Animator {
    /// An animator that plays these layers, the lowest first.
    pub fn new(layers: Vec<Layer>) -> Self {
        Self {
            layers,
            rate: 1.0,
            offsets: Offsets::default(),
        }
    }

    /// The layers, the lowest first.
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// The layers, to set weights and speeds from frame to frame. Changes made here show at once; for a transition, use
    /// [`Animator::change`].
    pub fn layers_mut(&mut self) -> &mut [Layer] {
        &mut self.layers
    }

    /// Seconds of the layers' time per second; the default is 1.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Plays all layers at another rate; a negative rate plays backwards.
    ///
    /// # Errors
    /// [`AnimationError::OutOfRange`] if the rate is not finite.
    pub fn set_rate(&mut self, rate: f64) -> Result<(), AnimationError> {
        finite("the rate", rate)?;
        self.rate = rate;
        Ok(())
    }

    /// Sets the rate for clips that were made for one size, on a creature that is `scale` times as large: to `1 /
    /// sqrt(scale)`. Falls, swings and strides then keep the timing that gravity gives them (Froude's law; Alexander
    /// 1989, "Optimization and gaits in the locomotion of vertebrates").
    ///
    /// # Errors
    /// [`AnimationError::OutOfRange`] if the scale is not finite or not more than 0.
    pub fn set_scale(&mut self, scale: f64) -> Result<(), AnimationError> {
        let least = f64::MIN_POSITIVE;
        within(
            "the scale",
            "finite and more than 0",
            scale,
            least,
            f64::MAX,
        )?;
        self.rate = 1.0 / scale.sqrt();
        Ok(())
    }

    /// Changes the layers in any way. Within `fade` seconds, the pose becomes the new layers' pose, by inertialisation:
    /// it starts with the velocity that it had, and only the new layers are sampled. A fade of 0 shows the change at
    /// once. A change may come at any time, also during another change. Allocates.
    ///
    /// # Errors
    /// [`AnimationError::OutOfRange`] if the fade is negative or not finite, and the errors of [`Animator::pose_into`]
    /// for the layers before and after the change.
    pub fn change(
        &mut self,
        set: &AnimationSet,
        fade: f64,
        change: impl FnOnce(&mut Vec<Layer>),
    ) -> Result<(), AnimationError> {
        within("the fade", "finite and not negative", fade, 0.0, f64::MAX)?;
        let mut changed = self.clone();
        changed.offsets.clear();
        change(&mut changed.layers);
        let to = changed.course(set)?;
        if fade > 0.0 {
            let from = self.course(set)?;
            let courses = [&from, &to].map(|[now, then]| Course { now, then });
            let [from, to] = &courses;
            let offsets = &mut changed.offsets;
            offsets.restart(&self.offsets, from, to, [STEP, fade]);
        }
        *self = changed;
        Ok(())
    }

    /// Plays a clip on a layer from the clip's start; see [`Animator::change`].
    ///
    /// # Errors
    /// [`AnimationError::NoLayer`] if the layer does not exist, and the errors of [`Animator::change`].
    pub fn play(
        &mut self,
        set: &AnimationSet,
        layer: usize,
        clip: ClipId,
        fade: f64,
    ) -> Result<(), AnimationError> {
        let layers = self.layers.len();
        if layer >= layers {
            let found = layer;
            return Err(AnimationError::NoLayer { found, layers });
        }
        self.change(set, fade, |layers| {
            layers[layer].clip = clip;
            layers[layer].time = 0.0;
        })
    }

    /// True during a transition.
    pub fn is_fading(&self) -> bool {
        !self.offsets.is_empty()
    }

    /// An upper bound for the offsets that the current fade adds to any joint until it ends: in the units of
    /// translations, in radians, or as a change of scale. Infinite if one of the fade's numbers is not finite. The
    /// bound is coarse, and serves to detect restored animators that are broken.
    pub fn fade_bound(&self) -> f64 {
        self.offsets.bound()
    }

    /// The pose now, and the pose [`STEP`] seconds later at the present speeds.
    fn course(&self, set: &AnimationSet) -> Result<[Pose; 2], AnimationError> {
        let mut buffers = PoseBuffers::default();
        let mut at = |shift: f64| -> Result<Pose, AnimationError> {
            let mut pose = Pose::default();
            self.sample(set, shift, &mut pose, &mut buffers)?;
            Ok(pose)
        };
        Ok([at(0.0)?, at(STEP)?])
    }
}

impl Layer {
    /// A layer that plays a clip in a loop and fully replaces the layers below.
    pub fn new(clip: ClipId) -> Self {
        Self {
            clip,
            time: 0.0,
            speed: 1.0,
            weight: 1.0,
            playback: Playback::Loop,
            kind: LayerKind::Override,
            mask: None,
        }
    }

    /// A layer that plays a clip once and holds its end.
    pub fn once(clip: ClipId) -> Self {
        Self {
            playback: Playback::Clamp,
            ..Self::new(clip)
        }
    }
}
