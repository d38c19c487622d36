use clamber_surface::geometry::slerp;
use glam::DVec3;

use super::Convex;
use crate::RigidPose;

/// A solid over a tick: each of its points goes on a straight line from where a pose puts it at time 0 to where it is in
/// the solid's own space at time 1. What is rounded around the core stays as it is.
#[derive(Clone, Copy)]
pub(in crate::shapes) struct MovingConvex<'a> {
    pub(in crate::shapes) convex: &'a Convex<'a>,
    /// `None` for what stands still.
    pub(in crate::shapes) before: Option<RigidPose>,
}

impl<'a> MovingConvex<'a> {
    pub(in crate::shapes) const fn still(convex: &'a Convex<'a>) -> Self {
        Self {
            convex,
            before: None,
        }
    }

    /// Where a point of the solid is at a time.
    pub(in crate::shapes) fn point(&self, time: f64, point: DVec3) -> DVec3 {
        match &self.before {
            Some(before) => before.transform(point) * (1.0 - time) + point * time,
            None => point,
        }
    }

    /// Where the solid is at a time, as a rigid body would be: its points are there at both ends of the tick.
    pub(in crate::shapes) fn place(&self, time: f64) -> RigidPose {
        let now = RigidPose::IDENTITY;
        self.before.map_or(now, |before| RigidPose {
            rotation: slerp(before.rotation, now.rotation, time),
            translation: before.translation * (1.0 - time),
        })
    }

    /// The point of the resting core that lies farthest along a direction at a time. All places are affine in the
    /// point, so it is farthest along the direction that the transposed map makes of it.
    pub(super) fn support(&self, time: f64, direction: DVec3) -> DVec3 {
        self.convex.support(self.at_rest(time, direction))
    }

    /// The direction along which points of the resting solid differ as they do along `direction` at a time.
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
