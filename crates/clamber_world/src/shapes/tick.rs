use clamber_surface::geometry::{MovingCapsule, slerp};
use clamber_surface::mesh::SurfaceTag;
use glam::DVec3;

use super::{RigidPose, ShapeTouch};
use crate::{Contact, MaterialPoint, SweepContact, WorldCapsule};

/// Where a body stood a tick ago and stands now; one pose twice for what stands still.
///
/// In the body's own frame, the ends of a capsule are taken to move on straight lines from where they are seen before
/// to where they are seen now. A body that turns by an angle meanwhile, seen from a distance r, makes of that an error
/// of at most `r (1 - cos(angle / 2))`: 0.3 mm at 2 rad/s, 60 ticks a second and 2 m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// At time 0.
    pub before: RigidPose,
    /// At time 1.
    pub now: RigidPose,
}

impl Tick {
    /// Of what stands still.
    pub const fn still(pose: RigidPose) -> Self {
        Self {
            before: pose,
            now: pose,
        }
    }

    /// A capsule that moves by `displacement`, in the body's frame. Both are in the space that the poses place the
    /// body in.
    pub fn path(&self, capsule: &WorldCapsule, displacement: DVec3) -> MovingCapsule {
        let end = |end: DVec3| self.now.inverse_transform(end + displacement);
        MovingCapsule {
            start: capsule.ends.map(|end| self.before.inverse_transform(end)),
            end: capsule.ends.map(end),
            radius: capsule.radius,
        }
    }

    /// A touch in the body's frame, in the space of the poses, on the body that `key` names.
    pub fn contact(
        &self,
        touch: &ShapeTouch,
        capsule: &WorldCapsule,
        displacement: DVec3,
        key: u64,
    ) -> SweepContact {
        let rotation = if self.before == self.now {
            self.now.rotation
        } else {
            slerp(self.before.rotation, self.now.rotation, touch.time)
        };
        let away = (rotation * touch.away).normalize_or(DVec3::Y);
        let normal = (rotation * touch.contact.normal).normalize_or(away);
        let point = if touch.time == 0.0 {
            self.before.transform(touch.contact.point)
        } else {
            // As the capsule sees it, so that point, direction and distance agree.
            let [a, b] = capsule.moved(displacement * touch.time).ends;
            a + (b - a) * touch.on_axis - away * touch.contact.distance
        };
        SweepContact {
            time: touch.time,
            contact: Contact {
                point,
                normal,
                distance: touch.contact.distance,
                material: MaterialPoint {
                    key,
                    coordinates: touch.contact.point.to_array(),
                },
                tag: SurfaceTag::default(),
            },
            away,
            started_inside: touch.started_inside,
        }
    }
}
