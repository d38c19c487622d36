use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::Pose;
use parry3d::shape::Shape;

use super::Tick;
use crate::RigidPose;

/// Rounding error of a box in f32, four times over, as a fraction of its largest coordinate.
const LOOSE: f32 = 1e-6;

/// A body that moved over a tick, with a box around its whole path, in the space of its poses. Each of its points is
/// taken to move in a straight line.
///
/// For an [`Obstacle`](crate::Obstacle) that wraps a physics engine: the engine's own box may cover only the current
/// pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved {
    /// Poses at the start and the end of the tick.
    pub tick: Tick,
    /// A box around the shape at both poses, and so around all straight lines between them.
    pub bounds: Aabb,
}

impl Moved {
    /// A shape whose pose changed from `before` to `now`.
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
