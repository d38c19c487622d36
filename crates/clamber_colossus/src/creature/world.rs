use clamber_surface::geometry::WorldCapsule;
use clamber_world::{MaterialPoint, Obstacle};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// What is around a creature in a tick.
#[derive(Clone, Copy, Default)]
pub struct Surroundings<'a> {
    /// What it walks on, and cannot see through.
    pub terrain: &'a [&'a dyn Obstacle],
    /// What else stands in its way, without being ground: the skins of other creatures.
    pub creatures: &'a [&'a dyn Obstacle],
    /// Everybody who may be seen, felt or struck, as they were at the end of the last tick.
    pub people: &'a [Person],
    /// What is to be heard in this tick.
    pub noises: &'a [Noise],
}

/// Somebody whom a creature may see, feel or strike: a climber, as the creature needs it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Person {
    /// The person's id, which stays the same.
    pub id: u64,
    /// The body, in world space: a person of 1.75 m has ends 0.3 and 1.45 m above its feet, and a radius of 0.3 m.
    pub body: WorldCapsule,
    /// Where it stands on this creature or holds it; `None` if it does not.
    pub riding: Option<Riding>,
}

/// How somebody is on a creature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Riding {
    /// The point of the creature's skin that it stands on or holds. A climber has it in the `material` of its support.
    pub at: MaterialPoint,
    /// True if the person hangs, rather than stands or grips.
    pub hangs: bool,
}

/// Something to be heard.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Noise {
    /// Where it comes from, in world space.
    pub place: DVec3,
    /// How loud it is where it comes from, as the game counts it. A creature hears it as loud as that within
    /// [`CreatureConfig::hearing`](crate::CreatureConfig); farther away it falls off with the square of the distance.
    pub loudness: f64,
}

/// A blow or an arrow that struck a creature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wound {
    /// Where it struck, in world space: the first open weak point whose ball this place is in takes the damage.
    pub place: DVec3,
    /// The point of the skin: it tells the region, and the plate that takes the blow if there is one. Of a hit on the
    /// creature's surface it is `MaterialPoint::on_triangle(hit.triangle, hit.barycentric)`, of a contact with an
    /// [`Obstacle`] its `material`.
    pub at: MaterialPoint,
    /// Damage that it does to a weak point there.
    pub damage: f64,
}

impl Surroundings<'_> {
    /// True if terrain is between a place and a person's middle.
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
    /// The middle of the body.
    pub fn middle(&self) -> DVec3 {
        0.5 * (self.body.ends[0] + self.body.ends[1])
    }
}
