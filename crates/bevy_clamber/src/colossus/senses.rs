use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use clamber_climber::ClimberMode;
use clamber_colossus::{Creature, Noise, Person, Riding};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::Obstacle;
use glam::DVec3;

use crate::{ClimberBody, ClimberState, PosedSurface};

/// A noise that every [`Colossus`](super::Colossus) hears: a message, for a footfall, a horn or a falling rock.
#[derive(Message, Clone, Copy, Debug, PartialEq)]
pub struct ColossusNoise {
    /// Where it comes from, in Bevy's world space.
    pub place: Vec3,
    /// How loud it is, as the brain's file counts it.
    pub loudness: f64,
}

impl ColossusNoise {
    pub(super) fn heard(&self, origin: DVec3) -> Noise {
        Noise {
            place: self.place.as_dvec3() + origin,
            loudness: self.loudness,
        }
    }
}

/// How far the skin that climbers touch may be from the skin that the creature feels with, as a share of its height:
/// visible fur and stone stand out.
const APART: f64 = 0.05;

/// A climber as a query gives it.
pub(super) type Seen<'a> = (Entity, &'a ClimberBody, &'a ClimberState);

/// Climbers, as the creature whose root is `root` senses them.
pub(super) fn people<'a>(
    climbers: impl Iterator<Item = Seen<'a>>,
    root: Entity,
    creature: &Creature,
    surfaces: &Query<'_, '_, (), With<PosedSurface>>,
    parents: &Query<'_, '_, &ChildOf>,
) -> Vec<Person> {
    let is_of_it = |surface: Entity| {
        surfaces.contains(surface) && parents.iter_ancestors(surface).any(|above| above == root)
    };
    let reach = APART * creature.height();
    let skin: &SkinnedSurface = creature.surface();
    let person = |(entity, body, state): Seen<'a>| {
        let on = state.support.map(|support| support.attachment);
        let on = on.filter(|on| Entity::try_from_bits(on.obstacle.0).is_some_and(is_of_it));
        let near = on.and_then(|on| Obstacle::closest_point(skin, on.point, reach));
        Person {
            id: entity.to_bits(),
            body: body.capsule(),
            riding: near.map(|near| Riding {
                at: near.material,
                hangs: state.mode == ClimberMode::Hanging,
            }),
        }
    };
    climbers.map(person).collect()
}
