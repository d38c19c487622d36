use std::cmp::Ordering;

use clamber_world::{Contact, ObstacleId, SweepContact, WorldCapsule};
use glam::DVec3;

/// A contact between the body and an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Touch {
    /// The obstacle.
    pub obstacle: ObstacleId,
    /// Where and with what. The distance is from the body's axis; it is negative inside a solid, and negated where the
    /// body was pressed through thin skin ([`Mover::overlap`](crate::Mover::overlap)).
    pub contact: Contact,
    /// Separation normal: unit vector from the contact to the nearest point of the body's axis. Where the axis is inside
    /// a solid, or was pressed through thin skin, the way out.
    pub normal: DVec3,
    /// It was met by a sweep or cast; otherwise it overlaps the body.
    pub swept: bool,
}

impl Touch {
    /// By depth, then obstacle, then material, so that the order in which contacts were met does not matter.
    pub(crate) fn order(a: &Self, b: &Self) -> Ordering {
        let depth = a.contact.distance.total_cmp(&b.contact.distance);
        let material = a.contact.material.key.cmp(&b.contact.material.key);
        let points = a.contact.point.to_array().into_iter();
        let points = points.zip(b.contact.point.to_array());
        let places = points.map(|(a, b)| a.total_cmp(&b));
        depth
            .then(a.obstacle.cmp(&b.obstacle))
            .then(material)
            .then(places.fold(Ordering::Equal, Ordering::then))
    }

    /// The contact, whose material was at `start` when the tick began, lies on the same face as another that the body is
    /// inside of then, and does not stand out from it by more than a length: its edge within that face is none.
    pub(crate) fn continues(&self, start: DVec3, other: &Self, length: f64) -> bool {
        let out = other.contact.normal.dot(start - other.contact.point).abs();
        self.is_on_face_of(other) && out <= length
    }

    /// Both lie on faces of one obstacle that point alike.
    pub(crate) fn is_on_face_of(&self, other: &Self) -> bool {
        self.obstacle == other.obstacle && self.contact.normal.dot(other.contact.normal) > ONE_FACE
    }

    /// Both push the body alike, away from one obstacle.
    pub(crate) fn pushes_like(&self, other: &Self) -> bool {
        self.obstacle == other.obstacle && self.normal.dot(other.normal) > ONE_FACE
    }

    pub(crate) fn is_finite(&self) -> bool {
        let contact = &self.contact;
        contact.point.is_finite() && contact.distance.is_finite() && self.normal.is_finite()
    }

    /// The contact points into the material: the body is behind the face.
    pub(crate) fn faces_inward(&self) -> bool {
        self.normal.dot(self.contact.normal) < 0.0
    }

    /// The same contact as seen by the body after it was pushed by `push`.
    pub(crate) fn after_push(&self, capsule: &WorldCapsule, push: DVec3) -> Self {
        let mut now = *self;
        let apart = capsule.nearest_on_axis(self.contact.point) - self.contact.point;
        // A face goes on beside the contact; an edge does not.
        let is_edge = self.normal.dot(self.contact.normal).abs() < SQUARE;
        if is_edge && self.contact.distance > 0.0 && apart.dot(self.normal) > 0.0 {
            now.contact.distance = apart.length();
            now.normal = apart.normalize_or(self.normal);
        } else {
            // Past an edge, its other side is no way out: the body goes back the way it came.
            now.contact.distance += self.normal.dot(push);
        }
        now
    }
}

/// The first contact of a body on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Hit {
    /// The contact, as it is at that time.
    pub touch: Touch,
    /// Share of the way made, 0 to 1.
    pub time: f64,
    /// They overlap at the start already; the time is 0.
    pub started_inside: bool,
}

impl Hit {
    pub(crate) fn new(obstacle: ObstacleId, sweep: &SweepContact) -> Self {
        Self {
            touch: Touch {
                obstacle,
                contact: sweep.contact,
                normal: sweep.separation_normal,
                swept: true,
            },
            time: sweep.time,
            started_inside: sweep.started_inside,
        }
    }
}

/// Cosine of the angle up to which neighbouring triangles are one face: 8 degrees, as skin bends.
const ONE_FACE: f64 = 0.99;

/// Cosine of the angle up to which a contact lies within a face, its normal that of the face: a quarter of a degree, above
/// the rounding of f32.
const SQUARE: f64 = 0.99999;
