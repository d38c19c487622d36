use clamber_surface::parry::parry3d;
use glam::{DVec3, Vec3};
use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::Pose;
use parry3d::shape::Shape;

use super::{RigidPose, Tick};
use crate::WorldCapsule;

/// Share of coordinates by which a box is off in f32, four times over.
const LOOSE: f32 = 1e-6;

/// What a body did that moved over a tick, for a first guess at whether it was met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved {
    /// Where it was and is.
    pub tick: Tick,
    /// Holds the shape at both poses.
    bounds: Aabb,
    /// The sine of half the angle that it turned by.
    half_sine: f64,
}

impl Moved {
    /// A shape that went from the one pose to the other.
    pub fn new(shape: &dyn Shape, tick: Tick) -> Self {
        let at = |pose: &RigidPose| {
            let pose = Pose::from_parts(pose.translation.as_vec3(), pose.rotation.as_quat());
            shape.compute_aabb(&pose)
        };
        let bounds = at(&tick.before).merged(&at(&tick.now));
        let size = bounds.mins.abs().max(bounds.maxs.abs()).max_element();
        let turn = tick.now.rotation * tick.before.rotation.conjugate();
        Self {
            tick,
            bounds: bounds.loosened((size * LOOSE).min(f32::MAX)),
            half_sine: turn.xyz().length(),
        }
    }

    /// A box that is met by whatever of the capsule's way meets the shape in its own frame.
    ///
    /// There the ends go from x0 to x1 on straight lines, in the world from c0 to c1. At time t the two ways are
    /// `t (1 - t) (R1 - R0) (x1 - x0)` apart, for the rotations R0 and R1 of the body: at most half the sine of half its
    /// angle times the length of the way.
    pub(super) fn bounds(&self, capsule: &WorldCapsule, displacement: DVec3) -> Aabb {
        let Tick { before, now } = &self.tick;
        let slide = displacement - (now.translation - before.translation);
        let arm = capsule.ends.map(|end| (end - before.translation).length());
        let way = slide.length() + 2.0 * self.half_sine * arm[0].max(arm[1]);
        let slack = (0.5 * self.half_sine * way) as f32 * (1.0 + LOOSE);
        let slack = Vec3::splat(slack.min(f32::MAX));
        Aabb::new(self.bounds.mins - slack, self.bounds.maxs + slack)
    }
}
