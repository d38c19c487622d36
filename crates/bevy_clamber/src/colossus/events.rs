//! The events of a [`Colossus`](crate::Colossus), for observers, and as messages for readers.

use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::prelude::*;
use clamber_colossus::{Creature, CreatureEvent, StrikeHit};
use glam::DVec3;

use crate::tell::tell;

macro_rules! events {
    ($($(#[$doc:meta])* $name:ident { $($(#[$about:meta])* $field:ident: $type:ty,)* })*) => {
        $(
            $(#[$doc])*
            ///
            /// Triggered on the creature's root, and written as a message.
            #[derive(EntityEvent, Message, Clone, Debug, PartialEq, Reflect)]
            #[reflect(Clone, Debug, PartialEq)]
            pub struct $name {
                /// The creature's root.
                pub entity: Entity,
                $($(#[$about])* pub $field: $type,)*
            }
        )*

        /// Adds the messages of this module.
        pub(super) fn add(app: &mut App) {
            $(app.add_message::<$name>();)*
        }
    };
}

events! {
    /// A creature went from one state of its brain to another.
    ColossusEntered {
        /// The state before, with the names of those around it.
        from: String,
        /// The state now.
        to: String,
    }
    /// A creature's clip passed a marker.
    ColossusMarker {
        /// The marker's name.
        marker: String,
    }
    /// A foot of a creature came down: for sounds, dust and prints.
    ColossusPlanted {
        /// The leg, by its index in the brain's file.
        leg: usize,
        /// Where, in Bevy's world space.
        place: Vec3,
    }
    /// A creature threw something: [`Creature::shots`] tells where it is, as long as it flies.
    ColossusThrew {
        /// The shot's number, by which [`Creature::shots`] has it.
        number: u64,
        /// From where, in Bevy's world space.
        place: Vec3,
        /// Metres a second.
        velocity: Vec3,
        /// The state whose attack it is of, with the names of those around it.
        attack: String,
    }
    /// A shot of a creature has struck a person, or met terrain or another creature.
    ColossusBurst {
        /// Its number.
        number: u64,
        /// Where, in Bevy's world space.
        place: Vec3,
        /// The state whose attack it was of, with the names of those around it.
        attack: String,
    }
    /// A wave of a creature's attack goes out: [`Creature::waves`] tells how far it has come.
    ColossusWave {
        /// From where, in Bevy's world space.
        place: Vec3,
        /// How far, metres.
        radius: f32,
        /// The state whose attack it is of, with the names of those around it.
        attack: String,
    }
    /// A creature struck a climber: with a limb, a wave, a shot or a beam.
    ColossusStruck {
        /// The climber.
        climber: Entity,
        /// Where, in Bevy's world space.
        place: Vec3,
        /// Hit points, 0 to 1.
        damage: f32,
        /// The state whose attack it was, with the names of those around it.
        attack: String,
    }
    /// A weak point of a creature was hurt.
    ColossusHurt {
        /// The weak point, by its index in the file.
        weak_point: usize,
        /// Hit points that it lost.
        damage: f64,
        /// True if it is used up by that.
        used_up: bool,
    }
    /// A plate of a creature took a blow too many.
    ColossusStaggered {
        /// The plate, by its index in the brain's file.
        plate: usize,
        /// True if it breaks off.
        breaks: bool,
    }
}

/// Tells what happened in a creature's last step.
pub(super) fn tell_all(
    entity: Entity,
    creature: &Creature,
    origin: DVec3,
    commands: &mut Commands<'_, '_>,
) {
    let path = |state| creature.kind().brain().path(state).to_owned();
    for event in &creature.report().events {
        match event {
            CreatureEvent::Entered { from, to } => {
                let (from, to) = (path(*from), path(*to));
                tell(commands, ColossusEntered { entity, from, to });
            }
            CreatureEvent::Marker { name } => {
                let marker = name.clone();
                tell(commands, ColossusMarker { entity, marker });
            }
            CreatureEvent::Plant { leg, place } => tell(
                commands,
                ColossusPlanted {
                    entity,
                    leg: *leg,
                    place: (*place - origin).as_vec3(),
                },
            ),
            CreatureEvent::Threw {
                state,
                number,
                place,
                velocity,
            } => tell(
                commands,
                ColossusThrew {
                    entity,
                    number: *number,
                    place: (*place - origin).as_vec3(),
                    velocity: velocity.as_vec3(),
                    attack: path(*state),
                },
            ),
            CreatureEvent::Burst {
                state,
                number,
                place,
            } => tell(
                commands,
                ColossusBurst {
                    entity,
                    number: *number,
                    place: (*place - origin).as_vec3(),
                    attack: path(*state),
                },
            ),
            CreatureEvent::Wave {
                state,
                place,
                radius,
            } => tell(
                commands,
                ColossusWave {
                    entity,
                    place: (*place - origin).as_vec3(),
                    radius: *radius as f32,
                    attack: path(*state),
                },
            ),
            CreatureEvent::Hurt {
                weak_point,
                damage,
                used_up,
            } => tell(
                commands,
                ColossusHurt {
                    entity,
                    weak_point: *weak_point,
                    damage: *damage,
                    used_up: *used_up,
                },
            ),
            CreatureEvent::Staggered { plate, breaks } => tell(
                commands,
                ColossusStaggered {
                    entity,
                    plate: *plate,
                    breaks: *breaks,
                },
            ),
            // An event that is newer than this list.
            _ => {}
        }
    }
}

/// Tells which climbers a creature struck.
pub(super) fn tell_struck(
    (entity, climber): (Entity, Entity),
    creature: &Creature,
    blow: &StrikeHit,
    origin: DVec3,
    commands: &mut Commands<'_, '_>,
) {
    let struck = ColossusStruck {
        entity,
        climber,
        place: (blow.place - origin).as_vec3(),
        damage: blow.damage as f32,
        attack: creature.kind().brain().path(blow.state).to_owned(),
    };
    tell(commands, struck);
}
