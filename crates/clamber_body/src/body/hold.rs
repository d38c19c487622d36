//! The material points that hands and feet hold or stand on, and the queries that find them.

use clamber_world::{Attachment, Contact, Obstacle, ObstacleId, SurfaceTag};
use glam::{DQuat, DVec3};

use super::carry::FOLLOW_SLACK;
use crate::figure::{Place, turned};

/// The obstacles that a body can touch.
#[derive(Clone, Copy)]
pub(crate) struct Surroundings<'a> {
    pub(crate) obstacles: &'a [(ObstacleId, &'a dyn Obstacle)],
    pub(crate) dt: f64,
}

/// A contact with its obstacle.
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

    /// The first contact of a ray; `direction` is a unit vector. A ray that begins inside an obstacle does not hit that
    /// obstacle.
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

    /// The nearest contact within `reach` metres.
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

/// Orders by distance, then by id.
fn by_distance(a: &Found<'_>, b: &Found<'_>) -> core::cmp::Ordering {
    let distances = a.contact.distance.total_cmp(&b.contact.distance);
    distances.then(a.id.cmp(&b.id))
}

/// A material point that a hand or foot is on, and its rotation there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hold {
    pub(crate) attachment: Attachment,
    pub(crate) tag: SurfaceTag,
    /// Normal of the skin, in the material's frame.
    normal: DVec3,
    /// Rotation of the hand or foot, in the material's frame.
    turn: DQuat,
    /// The point of the hand or foot that touches, in the axes of [`Place`].
    pub(crate) touching: DVec3,
}

impl Hold {
    /// A hold on a contact. In world space, the fingers or toes point along `along`, and the back of the hand or the
    /// top of the foot faces `outward`.
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

    /// Moves the hold with its material. False if the material is gone.
    pub(crate) fn follow(&mut self, around: &Surroundings<'_>) -> bool {
        let dt = around.dt.max(f64::MIN_POSITIVE);
        let obstacle = around.get(self.attachment.obstacle);
        obstacle
            .is_some_and(|obstacle| self.attachment.follow(obstacle, dt, FOLLOW_SLACK).is_some())
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

    /// The place of the hand or foot on the hold.
    pub(crate) fn place(&self) -> Place {
        Place::with_point_at(self.point(), self.touching, self.rotation())
    }
}
