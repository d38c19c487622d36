use std::collections::HashSet;

use clamber_climber::ClimberState;
use clamber_surface::rig::Skeleton;
use foxglove::messages::{FrameTransform, FrameTransforms};
use glam::{DMat3, DQuat, DVec3};

use super::{CLIMBER, CREATURE, WORLD, Z_UP, place, rotation, timestamp, upright, vector};
use crate::taken::Taken;

/// Number of transforms before the joints' transforms: world, creature and climber.
const OWN: usize = 3;

/// Transforms of creature, climber and joints. The parent of every joint is the creature, not the parent joint, because
/// these transforms have no scale.
pub(crate) struct Frames {
    /// Updated in place in every tick, so that its names and its memory are reused.
    message: FrameTransforms,
}

impl Frames {
    pub(crate) fn new(skeleton: &Skeleton) -> Self {
        let frame = |parent: &str, child: String| FrameTransform {
            timestamp: None,
            parent_frame_id: parent.to_owned(),
            child_frame_id: child,
            translation: Some(vector(DVec3::ZERO)),
            rotation: Some(rotation(DQuat::IDENTITY)),
        };
        let mut transforms = vec![
            z_up(0),
            frame(WORLD, CREATURE.to_owned()),
            frame(WORLD, CLIMBER.to_owned()),
        ];
        let own = [WORLD, CREATURE, CLIMBER, Z_UP].map(str::to_owned);
        let mut taken: HashSet<String> = own.into();
        for (index, joint) in skeleton.joints().iter().enumerate() {
            let mut name = joint.name.clone();
            if name.is_empty() || taken.contains(&name) {
                name = format!("{name}#{index}");
            }
            taken.insert(name.clone());
            transforms.push(frame(CREATURE, name));
        }
        Self {
            message: FrameTransforms { transforms },
        }
    }

    /// Updates the message. Joints that the palette lacks keep their last transform.
    pub(crate) fn update(&mut self, nanoseconds: u64, taken: &Taken) -> &FrameTransforms {
        let (state, world_from_model) = (&taken.state, &taken.world_from_model);
        let now = timestamp(nanoseconds);
        let (own, joints) = self.message.transforms.split_at_mut(OWN);
        if let [root, creature, climber] = own {
            root.timestamp = Some(now);
            let turn = world_from_model.rotation;
            place(creature, now, world_from_model.translation, turn);
            place(climber, now, state.position, facing(state.heading));
        }
        for (joint, placed) in joints.iter_mut().zip(&taken.joints) {
            let position = placed.translation * world_from_model.scale;
            place(joint, now, position, upright(&placed.matrix3));
        }
        &self.message
    }
}

/// Transform of the world in the frame with Z up: a quarter turn about X, which takes +Y to +Z.
pub(crate) fn z_up(nanoseconds: u64) -> FrameTransform {
    let half = core::f64::consts::FRAC_1_SQRT_2;
    let turn = DQuat::from_xyzw(half, 0.0, 0.0, half);
    frame(nanoseconds, Z_UP, WORLD, (DVec3::ZERO, turn))
}

/// A climber's frame: its centre, with +Z along its heading.
pub(crate) fn frame_of_climber(
    nanoseconds: u64,
    name: &str,
    state: &ClimberState,
) -> FrameTransform {
    let at = (state.position, facing(state.heading));
    frame(nanoseconds, WORLD, name, at)
}

fn frame(
    nanoseconds: u64,
    parent: &str,
    child: &str,
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
