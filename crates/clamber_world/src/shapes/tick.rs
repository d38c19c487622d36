use clamber_surface::geometry::MovingCapsule;
use clamber_surface::mesh::SurfaceTag;
use glam::DVec3;

use super::{ShapeContact, ShapeSweep};
use crate::RigidPose;
use crate::{Contact, MaterialPoint, SweepContact, WorldCapsule};

/// Poses of a body at the start and the end of a tick.
///
/// Each point of the body is taken to move in a straight line from its previous to its current position, as the
/// vertices of skin do. If the body turns by an angle over the tick, a point at the distance r from the axis is off its
/// arc by at most `r (1 - cos(angle / 2))`: 0.3 mm at 2 rad/s, 60 ticks a second and 2 m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// Pose at time 0; `None` for a body at rest.
    pub before: Option<RigidPose>,
    /// Pose at time 1.
    pub now: RigidPose,
}

impl Tick {
    /// The tick of a body at rest.
    pub const fn still(now: RigidPose) -> Self {
        Self { before: None, now }
    }

    /// The sweep of a capsule in the body's current local space. Each end of the capsule moves by its own displacement;
    /// both are given in the space of the poses.
    pub fn sweep(&self, capsule: &WorldCapsule, displacements: [DVec3; 2]) -> ShapeSweep {
        let local = |ends: [DVec3; 2]| ends.map(|end| self.now.inverse_transform(end));
        ShapeSweep {
            path: MovingCapsule {
                start: local(capsule.ends),
                end: local(capsule.with_ends_moved(displacements).ends),
                radius: capsule.radius,
            },
            before: self
                .before
                .map(|before| self.now.inverse().compose(&before)),
        }
    }

    /// Converts the result of such a sweep to the space of the poses. `key` becomes the [`MaterialPoint::key`]. The tag
    /// is the default; the caller sets it.
    pub fn contact(&self, touch: &SweepContact<ShapeContact>, key: u64) -> SweepContact {
        let separation_normal =
            (self.now.rotation * touch.separation_normal).normalize_or(DVec3::Y);
        let normal = (self.now.rotation * touch.contact.normal).normalize_or(separation_normal);
        let at_rest = touch.contact.point;
        let now = self.now.transform(at_rest);
        let point = match &self.before {
            Some(before) => {
                before.transform(at_rest) * (1.0 - touch.fraction) + now * touch.fraction
            }
            None => now,
        };
        SweepContact {
            fraction: touch.fraction,
            contact: Contact {
                point,
                normal,
                distance: touch.contact.distance,
                material: MaterialPoint {
                    key,
                    coordinates: at_rest.to_array(),
                },
                tag: SurfaceTag::default(),
            },
            separation_normal,
            started_inside: touch.started_inside,
        }
    }
}
