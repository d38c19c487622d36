use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::Pose;
use parry3d::shape::Shape;

use super::Tick;
use crate::RigidPose;

/// Share of coordinates by which a box is off in f32, four times over.
const LOOSE: f32 = 1e-6;

/// A body that moved over a tick, with a box around its whole path: an engine's own box may hold its current pose only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved {
    /// Where it was and is.
    pub tick: Tick,
    /// Holds the shape at both poses, and so all lines between.
    pub bounds: Aabb,
}

impl Moved {
    /// A shape that went from the one pose to the other.
    pub fn new(shape: &dyn Shape, before: RigidPose, now: RigidPose) -> Self {
        let at = |pose: &RigidPose| {
            let pose = Pose::from_parts(pose.translation.as_vec3(), pose.rotation.as_quat());
            shape.compute_aabb(&pose)
        };
        let bounds = at(&before).merged(&at(&now));
        let size = bounds.mins.abs().max(bounds.maxs.abs()).max_element();
        Self {
            tick: Tick {
                before: Some(before),
                now,
            },
            bounds: bounds.loosened((size * LOOSE).min(f32::MAX)),
        }
    }
}
