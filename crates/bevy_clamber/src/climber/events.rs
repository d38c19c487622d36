//! The events of climbers, for observers, and as messages for readers.

use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::prelude::*;
use clamber_climber::{ClimberEvent, ClimberMode};
use clamber_world::{Attachment, ObstacleId};
use glam::DVec3;

use crate::tell::tell;

macro_rules! events {
    ($($(#[$doc:meta])* $name:ident { $($(#[$about:meta])* $field:ident: $type:ty,)* })*) => {
        $(
            $(#[$doc])*
            ///
            /// Triggered on the climber, and written as a message.
            #[derive(EntityEvent, Message, Clone, Copy, Debug, PartialEq, Reflect)]
            #[reflect(Clone, Debug, PartialEq)]
            pub struct $name {
                /// The climber.
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
    /// A climber landed on ground that can be stood on.
    ClimberLanded {
        /// The ground.
        ground: Option<Entity>,
        /// Speed towards the ground, relative to it, metres a second.
        speed: f32,
    }
    /// A climber jumped off the ground, a hold or a ledge.
    ClimberJumped {}
    /// The ground that a climber stood on or the ledge that it hung from is too steep now.
    ClimberSlipped {}
    /// A climber lost its support, because that ended, was removed, went out of reach, or left it no room.
    ClimberLostFooting {
        /// The support that was lost; may be despawned.
        support: Option<Entity>,
    }
    /// The support of a climber did not move exactly once since the climber's last tick, for example because a creature
    /// was advanced twice: the motion of the other tick was not swept. Or the motion that the game's own obstacle
    /// reports does not begin where the last one ended.
    ClimberSkippedTicks {
        /// The support.
        support: Option<Entity>,
    }
    /// The ground was pulled away from under a climber's feet.
    ClimberThrown {
        /// Acceleration of the ground away from the feet, metres a second squared beyond gravity.
        acceleration: f32,
        /// The ground that was lost.
        support: Option<Entity>,
    }
    /// A climber gripped something.
    ClimberGrabbed {
        /// The entity that it grips.
        hold: Option<Entity>,
        /// The gripped point, in Bevy's world space.
        point: Vec3,
    }
    /// A climber climbed around a corner, convex or concave.
    ClimberTurnedCorner {
        /// Angle between the normals of both faces, radians.
        angle: f32,
    }
    /// A climber caught a ledge with its hands.
    ClimberCaughtLedge {
        /// The entity that the ledge is part of.
        ledge: Option<Entity>,
        /// The point that its hands hold, in Bevy's world space.
        point: Vec3,
    }
    /// A climber's hands slipped off a hold or a ledge: it passed too fast, or stamina did not suffice.
    ClimberHandsSlipped {
        /// The entity that it could not hold.
        hold: Option<Entity>,
        /// Speed of the climber relative to the hold, metres a second.
        speed: f32,
    }
    /// A climber pulled itself up over a ledge, and stands on top.
    ClimberMantled {}
    /// A climber let go, because [`ClimberInput::grip`](crate::ClimberInput::grip) ended.
    ClimberReleased {}
    /// A climber's stamina was used up, and its grip opened. It may still lie on the creature, and grip it again.
    ClimberShakenOff {
        /// The shake at that time, metres a second squared.
        shake: f32,
        /// The hold that was lost.
        support: Option<Entity>,
    }
    /// A climber was knocked over.
    ClimberTumbled {
        /// The climber's support at that time; `None` in the air, while sliding, and if the support has no entity.
        support: Option<Entity>,
        /// The dealer of the blow.
        by: Option<Entity>,
    }
    /// A blow that does not make it tumble pushed a climber off its feet or its hold.
    ClimberKnockedOff {
        /// The climber's support at that time.
        support: Option<Entity>,
        /// The dealer of the blow.
        by: Option<Entity>,
    }
    /// Obstacles leave a climber too little room.
    ClimberCrushed {
        /// The room that is missing, metres.
        depth: f32,
    }
    /// A climber lost hit points.
    ClimberHurt {
        /// How many it lost, 0 to 1.
        damage: f32,
        /// How many are left, 0 to 1, after all of this tick's events.
        left: f32,
    }
    /// A climber changed its mode.
    ClimberChangedMode {
        /// The mode before.
        from: ClimberMode,
        /// The mode now.
        to: ClimberMode,
    }
    /// A mode of the game's [`ClimberModes`](crate::ClimberModes) made a report.
    ClimberModeReported {
        /// Id of the mode.
        mode: u16,
        /// Number of the report; the mode defines its meaning.
        what: u32,
        /// A value; the mode defines its meaning.
        value: f64,
    }
    /// An obstacle or a mode of the game gave numbers that are not finite. The climber is as it was before the tick.
    ClimberNotFinite {}
}

/// The data that an event needs beside itself.
pub(super) struct Told<'a> {
    pub(super) entity: Entity,
    pub(super) hit_points: f64,
    /// The [`WorldOrigin`](crate::WorldOrigin).
    pub(super) origin: DVec3,
    /// The entity that an obstacle is, or that was touched in its world.
    pub(super) touched: &'a dyn Fn(ObstacleId) -> Option<Entity>,
    /// The entity that a point of an obstacle belongs to.
    pub(super) supports: &'a dyn Fn(&Attachment) -> Option<Entity>,
}

/// Tells one event of a climber.
pub(super) fn tell_event(event: &ClimberEvent, told: &Told<'_>, commands: &mut Commands<'_, '_>) {
    let entity = told.entity;
    let touched = |id: &ObstacleId| (told.touched)(*id);
    let supports = |from: &Attachment| (told.supports)(from);
    match event {
        ClimberEvent::Landed { obstacle, speed } => tell(
            commands,
            ClimberLanded {
                entity,
                ground: touched(obstacle),
                speed: *speed as f32,
            },
        ),
        ClimberEvent::Jumped => tell(commands, ClimberJumped { entity }),
        ClimberEvent::Slipped => tell(commands, ClimberSlipped { entity }),
        ClimberEvent::LostFooting { from } => tell(
            commands,
            ClimberLostFooting {
                entity,
                support: supports(from),
            },
        ),
        ClimberEvent::SkippedTicks { obstacle } => tell(
            commands,
            ClimberSkippedTicks {
                entity,
                support: touched(obstacle),
            },
        ),
        ClimberEvent::Thrown { acceleration, from } => tell(
            commands,
            ClimberThrown {
                entity,
                acceleration: *acceleration as f32,
                support: supports(from),
            },
        ),
        ClimberEvent::Grabbed { obstacle, point } => tell(
            commands,
            ClimberGrabbed {
                entity,
                hold: touched(obstacle),
                point: (*point - told.origin).as_vec3(),
            },
        ),
        ClimberEvent::TurnedCorner { angle } => tell(
            commands,
            ClimberTurnedCorner {
                entity,
                angle: *angle as f32,
            },
        ),
        ClimberEvent::LedgeCaught { obstacle, point } => tell(
            commands,
            ClimberCaughtLedge {
                entity,
                ledge: touched(obstacle),
                point: (*point - told.origin).as_vec3(),
            },
        ),
        ClimberEvent::HandsSlipped { obstacle, speed } => tell(
            commands,
            ClimberHandsSlipped {
                entity,
                hold: touched(obstacle),
                speed: *speed as f32,
            },
        ),
        ClimberEvent::Mantled => tell(commands, ClimberMantled { entity }),
        ClimberEvent::Released => tell(commands, ClimberReleased { entity }),
        ClimberEvent::ShakenOff { shake, from } => tell(
            commands,
            ClimberShakenOff {
                entity,
                shake: *shake as f32,
                support: supports(from),
            },
        ),
        ClimberEvent::Tumbled { from, by } => tell(
            commands,
            ClimberTumbled {
                entity,
                support: from.as_ref().and_then(supports),
                by: by.as_ref().and_then(touched),
            },
        ),
        ClimberEvent::KnockedOff { from, by } => tell(
            commands,
            ClimberKnockedOff {
                entity,
                support: supports(from),
                by: by.as_ref().and_then(touched),
            },
        ),
        ClimberEvent::Crushed { depth } => tell(
            commands,
            ClimberCrushed {
                entity,
                depth: *depth as f32,
            },
        ),
        ClimberEvent::Hurt { damage } => tell(
            commands,
            ClimberHurt {
                entity,
                damage: *damage as f32,
                left: told.hit_points as f32,
            },
        ),
        ClimberEvent::Changed { from, to } => tell(
            commands,
            ClimberChangedMode {
                entity,
                from: *from,
                to: *to,
            },
        ),
        ClimberEvent::Custom { mode, what, value } => tell(
            commands,
            ClimberModeReported {
                entity,
                mode: *mode,
                what: *what,
                value: *value,
            },
        ),
        ClimberEvent::AlreadyInMode { mode } => {
            tracing::warn!("climber {entity}: mode {mode:?} changed to itself, which does nothing");
        }
        ClimberEvent::NotFinite => {
            tracing::warn!("climber {entity} met numbers that are not finite");
            tell(commands, ClimberNotFinite { entity });
        }
        other => {
            tracing::warn!("climber {entity}: an event that this version does not know: {other:?}")
        }
    }
}
