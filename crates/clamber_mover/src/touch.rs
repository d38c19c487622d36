use clamber_world::{Contact, ObstacleId, WorldCapsule};
use glam::DVec3;

/// A contact between the body and an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// The obstacle.
    pub obstacle: ObstacleId,
    /// Where and with what; its distance is from the body's axis.
    pub contact: Contact,
    /// Separation normal: unit vector from the contact to the nearest point of the body's axis. Where the axis is inside
    /// a solid, or was pressed through thin skin, the way out.
    pub normal: DVec3,
    /// It was met by a sweep or cast; otherwise it overlaps the body.
    pub swept: bool,
}

impl Touch {
    /// The contact points into the material: the body is behind the face.
    pub(crate) fn faces_inward(&self) -> bool {
        self.normal.dot(self.contact.normal) < 0.0
    }

    /// The same contact as seen by the body after it was pushed by `push`.
    pub(crate) fn after_push(&self, capsule: &WorldCapsule, push: DVec3) -> Self {
        let mut now = *self;
        let apart = capsule.nearest_on_axis(self.contact.point) - self.contact.point;
        if self.contact.distance > 0.0 && apart.dot(self.normal) > 0.0 {
            now.contact.distance = apart.length();
            now.normal = apart.normalize_or(self.normal);
        } else {
            // Past the contact point, its other side is no way out: the body goes back the way it came.
            now.contact.distance += self.normal.dot(push);
        }
        now
    }
}

/// The first contact of a body on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The contact, as it is at that time.
    pub touch: Touch,
    /// Share of the way made, 0 to 1.
    pub time: f64,
    /// They overlap at the start already; the time is 0.
    pub started_inside: bool,
}
