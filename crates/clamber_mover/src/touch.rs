use std::cmp::Ordering;

use clamber_world::{Contact, ObstacleId, SweepContact, WorldCapsule};
use glam::DVec3;

/// A contact between the body and an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MoverContact {
    /// The obstacle.
    pub obstacle: ObstacleId,
    /// The contact itself. `contact.distance` is measured from the body's axis. It is negative inside a solid, and
    /// negated where the body was pressed through thin skin ([`Mover::overlap`](crate::Mover::overlap)).
    pub contact: Contact,
    /// Separation normal: unit vector from the contact to the nearest point of the body's axis. Where the axis is
    /// inside a solid, or was pressed through thin skin, the normal points outward.
    pub normal: DVec3,
    /// True if a sweep or cast found the contact; false if it overlaps the body.
    pub swept: bool,
}

impl MoverContact {
    /// Orders by distance, obstacle, material and point, so that the order in which contacts were found does not
    /// matter.
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

    /// True if the contact lies on the face of `other`, a contact that the body was inside of at the start of the tick.
    /// Such a contact is an inner edge of that face and adds no half-space. `start` is the position of the contact's
    /// material at the start of the tick, at most `length` off the plane of that face.
    pub(crate) fn continues(&self, start: DVec3, other: &Self, length: f64) -> bool {
        let out = other.contact.normal.dot(start - other.contact.point).abs();
        self.is_on_face_of(other) && out <= length
    }

    /// True if both contacts lie on faces of one obstacle with nearly the same normal.
    pub(crate) fn is_on_face_of(&self, other: &Self) -> bool {
        self.obstacle == other.obstacle && self.contact.normal.dot(other.contact.normal) > ONE_FACE
    }

    /// True if both contacts push the body away from one obstacle in nearly the same direction.
    pub(crate) fn pushes_like(&self, other: &Self) -> bool {
        self.obstacle == other.obstacle && self.normal.dot(other.normal) > ONE_FACE
    }

    pub(crate) fn is_finite(&self) -> bool {
        let contact = &self.contact;
        contact.point.is_finite() && contact.distance.is_finite() && self.normal.is_finite()
    }

    /// True if the separation normal points into the material: the body is behind the face.
    pub(crate) fn faces_inward(&self) -> bool {
        self.normal.dot(self.contact.normal) < 0.0
    }

    /// The same contact after the body was pushed by `push` to `capsule`.
    pub(crate) fn after_push(&self, capsule: &WorldCapsule, push: DVec3) -> Self {
        let mut now = *self;
        let apart = capsule.nearest_on_axis(self.contact.point) - self.contact.point;
        // A face continues beside the contact; an edge does not.
        let is_edge = self.normal.dot(self.contact.normal).abs() < SQUARE;
        if is_edge && self.contact.distance > 0.0 && apart.dot(self.normal) > 0.0 {
            now.contact.distance = apart.length();
            now.normal = apart.normalize_or(self.normal);
        } else {
            // On a face, and past an edge, the normal stays: the body leaves an edge on the side from which it came.
            now.contact.distance += self.normal.dot(push);
        }
        now
    }
}

/// What a sweep found, with the obstacle that it met.
pub(crate) fn met(obstacle: ObstacleId, sweep: &SweepContact) -> SweepContact<MoverContact> {
    SweepContact {
        fraction: sweep.fraction,
        contact: MoverContact {
            obstacle,
            contact: sweep.contact,
            normal: sweep.separation_normal,
            swept: true,
        },
        separation_normal: sweep.separation_normal,
        started_inside: sweep.started_inside,
    }
}

/// Cosine of the largest angle between neighbouring triangles of one face: 8 degrees, since skin bends.
const ONE_FACE: f64 = 0.99;

/// Cosine of the largest angle between the separation normal and the face's normal of a contact within a face: a
/// quarter of a degree, more than the rounding of f32.
const SQUARE: f64 = 0.99999;
