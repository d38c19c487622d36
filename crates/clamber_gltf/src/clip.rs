//! Loads animations as clips.

use std::collections::BTreeMap;

use clamber_surface::rig::{Channel, Clip, Interpolation, JointId, Keyframes};
use glam::{Quat, Vec3};
use gltf::animation::{self, Property};

use crate::accessor::Reader;
use crate::contents::Contents;
use crate::extras;
use crate::transforms::without_rounding;
use crate::{GltfErrorKind, ImportWarning};

/// Loads all animations that move the skeleton, each with only the channels that move it.
pub(crate) fn load(
    contents: &Contents<'_>,
    of_node: &BTreeMap<usize, Vec<JointId>>,
    warnings: &mut Vec<ImportWarning>,
) -> Result<Vec<Clip>, GltfErrorKind> {
    let mut clips = Vec::new();
    let reader = &contents.reader;
    for animation in contents.document.animations() {
        let name = match animation.name() {
            Some(name) => name.to_owned(),
            None => format!("clip {}", animation.index()),
        };
        let mut channels = Vec::new();
        let mut passed_over = 0;
        for (index, channel) in animation.channels().enumerate() {
            let target = channel.target();
            let object = || format!("animation {name:?}, channel {index}");
            // Channels of nodes outside the skeleton are not read at all.
            let joints = of_node.get(&target.node().index());
            let values = joints.map(|_| keyframes(&channel, reader)).transpose()?;
            match (joints, values.flatten()) {
                (Some(joints), Some(values)) => {
                    push_channels(&mut channels, &channel, joints, values, reader, object)?;
                }
                _ => passed_over += 1,
            }
        }
        if channels.is_empty() {
            warnings.push(ImportWarning::UnusedAnimation { animation: name });
            continue;
        }
        if passed_over > 0 {
            warnings.push(ImportWarning::UnusedChannels {
                animation: name.clone(),
                channels: passed_over,
            });
        }
        clips.push(extras::with_markers(&animation, Clip::new(name, channels))?);
    }
    Ok(clips)
}

/// Adds a channel for every joint of the node.
fn push_channels(
    channels: &mut Vec<Channel>,
    channel: &animation::Channel<'_>,
    joints: &[JointId],
    values: Keyframes,
    reader: &Reader<'_>,
    object: impl Fn() -> String,
) -> Result<(), GltfErrorKind> {
    let object = object();
    let sampler = channel.sampler();
    let times = reader.floats::<1>(&sampler.input())?.into_flattened();
    let interpolation = match sampler.interpolation() {
        animation::Interpolation::Step => Interpolation::Step,
        animation::Interpolation::Linear => Interpolation::Linear,
        animation::Interpolation::CubicSpline => Interpolation::CubicSpline,
    };
    for joint in joints {
        // Each key takes at most a time and three rotations: a spline's value and its two tangents.
        reader.charge(&object, times.len() * 13 * size_of::<f32>())?;
        let channel = Channel::new(*joint, interpolation, times.clone(), values.clone());
        channels.push(channel.map_err(|rig| GltfErrorKind::invalid(&object, rig))?);
    }
    Ok(())
}

/// The values of a channel; `None` for morph target weights.
fn keyframes(
    channel: &animation::Channel<'_>,
    reader: &Reader<'_>,
) -> Result<Option<Keyframes>, GltfErrorKind> {
    let output = channel.sampler().output();
    let vectors = || -> Result<Vec<Vec3>, GltfErrorKind> {
        let values = reader.floats::<3>(&output)?;
        Ok(values.into_iter().map(Vec3::from_array).collect())
    };
    Ok(match channel.target().property() {
        Property::Translation => Some(Keyframes::Translation(vectors()?)),
        Property::Scale => {
            let mut values = vectors()?;
            // A spline also has tangents, which are no scales.
            if channel.sampler().interpolation() != animation::Interpolation::CubicSpline {
                values
                    .iter_mut()
                    .for_each(|value| *value = without_rounding(*value));
            }
            Some(Keyframes::Scale(values))
        }
        Property::Rotation => {
            let values = reader.floats::<4>(&output)?;
            Some(Keyframes::Rotation(
                values.into_iter().map(Quat::from_array).collect(),
            ))
        }
        Property::MorphTargetWeights => None,
    })
}
