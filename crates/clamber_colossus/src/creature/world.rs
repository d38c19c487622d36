use clamber_surface::geometry::WorldCapsule;
use clamber_world::{MaterialPoint, Obstacle};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// What is around a creature in one tick, for [`Creature::step`](crate::Creature::step): terrain, other creatures,
/// people and noises. Whoever steps the creature fills it in anew for each tick. An arena of `clamber_fight` does so
/// itself.
#[derive(Clone, Copy, Default)]
pub struct Surroundings<'a> {
    /// The obstacles of the world except creatures: ground, walls, rocks, and things that move, such as ships and
    /// lifts. The creature walks on them and goes round those in its way. Ground that moves carries it along. It cannot
    /// see through terrain, and its attacks do not pass through it.
    pub terrain: &'a [&'a dyn Obstacle],
    /// Skins of the other creatures. They block the creature's way and its attacks, except waves, as terrain does. But
    /// they are no ground to walk on, and the creature sees through them.
    pub creatures: &'a [&'a dyn Obstacle],
    /// People that the creature may see, feel or strike, as they were at the end of the last tick.
    pub people: &'a [Person],
    /// Noises that the creature hears in this tick. It hears a noise only in the ticks in which this list has it. Empty
    /// without noises.
    pub noises: &'a [Noise],
}

/// A person that a creature may see, feel or strike, such as a climber.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Person {
    /// Id of the person, which stays the same.
    pub id: u64,
    /// The body, in world space, metres: a person of 1.75 m has ends 0.3 and 1.45 m above its feet, and a radius of 0.3
    /// m.
    pub body: WorldCapsule,
    /// How the person rides this creature; `None` if the person does not.
    pub riding: Option<Riding>,
}

/// Where and how a person rides a creature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Riding {
    /// Point of the creature's skin that the person stands on or holds: the `material` of a climber's support.
    pub at: MaterialPoint,
    /// True if the person hangs by its hands from a grip: not while it stands, climbs, or hangs from a ledge.
    pub hangs: bool,
}

/// A noise in the world, which creatures hear through terrain and at any distance, though fainter when they are far
/// away. Of all noises in a tick, a creature senses the one that is loudest at its eye
/// ([`Sense::Noise`](crate::Sense::Noise)).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Noise {
    /// Source of the noise, in world space, metres.
    pub place: DVec3,
    /// Loudness at the source, in units of the game. A creature whose eye is within
    /// [`CreatureConfig::hearing`](crate::CreatureConfig::hearing) of the source hears it at full loudness; farther
    /// away it falls off with the square of the distance.
    pub loudness: f64,
}

impl Surroundings<'_> {
    /// True if terrain is between a place and a person, towards the middle of the body.
    pub(super) fn hides(&self, place: DVec3, person: &Person) -> bool {
        let way = person.middle() - place;
        let distance = way.length() - person.body.radius;
        distance > 0.0
            && self
                .terrain
                .iter()
                .any(|obstacle| obstacle.cast_ray(place, way, distance).is_some())
    }
}

impl Person {
    /// Middle of the body, in world space, metres.
    pub fn middle(&self) -> DVec3 {
        0.5 * (self.body.ends[0] + self.body.ends[1])
    }
}
