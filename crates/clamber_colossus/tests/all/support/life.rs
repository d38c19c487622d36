//! The giant at any size and rate, on ground at rest and aboard a ship.

use clamber_colossus::{Creature, CreatureConfig, CreatureEvent, Person, Riding, Surroundings};
use clamber_surface::geometry::{Similarity, WorldCapsule, rotation_from_axis_angle};
use clamber_surface::surface::TargetMotion;
use clamber_world::{Contact, MaterialPoint, Obstacle, PointMotion, SweepContact};
use glam::DVec3;
use serde_json::Value;

use super::{TICK, creature, kind_at, person};

/// Height of the giant, metres, length of a tick, seconds, and true if it stands on a ship that sails and turns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Setting {
    pub(crate) height: f64,
    pub(crate) tick: f64,
    pub(crate) sails: bool,
}

/// The settings of the tests: 41, 4 and 150 m on ground at rest, and 41 m on a ship.
pub(crate) const SETTINGS: [Setting; 4] = [
    Setting {
        height: 41.0,
        tick: TICK,
        sails: false,
    },
    Setting {
        height: 4.0,
        tick: TICK,
        sails: false,
    },
    Setting {
        height: 150.0,
        tick: 1.0 / 30.0,
        sails: false,
    },
    Setting {
        height: 41.0,
        tick: 1.0 / 90.0,
        sails: true,
    },
];

impl Setting {
    /// Size of the giant relative to 41 m.
    pub(crate) fn scale(&self) -> f64 {
        self.height / 41.0
    }

    /// Factor by which times are longer than at 41 m.
    pub(crate) fn pace(&self) -> f64 {
        self.scale().sqrt()
    }

    pub(crate) fn ticks(&self, seconds: f64) -> u32 {
        (seconds * self.pace() / self.tick).round() as u32
    }
}

/// Ground that is carried by a ship. The ship turns about the vertical axis only.
#[derive(Clone, Copy)]
pub(crate) struct Aboard<'a> {
    ground: &'a dyn Obstacle,
    pub(crate) before: Similarity,
    pub(crate) now: Similarity,
}

impl Aboard<'_> {
    fn capsule(&self, capsule: &WorldCapsule) -> WorldCapsule {
        WorldCapsule {
            ends: capsule
                .ends
                .map(|end| self.now.inverse_transform_point(end)),
            radius: capsule.radius,
        }
    }

    fn contact(&self, contact: Contact) -> Contact {
        Contact {
            point: self.now.transform_point(contact.point),
            normal: self.now.rotation * contact.normal,
            material: MaterialPoint {
                key: 0,
                coordinates: contact.point.to_array(),
            },
            ..contact
        }
    }
}

impl Obstacle for Aboard<'_> {
    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        let from = contacts.len();
        self.ground
            .overlap_capsule(&self.capsule(capsule), contacts);
        for contact in &mut contacts[from..] {
            *contact = self.contact(*contact);
        }
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        let back = self.now.rotation.conjugate();
        let displacements = displacements.map(|way| back * way);
        let hit = self
            .ground
            .cast_capsule(&self.capsule(capsule), displacements, target)?;
        Some(SweepContact {
            contact: self.contact(hit.contact),
            ..hit
        })
    }

    fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<Contact> {
        let origin = self.now.inverse_transform_point(origin);
        let direction = self.now.rotation.conjugate() * direction;
        let hit = self.ground.cast_ray(origin, direction, max_distance)?;
        Some(self.contact(hit))
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        Some(motion([self.before, self.now], point, dt))
    }
}

/// The motion of a point with ground that was and is at these places.
pub(crate) fn motion(
    [before, now]: [Similarity; 2],
    point: &MaterialPoint,
    dt: f64,
) -> PointMotion {
    let local = DVec3::from_array(point.coordinates);
    let [from, to] = [before, now].map(|at| at.transform_point(local));
    PointMotion {
        turn: now.rotation * before.rotation.conjugate(),
        frame: Some(now.rotation),
        ..PointMotion::translated(from, to, dt)
    }
}

/// A person near the giant, with its place relative to the ground.
#[derive(Clone, Copy)]
pub(crate) struct Guest {
    pub(crate) id: u64,
    pub(crate) place: DVec3,
    pub(crate) riding: Option<Riding>,
}

/// A person in a direction, radians from +Z to +X, at a distance.
pub(crate) fn at(angle: f64, far: f64) -> Guest {
    Guest {
        id: 1,
        place: DVec3::new(libm::sin(angle), 0.0, libm::cos(angle)) * far,
        riding: None,
    }
}

/// A giant and the ground under it. Lengths and times are given as for a giant of 41 m, and places relative to the
/// ground. The ground scales with the giant.
pub(crate) struct Life<'a> {
    pub(crate) setting: Setting,
    pub(crate) one: Creature,
    pub(crate) ground: Aboard<'a>,
    time: f64,
}

impl<'a> Life<'a> {
    /// A giant at the origin of the ground. `brain` gives everything except its size.
    pub(crate) fn new(setting: Setting, brain: &str, ground: &'a dyn Obstacle) -> Self {
        let mut file: Value = serde_json::from_str(brain).unwrap();
        file["body"]["height"] = setting.height.into();
        file["body"]["made_for"] = 41.0.into();
        let kind = kind_at(&file.to_string(), setting.tick);
        let mut config = CreatureConfig::default();
        config.sight *= setting.scale().max(1.0);
        Self {
            setting,
            one: creature(&kind, config),
            ground: Aboard {
                ground,
                before: Similarity::IDENTITY,
                now: Similarity::IDENTITY,
            },
            time: 0.0,
        }
    }

    fn angle(&self) -> f64 {
        if self.setting.sails {
            0.05 * self.time
        } else {
            0.0
        }
    }

    /// Yaw relative to the ground, radians.
    pub(crate) fn yaw(&self) -> f64 {
        self.one.state().yaw() - self.angle()
    }

    /// Yaw rate, radians a second.
    pub(crate) fn yaw_rate(&self) -> f64 {
        self.number("/motion/yaw_rate") * self.setting.pace()
    }

    /// Speed relative to the ground, metres a second.
    pub(crate) fn speed(&self) -> f64 {
        self.one.state().speed() / self.setting.pace()
    }

    /// Position relative to the ground.
    pub(crate) fn position(&self) -> DVec3 {
        let place = self.one.state().position();
        self.ground.now.inverse_transform_point(place) / self.setting.scale()
    }

    /// A number of the saved state by its JSON pointer, without any scaling.
    pub(crate) fn number(&self, place: &str) -> f64 {
        let state = serde_json::to_value(self.one.state()).unwrap();
        state.pointer(place).and_then(Value::as_f64).unwrap()
    }

    /// The current place in the world of a place on the ground.
    pub(crate) fn place(&self, place: DVec3) -> DVec3 {
        let place = place * self.setting.scale();
        self.ground.now.transform_point(place)
    }

    /// Steps the giant for some seconds, and calls `look` after each tick.
    pub(crate) fn live(&mut self, people: &[Guest], seconds: f64, mut look: impl FnMut(&Self)) {
        for _ in 0..self.setting.ticks(seconds) {
            self.tick(people);
            look(self);
        }
    }

    /// Steps the giant by one tick. Returns the events.
    pub(crate) fn tick(&mut self, people: &[Guest]) -> &[CreatureEvent] {
        self.time += self.setting.tick;
        let sailed = if self.setting.sails { self.time } else { 0.0 };
        self.ground.before = self.ground.now;
        self.ground.now = Similarity {
            translation: DVec3::new(4.0, 0.0, 1.0) * sailed,
            rotation: rotation_from_axis_angle(DVec3::Y, self.angle()),
            scale: 1.0,
        };
        let people: Vec<Person> = people
            .iter()
            .map(|guest| Person {
                id: guest.id,
                riding: guest.riding,
                ..person(self.place(guest.place))
            })
            .collect();
        let ground = self.ground;
        let terrain: [&dyn Obstacle; 1] = [&ground];
        let around = Surroundings {
            terrain: &terrain,
            people: &people,
            ..Surroundings::default()
        };
        &self.one.step(&around).unwrap().events
    }

    /// Keeps the giant turning to one side, after a person that goes round it.
    pub(crate) fn turn(&mut self, side: f64, seconds: f64) {
        for _ in 0..self.setting.ticks(seconds) {
            let prey = at(self.yaw() + side * 1.4, 40.0);
            self.tick(&[prey]);
        }
    }
}
