use clamber_surface::rig::{Clip, Playback};

use super::sample::within;
use super::{Animator, Layer, LayerKind};
use crate::error::within as check_within;
use crate::{AnimationError, AnimationSet, ClipId, RootDelta};

/// A marker or an end that an animator has passed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnimationEvent {
    /// A marker of a clip was passed.
    Marker {
        /// Index of the layer.
        layer: usize,
        /// The layer's clip.
        clip: ClipId,
        /// Index of the marker in [`Clip::markers`].
        marker: usize,
    },
    /// A clip that is played once has reached its end, or its start if it plays backwards.
    Ended {
        /// Index of the layer.
        layer: usize,
        /// The layer's clip.
        clip: ClipId,
    },
}

/// The most loops of a clip that one call of [`Animator::advance`] counts for root motion. It limits the work for a
/// very long `dt`.
const MOST_LOOPS: f64 = 1000.0;

impl Animator {
    /// Advances all layers by `dt` seconds. Appends to `events` the markers and ends that were passed: layer by layer,
    /// and within a layer in order of time. If `dt` spans several loops of a clip, each of its markers is reported
    /// once. Returns the root motion, mixed from the layers that override; it is zero unless the set has [root
    /// motion](AnimationSet::with_root_motion).
    ///
    /// # Errors
    /// [`AnimationError::OutOfRange`] if `dt` is negative or not finite, and the errors of [`Animator::pose_into`]. The
    /// animator and `events` are then unchanged.
    pub fn advance(
        &mut self,
        set: &AnimationSet,
        dt: f64,
        events: &mut Vec<AnimationEvent>,
    ) -> Result<RootDelta, AnimationError> {
        check_within("dt", "finite and not negative", dt, 0.0, f64::MAX)?;
        for layer in &self.layers {
            layer.check()?;
            set.clip(layer.clip)?;
            layer.mask.map(|mask| set.mask(mask)).transpose()?;
            let way = dt * self.rate * layer.speed;
            crate::error::finite("a layer's time", layer.time + way)?;
        }
        let mut motion = RootDelta::default();
        for (index, layer) in self.layers.iter_mut().enumerate() {
            let clip = set.clip(layer.clip)?;
            let way = dt * self.rate * layer.speed;
            let (from, _) = within(layer.time, clip.duration(), layer.playback);
            let (to, loops) = within(from + way, clip.duration(), layer.playback);
            if way != 0.0 {
                tell(events, index, layer, clip, [from, to], [way, loops]);
            }
            if let (Some(root), LayerKind::Override) = (set.root(), layer.kind) {
                let mask = layer.mask.map(|mask| set.mask(mask)).transpose()?;
                let share = mask.map_or(1.0, |mask| f64::from(mask.shares()[root.joint.index()]));
                let loops = loops.clamp(-MOST_LOOPS, MOST_LOOPS) as i32;
                let moved = root.between(clip, [from, to], loops)?;
                motion = motion.mix(&moved, share * layer.weight);
            }
            // A layer that holds (speed 0) keeps its time as it was given, also outside the clip.
            if way != 0.0 {
                layer.time = to;
            }
        }
        self.offsets.advance(dt);
        Ok(motion)
    }
}

/// Appends the markers between two times of a layer, and an event for the clip's end if it was reached.
fn tell(
    events: &mut Vec<AnimationEvent>,
    index: usize,
    layer: &Layer,
    clip: &Clip,
    [from, to]: [f64; 2],
    [way, loops]: [f64; 2],
) {
    let (layer_index, id) = (index, layer.clip);
    let mut marker = |marker: usize| {
        events.push(AnimationEvent::Marker {
            layer: layer_index,
            clip: id,
            marker,
        });
    };
    let markers = clip.markers();
    let times = |range: &dyn Fn(f64) -> bool, marker: &mut dyn FnMut(usize)| {
        let passed = |&k: &usize| range(markers[k].time);
        if way > 0.0 {
            (0..markers.len()).filter(passed).for_each(marker);
        } else {
            (0..markers.len()).rev().filter(passed).for_each(marker);
        }
    };
    let duration = clip.duration();
    let ended = layer.playback == Playback::Clamp && from != to && (to <= 0.0 || to >= duration);
    // A marker is passed when the time moves on from it, so a marker at the clip's start is reported. A clip that ends
    // here reports the markers at its end as well.
    match (loops != 0.0, way > 0.0) {
        (false, true) => times(&|t| from <= t && (t < to || ended && t <= to), &mut marker),
        (false, false) => times(&|t| t <= from && (t > to || ended && t >= to), &mut marker),
        (true, true) => {
            times(&|t| t >= from, &mut marker);
            let end = if loops > 1.0 { from } else { to.min(from) };
            times(&|t| t < end, &mut marker);
        }
        (true, false) => {
            times(&|t| t <= from, &mut marker);
            let end = if loops < -1.0 { from } else { to.max(from) };
            times(&|t| t > end, &mut marker);
        }
    }
    if ended {
        events.push(AnimationEvent::Ended {
            layer: index,
            clip: id,
        });
    }
}
