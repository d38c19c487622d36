use clamber_climber::ClimberState;
use foxglove::messages::FrameTransform;
use glam::{DMat3, DQuat, DVec3};

use super::{WORLD, Z_UP, rotation, timestamp, vector};

/// Transform of the world in the frame with Z up: a quarter turn about X, which takes +Y to +Z.
pub(crate) fn z_up(nanoseconds: u64) -> FrameTransform {
    let half = core::f64::consts::FRAC_1_SQRT_2;
    let turn = DQuat::from_xyzw(half, 0.0, 0.0, half);
    frame(nanoseconds, (Z_UP, WORLD), (DVec3::ZERO, turn))
}

/// A climber's frame: its centre, with +Z along its heading.
pub(crate) fn frame_of_climber(
    nanoseconds: u64,
    name: &str,
    state: &ClimberState,
) -> FrameTransform {
    let at = (state.position, facing(state.heading));
    frame(nanoseconds, (WORLD, name), at)
}

/// The position and the rotation of a frame in its parent's frame.
pub(crate) fn frame(
    nanoseconds: u64,
    (parent, child): (&str, &str),
    (position, turn): (DVec3, DQuat),
) -> FrameTransform {
    FrameTransform {
        timestamp: Some(timestamp(nanoseconds)),
        parent_frame_id: parent.to_owned(),
        child_frame_id: child.to_owned(),
        translation: Some(vector(position)),
        rotation: Some(rotation(turn)),
    }
}

/// The rotation that takes +Z to a unit vector and keeps Y as upright as possible.
fn facing(heading: DVec3) -> DQuat {
    let right = DVec3::Y.cross(heading).normalize_or(DVec3::X);
    DQuat::from_mat3(&DMat3::from_cols(right, heading.cross(right), heading))
}
