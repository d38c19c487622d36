//! Turns a model that does not look along +Z in its file.

use clamber_animation::rig::{Channel, Clip, Joint, Keyframes, RigError, Skeleton};
use glam::DQuat;

use super::additions::with_channels;
use super::file::Facing;

/// The skeleton and the clips, turned to look along +Z: the root joints are turned about Y, at rest and in all clips.
pub(crate) fn turned(
    skeleton: Skeleton,
    clips: Vec<Clip>,
    facing: Facing,
) -> Result<(Skeleton, Vec<Clip>), RigError> {
    let half = core::f64::consts::FRAC_1_SQRT_2;
    let turn = match facing {
        Facing::PlusZ => return Ok((skeleton, clips)),
        Facing::MinusZ => DQuat::from_xyzw(0.0, 1.0, 0.0, 0.0),
        Facing::PlusX => DQuat::from_xyzw(0.0, -half, 0.0, half),
        Facing::MinusX => DQuat::from_xyzw(0.0, half, 0.0, half),
    };
    let mut joints: Vec<Joint> = skeleton.joints().to_vec();
    let roots: Vec<bool> = joints.iter().map(|joint| joint.parent.is_none()).collect();
    for joint in joints.iter_mut().filter(|joint| joint.parent.is_none()) {
        let rest = &mut joint.rest;
        rest.rotation = (turn * rest.rotation.as_dquat()).as_quat();
        rest.translation = (turn * rest.translation.as_dvec3()).as_vec3();
    }
    let clip = |clip: &Clip| -> Result<Clip, RigError> {
        let channels = clip.channels().iter().map(|channel| {
            if roots.get(channel.joint().index()) != Some(&true) {
                return Ok(channel.clone());
            }
            let mut values = channel.values().clone();
            // Tangents of splines are turned like values.
            match &mut values {
                Keyframes::Translation(values) => {
                    for value in values {
                        *value = (turn * value.as_dvec3()).as_vec3();
                    }
                }
                Keyframes::Rotation(values) => {
                    for value in values {
                        *value = (turn * value.as_dquat()).as_quat();
                    }
                }
                Keyframes::Scale(_) => {}
            }
            let times = channel.times().to_vec();
            Channel::new(channel.joint(), channel.interpolation(), times, values)
        });
        with_channels(clip, channels.collect::<Result<_, _>>()?)
    };
    let clips: Result<Vec<Clip>, RigError> = clips.iter().map(clip).collect();
    Ok((Skeleton::new(joints)?, clips?))
}
