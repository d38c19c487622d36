//! Maps between a scenario's units and frame and the world.

use clamber_climber::{
    ClimberConfig, ClimberEvent, ClimberState, HangingMemory, StepReport, Support,
};
use clamber_world::{
    Attachment, Contact, MaterialPoint, Obstacle, PointMotion, SweepContact, TargetMotion,
    WorldCapsule,
};
use glam::DVec3;

use crate::numbers::in_world_of_size;

/// A map from one space to another over a tick: a scale and a steady motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) scale: f64,
    /// Position of the origin at the end of the tick.
    pub(crate) now: DVec3,
    /// Position of the origin at the start of the tick.
    pub(crate) before: DVec3,
    /// Velocity of the origin, metres a second.
    pub(crate) velocity: DVec3,
}

impl Place {
    /// The inverse map.
    pub(crate) fn inverse(&self) -> Self {
        let scale = 1.0 / self.scale;
        Self {
            scale,
            now: -self.now * scale,
            before: -self.before * scale,
            velocity: -self.velocity * scale,
        }
    }

    pub(crate) fn point(&self, point: DVec3) -> DVec3 {
        self.now + point * self.scale
    }

    fn point_before(&self, point: DVec3) -> DVec3 {
        self.before + point * self.scale
    }

    /// Maps a velocity.
    pub(crate) fn velocity(&self, velocity: DVec3) -> DVec3 {
        self.velocity + velocity * self.scale
    }

    pub(crate) fn capsule(&self, capsule: &WorldCapsule) -> WorldCapsule {
        WorldCapsule {
            ends: capsule.ends.map(|end| self.point(end)),
            radius: capsule.radius * self.scale,
        }
    }

    pub(crate) fn state(&self, state: &ClimberState) -> ClimberState {
        let support = state.support.map(|support| Support {
            attachment: self.attachment(support.attachment),
            ..support
        });
        ClimberState {
            position: self.point(state.position),
            velocity: self.velocity(state.velocity),
            base_velocity: self.velocity(state.base_velocity),
            support,
            support_velocity: state.support_velocity.map(|v| self.velocity(v)),
            shake: state.shake * self.scale,
            hanging: HangingMemory {
                arm: state.hanging.arm * self.scale,
                legs: state.hanging.legs * self.scale,
                ..state.hanging
            },
            ..*state
        }
    }

    fn attachment(&self, attachment: Attachment) -> Attachment {
        Attachment {
            point: self.point(attachment.point),
            offset: attachment.offset * self.scale,
            ..attachment
        }
    }

    pub(crate) fn report(&self, mut report: StepReport) -> StepReport {
        let events = report.events.into_iter();
        report.events = events.map(|event| self.event(event)).collect();
        report.pushed_out *= self.scale;
        report.penetration *= self.scale;
        report
    }

    fn event(&self, mut event: ClimberEvent) -> ClimberEvent {
        match &mut event {
            ClimberEvent::Landed { speed: number, .. }
            | ClimberEvent::Crushed { depth: number } => *number *= self.scale,
            ClimberEvent::Thrown {
                acceleration: number,
                from,
            }
            | ClimberEvent::ShakenOff {
                shake: number,
                from,
            } => {
                *number *= self.scale;
                *from = self.attachment(*from);
            }
            ClimberEvent::LostFooting { from } | ClimberEvent::KnockedOff { from, .. } => {
                *from = self.attachment(*from);
            }
            ClimberEvent::Tumbled { from, .. } => {
                *from = from.map(|from| self.attachment(from));
            }
            ClimberEvent::Grabbed { point, .. } | ClimberEvent::LedgeCaught { point, .. } => {
                *point = self.point(*point);
            }
            _ => {}
        }
        event
    }

    /// Scales a configuration's lengths, speeds and accelerations. Times, angles and shares stay.
    pub(crate) fn config(&self, config: &ClimberConfig) -> ClimberConfig {
        in_world_of_size(*config, self.scale)
    }
}

/// An obstacle that is queried from another space: maps the queries, and maps the answers back.
pub(crate) struct Elsewhere<'a> {
    pub(crate) inner: &'a dyn Obstacle,
    /// The map from the space of the queries to the space of the obstacle.
    pub(crate) there: Place,
}

impl Elsewhere<'_> {
    fn contact(&self, contact: Contact, back: &Place) -> Contact {
        Contact {
            point: back.point(contact.point),
            distance: contact.distance * back.scale,
            ..contact
        }
    }

    fn hit(&self, hit: SweepContact, back: &Place) -> SweepContact {
        SweepContact {
            contact: self.contact(hit.contact, back),
            ..hit
        }
    }
}

impl Obstacle for Elsewhere<'_> {
    fn bounds(&self) -> Option<(DVec3, f64)> {
        let (center, radius) = self.inner.bounds()?;
        let back = self.there.inverse();
        Some((back.point(center), radius * back.scale))
    }

    fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<Contact> {
        let there = &self.there;
        let length = max_distance * there.scale;
        let hit = self
            .inner
            .cast_ray(there.point(origin), direction, length)?;
        Some(self.contact(hit, &there.inverse()))
    }

    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        let there = &self.there;
        let length = max_distance * there.scale;
        let contact = self.inner.closest_point(there.point(point), length)?;
        Some(self.contact(contact, &there.inverse()))
    }

    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        let (first, back) = (contacts.len(), self.there.inverse());
        let capsule = self.there.capsule(capsule);
        self.inner.overlap_capsule(&capsule, contacts);
        for contact in &mut contacts[first..] {
            *contact = self.contact(*contact, &back);
        }
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        let there = &self.there;
        if target == TargetMotion::Still {
            let ways = displacements.map(|way| way * there.scale);
            let hit = self
                .inner
                .cast_capsule(&there.capsule(capsule), ways, target)?;
            return Some(self.hit(hit, &there.inverse()));
        }
        let start = WorldCapsule {
            ends: capsule.ends.map(|end| there.point_before(end)),
            radius: capsule.radius * there.scale,
        };
        let ways = displacements.map(|way| way * there.scale + (there.now - there.before));
        let hit = self.inner.cast_capsule(&start, ways, target)?;
        // Mapped back from the position of the other space at the time of contact.
        let then = Place {
            now: there.before + (there.now - there.before) * hit.fraction,
            ..*there
        };
        Some(self.hit(hit, &then.inverse()))
    }

    fn inverse_effective_mass(&self, point: &MaterialPoint, direction: DVec3) -> f64 {
        self.inner.inverse_effective_mass(point, direction) / self.there.scale
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        let motion = self.inner.motion(point, dt)?;
        let back = self.there.inverse();
        Some(PointMotion {
            position: back.point(motion.position),
            previous_position: back.point_before(motion.previous_position),
            velocity: back.velocity(motion.velocity),
            ..motion
        })
    }
}
