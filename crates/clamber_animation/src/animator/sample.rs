use clamber_surface::geometry::slerp;
use clamber_surface::rig::{Playback, Pose, Transform};
use glam::DQuat;

use super::{Animator, Layer, LayerKind};
use crate::pose::{rotation_of, store_rotation};
use crate::{AnimationError, AnimationSet, JointMask};

/// Scratch memory for [`Animator::pose_into`], kept from frame to frame so that the call does not allocate. It carries
/// no state.
#[derive(Clone, Debug, Default)]
pub struct PoseBuffers {
    sampled: Pose,
}

impl Animator {
    /// The pose at the animator's time. Allocates nothing once the pose and the buffers have the skeleton's size.
    ///
    /// # Errors
    /// [`AnimationError::NoClip`] or [`AnimationError::NoMask`] if a layer names a clip or mask that the set does not
    /// have, [`AnimationError::OutOfRange`] if a layer's number is not finite or its weight is not from 0 to 1. The
    /// pose's content is then undefined.
    pub fn pose_into(
        &self,
        set: &AnimationSet,
        pose: &mut Pose,
        buffers: &mut PoseBuffers,
    ) -> Result<(), AnimationError> {
        self.sample(set, 0.0, pose, buffers)
    }

    /// The pose `shift` seconds from now, if rate, speeds and layers stay as they are.
    pub(super) fn sample(
        &self,
        set: &AnimationSet,
        shift: f64,
        pose: &mut Pose,
        buffers: &mut PoseBuffers,
    ) -> Result<(), AnimationError> {
        pose.transforms.clone_from(&set.rest().transforms);
        for layer in &self.layers {
            layer.check()?;
            let time = layer.time + shift * layer.speed * self.rate;
            if layer.weight == 0.0 {
                set.clip(layer.clip)?;
                layer.mask.map(|mask| set.mask(mask)).transpose()?;
                continue;
            }
            match layer.kind {
                LayerKind::Override if layer.weight >= 1.0 && layer.mask.is_none() => {
                    sample_clip(set, layer, time, pose)?;
                }
                LayerKind::Override => {
                    sample_clip(set, layer, time, &mut buffers.sampled)?;
                    each_joint(set, layer, pose, |index, joint, share| {
                        *joint = mix(joint, &buffers.sampled.transforms[index], share);
                    })?;
                }
                LayerKind::Additive => {
                    let mask = layer.mask.map(|mask| set.mask(mask)).transpose()?;
                    sample_moved(set, layer, time, &mut buffers.sampled)?;
                    for (joint, first) in set.start(layer.clip) {
                        let index = joint.index();
                        let sampled = &buffers.sampled.transforms[index];
                        let share = share_of(mask, layer, index);
                        if first != sampled && share > 0.0 {
                            add(&mut pose.transforms[index], first, sampled, share);
                        }
                    }
                }
            }
        }
        self.offsets.add_to(pose, shift);
        Ok(())
    }
}

/// The pose of a layer's clip; joints that the clip does not move are at rest.
fn sample_clip(
    set: &AnimationSet,
    layer: &Layer,
    time: f64,
    pose: &mut Pose,
) -> Result<(), AnimationError> {
    pose.transforms.clone_from(&set.rest().transforms);
    sample_over(set, layer, time, pose)
}

/// As [`sample_clip`], but writes only the joints that the clip moves; the others keep their transforms.
fn sample_moved(
    set: &AnimationSet,
    layer: &Layer,
    time: f64,
    pose: &mut Pose,
) -> Result<(), AnimationError> {
    let rest = &set.rest().transforms;
    pose.transforms.resize(rest.len(), Transform::IDENTITY);
    for (joint, _) in set.start(layer.clip) {
        pose.transforms[joint.index()] = rest[joint.index()];
    }
    sample_over(set, layer, time, pose)
}

/// Writes the joints that a layer's clip moves into a pose in which they are at rest.
fn sample_over(
    set: &AnimationSet,
    layer: &Layer,
    time: f64,
    pose: &mut Pose,
) -> Result<(), AnimationError> {
    let clip = set.clip(layer.clip)?;
    // `Clamp` holds the clip's start at times before it.
    clip.sample_into(time, layer.playback, pose)?;
    if let Some(root) = set.root() {
        root.remove(clip, pose)?;
    }
    Ok(())
}

/// Calls `change` for every joint that a layer moves, with the joint's share of the layer.
fn each_joint(
    set: &AnimationSet,
    layer: &Layer,
    pose: &mut Pose,
    mut change: impl FnMut(usize, &mut Transform, f64),
) -> Result<(), AnimationError> {
    let mask = layer.mask.map(|mask| set.mask(mask)).transpose()?;
    for (index, joint) in pose.transforms.iter_mut().enumerate() {
        let share = share_of(mask, layer, index);
        if share > 0.0 {
            change(index, joint, share);
        }
    }
    Ok(())
}

/// A joint's share of a layer.
fn share_of(mask: Option<&JointMask>, layer: &Layer, joint: usize) -> f64 {
    mask.map_or(1.0, |mask| f64::from(mask.shares()[joint])) * layer.weight
}

/// A transform between two others: translation and scale linearly, rotation along the shorter arc.
fn mix(from: &Transform, to: &Transform, share: f64) -> Transform {
    let lerp = |a: glam::Vec3, b: glam::Vec3| (a.as_dvec3().lerp(b.as_dvec3(), share)).as_vec3();
    let mut mixed = Transform {
        translation: lerp(from.translation, to.translation),
        scale: lerp(from.scale, to.scale),
        rotation: from.rotation,
    };
    store_rotation(&mut mixed, slerp(rotation_of(from), rotation_of(to), share));
    mixed
}

/// Adds a share of the difference from `first` to `sampled` to a joint's transform.
fn add(joint: &mut Transform, first: &Transform, sampled: &Transform, share: f64) {
    let way = sampled.translation.as_dvec3() - first.translation.as_dvec3();
    joint.translation = (joint.translation.as_dvec3() + way * share).as_vec3();
    let turn = rotation_of(first).conjugate() * rotation_of(sampled);
    let turn = slerp(DQuat::IDENTITY, turn, share);
    store_rotation(joint, rotation_of(joint) * turn);
    let grown = sampled.scale.as_dvec3() - first.scale.as_dvec3();
    joint.scale = (joint.scale.as_dvec3() + grown * share).as_vec3();
}

/// Maps a layer's time into its clip: returns the time within the clip, and how many whole loops it is past.
pub(super) fn within(time: f64, duration: f64, playback: Playback) -> (f64, f64) {
    match playback {
        Playback::Loop if duration > 0.0 => (time.rem_euclid(duration), (time / duration).floor()),
        Playback::Loop => (0.0, 0.0),
        Playback::Clamp => (time.clamp(0.0, duration), 0.0),
    }
}
