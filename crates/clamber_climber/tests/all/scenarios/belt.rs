//! A conveyor belt: an obstacle that wraps another one, whose shape is at rest while its material moves.

use clamber_climber::ClimberInput;
use clamber_world::{
    Contact, MaterialPoint, Obstacle, PointMotion, SweepContact, TargetMotion, WorldCapsule,
};
use glam::{DQuat, DVec3};

use crate::stage::Run;

/// A belt: the velocity of its material, and how long it has run.
pub(crate) struct Belt {
    velocity: DVec3,
    ticks: u32,
}

/// One tick of the belt. A material point's coordinates are its position when the belt started.
struct Running<'a> {
    shape: &'a dyn Obstacle,
    shift: DVec3,
    velocity: DVec3,
}

impl Belt {
    pub(crate) fn new(velocity: DVec3) -> Self {
        Self { velocity, ticks: 0 }
    }

    pub(crate) fn rides(&mut self, run: &mut Run, input: &ClimberInput, ticks: u32) {
        for _ in 0..ticks {
            self.ticks += 1;
            let shift = self.velocity * (f64::from(self.ticks) * run.stage.dt);
            let velocity = self.velocity;
            run.step_around(input, |shape| {
                Box::new(Running {
                    shape,
                    shift,
                    velocity,
                })
            });
        }
    }
}

impl Running<'_> {
    fn on_belt(&self, contact: Contact) -> Contact {
        let coordinates = (contact.point - self.shift).to_array();
        Contact {
            material: MaterialPoint {
                coordinates,
                ..contact.material
            },
            ..contact
        }
    }

    fn met(&self, hit: SweepContact) -> SweepContact {
        SweepContact {
            contact: self.on_belt(hit.contact),
            ..hit
        }
    }
}

impl Obstacle for Running<'_> {
    fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<Contact> {
        let hit = self.shape.cast_ray(origin, direction, max_distance)?;
        Some(self.on_belt(hit))
    }

    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        Some(self.on_belt(self.shape.closest_point(point, max_distance)?))
    }

    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        let start = contacts.len();
        self.shape.overlap_capsule(capsule, contacts);
        for contact in &mut contacts[start..] {
            *contact = self.on_belt(*contact);
        }
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        Some(self.met(self.shape.cast_capsule(capsule, displacements, target)?))
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        let position = DVec3::from_array(point.coordinates) + self.shift;
        Some(PointMotion {
            position,
            previous_position: position - self.velocity * dt,
            velocity: self.velocity,
            was_teleported: false,
            frame: Some(DQuat::IDENTITY),
            turn: DQuat::IDENTITY,
            area_ratio: 1.0,
            stretches: [1.0; 2],
        })
    }
}
