//! Where a hand or foot holds or stands, and how such a place is found.

use clamber_world::{Attachment, Contact, Obstacle, ObstacleId, SurfaceTag};
use glam::{DQuat, DVec3};

use super::carry::SLACK;
use crate::figure::{Place, turned};

/// What a body can touch.
#[derive(Clone, Copy)]
pub(crate) struct Surroundings<'a> {
    pub(crate) obstacles: &'a [(ObstacleId, &'a dyn Obstacle)],
    pub(crate) dt: f64,
}

/// A contact, and whose it is.
#[derive(Clone, Copy)]
pub(crate) struct Found<'a> {
    pub(crate) id: ObstacleId,
    pub(crate) obstacle: &'a dyn Obstacle,
    pub(crate) contact: Contact,
}

impl<'a> Surroundings<'a> {
    pub(crate) fn get(&self, id: ObstacleId) -> Option<&'a dyn Obstacle> {
        let found = self.obstacles.iter().find(|(other, _)| *other == id);
        found.map(|(_, obstacle)| *obstacle)
    }

    /// The first contact of a ray; `direction` is a unit vector. What begins inside of something finds nothing there.
    pub(crate) fn cast(&self, from: DVec3, direction: DVec3, length: f64) -> Option<Found<'a>> {
        let hits = self.obstacles.iter().filter_map(|&(id, obstacle)| {
            let contact = obstacle.cast_ray(from, direction, length)?;
            let is_outside = contact.distance > 0.0 && contact.normal.dot(direction) < 0.0;
            is_outside.then_some(Found {
                id,
                obstacle,
                contact,
            })
        });
        hits.min_by(|a, b| by_distance(a, b))
    }

    /// The nearest contact within a distance.
    pub(crate) fn nearest(&self, point: DVec3, reach: f64) -> Option<Found<'a>> {
        let hits = self.obstacles.iter().filter_map(|&(id, obstacle)| {
            let contact = obstacle.closest_point(point, reach)?;
            Some(Found {
                id,
                obstacle,
                contact,
            })
        });
        hits.min_by(|a, b| by_distance(a, b))
    }
}

/// The nearer one; at equal distances that with the smaller id.
fn by_distance(a: &Found<'_>, b: &Found<'_>) -> core::cmp::Ordering {
    let distances = a.contact.distance.total_cmp(&b.contact.distance);
    distances.then(a.id.cmp(&b.id))
}

/// A material point that a hand or foot is on, and how it lies there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hold {
    pub(crate) attachment: Attachment,
    pub(crate) tag: SurfaceTag,
    /// Of the skin, in the frame of the material.
    normal: DVec3,
    /// How the hand or foot is turned there, in the frame of the material.
    turn: DQuat,
    /// The point of the hand or foot that touches, as [`Place`] is turned.
    pub(crate) touching: DVec3,
}

impl Hold {
    /// On a contact, turned to directions in world space: where fingers or toes point, and where the back of the hand
    /// or foot faces.
    pub(crate) fn new(found: &Found<'_>, along: DVec3, outward: DVec3, touching: DVec3) -> Self {
        let Found {
            id,
            obstacle,
            contact,
        } = found;
        let attachment = Attachment::new(*id, *obstacle, contact, contact.point);
        let inverse = attachment.frame.conjugate();
        Self {
            attachment,
            tag: contact.tag,
            normal: inverse * contact.normal,
            turn: inverse * turned(along, outward),
            touching,
        }
    }

    /// Moves on with the material. False if it is gone.
    pub(crate) fn follow(&mut self, around: &Surroundings<'_>) -> bool {
        let dt = around.dt.max(f64::MIN_POSITIVE);
        let obstacle = around.get(self.attachment.obstacle);
        obstacle.is_some_and(|obstacle| self.attachment.follow(obstacle, dt, SLACK).is_some())
    }

    pub(crate) fn point(&self) -> DVec3 {
        self.attachment.point
    }

    pub(crate) fn normal(&self) -> DVec3 {
        self.attachment.frame * self.normal
    }

    pub(crate) fn rotation(&self) -> DQuat {
        self.attachment.frame * self.turn
    }

    /// Where the hand or foot is.
    pub(crate) fn place(&self) -> Place {
        Place::with_point_at(self.point(), self.touching, self.rotation())
    }
}
