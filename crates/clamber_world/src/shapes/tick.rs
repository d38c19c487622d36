use clamber_surface::geometry::MovingCapsule;
use clamber_surface::mesh::SurfaceTag;
use glam::DVec3;

use super::{ShapeSweep, ShapeTouch};
use crate::RigidPose;
use crate::{Contact, MaterialPoint, SweepContact, WorldCapsule};

/// Where a body stood a tick ago and stands now.
///
/// Its points are taken to go on straight lines from where they were to where they are, as the vertices of skin do. For
/// a body that turns by an angle meanwhile, a point at a distance r from what it turns about is off by at most
/// `r (1 - cos(angle / 2))`: 0.3 mm at 2 rad/s, 60 ticks a second and 2 m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// At time 0; `None` for what stands still.
    pub before: Option<RigidPose>,
    /// At time 1.
    pub now: RigidPose,
}

impl Tick {
    /// Of what stands still.
    pub const fn still(now: RigidPose) -> Self {
        Self { before: None, now }
    }

    /// A capsule whose ends go by a displacement each, as seen from where the body is now. All are in the space that the
    /// poses place the body in.
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

    /// A touch of such a sweep in the space of the poses, on the body that `key` names. It carries the default tag; the
    /// caller sets it.
    pub fn contact(&self, touch: &ShapeTouch, key: u64) -> SweepContact {
        let separation_normal =
            (self.now.rotation * touch.separation_normal).normalize_or(DVec3::Y);
        let normal = (self.now.rotation * touch.contact.normal).normalize_or(separation_normal);
        let at_rest = touch.contact.point;
        let now = self.now.transform(at_rest);
        let point = match &self.before {
            Some(before) => before.transform(at_rest) * (1.0 - touch.time) + now * touch.time,
            None => now,
        };
        SweepContact {
            time: touch.time,
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
