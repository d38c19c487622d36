use clamber_surface::geometry::slerp;
use glam::DVec3;

use super::Convex;
use crate::RigidPose;

/// A solid that moves over a tick. Each of its points moves in a straight line from its position under the pose
/// `before` at time 0 to its position in the solid's local space at time 1. The radius by which the core is rounded
/// stays the same.
#[derive(Clone, Copy)]
pub(in crate::shapes) struct MovingConvex<'a> {
    pub(in crate::shapes) convex: &'a Convex<'a>,
    /// Pose at time 0; `None` for a solid at rest.
    pub(in crate::shapes) before: Option<RigidPose>,
}

impl<'a> MovingConvex<'a> {
    pub(in crate::shapes) const fn still(convex: &'a Convex<'a>) -> Self {
        Self {
            convex,
            before: None,
        }
    }

    /// Position of the solid's point at a time.
    pub(in crate::shapes) fn point(&self, time: f64, point: DVec3) -> DVec3 {
        match &self.before {
            Some(before) => before.transform(point) * (1.0 - time) + point * time,
            None => point,
        }
    }

    /// Pose of a rigid body that moves along with the solid. At both ends of the tick the solid has exactly this pose.
    pub(in crate::shapes) fn place(&self, time: f64) -> RigidPose {
        let now = RigidPose::IDENTITY;
        self.before.map_or(now, |before| RigidPose {
            rotation: slerp(before.rotation, now.rotation, time),
            translation: before.translation * (1.0 - time),
        })
    }

    /// The point of the core at rest that is farthest along a direction at a time. A position is an affine function of
    /// the point at rest, so this is the support point along [`MovingConvex::at_rest`].
    pub(super) fn support(&self, time: f64, direction: DVec3) -> DVec3 {
        self.convex.support(self.at_rest(time, direction))
    }

    /// The direction at rest that corresponds to `direction` at a time: the transposed linear part of the motion
    /// applied to it.
    pub(in crate::shapes) fn at_rest(&self, time: f64, direction: DVec3) -> DVec3 {
        match &self.before {
            Some(before) => {
                let turned = before.rotation.conjugate() * direction;
                turned * (1.0 - time) + direction * time
            }
            None => direction,
        }
    }
}
