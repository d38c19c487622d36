use clamber_world::{Attachment, MaterialPoint, ObstacleId};
use glam::DVec3;

use crate::ClimberMode;

/// Something that happened in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ClimberEvent {
    /// Came down on something that can be stood on.
    Landed {
        /// On what.
        obstacle: ObstacleId,
        /// Speed towards it, metres a second.
        speed: f64,
    },
    /// Jumped, off the ground or off a hold.
    Jumped,
    /// What it stood on, or hung from, became too steep.
    Slipped,
    /// What it stood on or held ended, was removed, went out of its reach, or left it no room.
    LostFooting {
        /// What was lost.
        from: Attachment,
    },
    /// What supports it moved otherwise than once since the last step: the creature was advanced twice, or the climber
    /// was stepped twice. Sweeps saw only the last move.
    MovedRepeatedly {
        /// The obstacle.
        obstacle: ObstacleId,
    },
    /// The ground was pulled away from under its feet.
    Thrown {
        /// How hard, metres a second squared beyond gravity.
        acceleration: f64,
        /// The ground that was lost.
        from: Attachment,
    },
    /// Gripped something.
    Grabbed {
        /// What.
        obstacle: ObstacleId,
        /// Where, in world space.
        point: DVec3,
    },
    /// Climbed around a corner, convex or concave.
    TurnedCorner {
        /// Between what it held before and holds now, radians.
        angle: f64,
    },
    /// Caught a ledge with its hands.
    LedgeCaught {
        /// Of what.
        obstacle: ObstacleId,
        /// Where, in world space.
        point: DVec3,
    },
    /// Climbed over a ledge.
    Mantled,
    /// Let go, as was asked.
    Released,
    /// Its strength was used up, and the grip opened.
    ShakenOff {
        /// The shake at that time, metres a second squared; below what costs strength it was just tired.
        shake: f64,
        /// The hold that was lost.
        from: Attachment,
    },
    /// Knocked off its feet, or off its hold.
    Tumbled {
        /// What it stood on or held; `None` in the air.
        from: Option<Attachment>,
        /// Which obstacle dealt the blow, if one did.
        by: Option<ObstacleId>,
    },
    /// Pushed off its feet or its hold by a blow that does not make it tumble.
    KnockedOff {
        /// What it stood on or held.
        from: Attachment,
        /// Which obstacle dealt the blow, if one did.
        by: Option<ObstacleId>,
    },
    /// Obstacles leave it too little room, or it is still inside what it was pressed into.
    Crushed {
        /// How deep they overlap beyond the margin, metres.
        depth: f64,
    },
    /// Lost hit points.
    Hurt {
        /// How many, 0 to 1.
        damage: f64,
    },
    /// Is doing something else now.
    Changed {
        /// Before.
        from: ClimberMode,
        /// Now.
        to: ClimberMode,
    },
    /// Something that a mode of the game's own reports.
    Custom {
        /// Which mode.
        mode: u16,
        /// What happened, as the mode defines.
        what: u32,
        /// How much of it, as the mode defines.
        value: f64,
    },
    /// Obstacles answered with numbers that are not finite: nothing else happened in this tick.
    NotFinite,
}

/// What a climber gave to something that can be pushed.
///
/// What it stands on, grips or hangs from is given its weight: mass times gravity, at the point that supports it, however
/// it walks or climbs there. What it lands on or strikes in the air is given, along the contact, the momentum that brings
/// both to one speed; what it runs into likewise, but at most [`BodyConfig::push_force`](crate::BodyConfig::push_force).
/// Several that are pushed at once share that. No push comes of a jump, or of its feet as it begins to walk.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Push {
    /// To what.
    pub obstacle: ObstacleId,
    /// Which point of its material.
    pub material: MaterialPoint,
    /// Where, in world space.
    pub point: DVec3,
    /// Newton seconds, in world space.
    pub impulse: DVec3,
}

/// What a step did, beside the new state.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct StepReport {
    /// In the order in which they happened; empty in most ticks, and then without memory.
    pub events: Vec<ClimberEvent>,
    /// What it pushed; apply it to the bodies before their next step, or do not. Without memory where nothing can be
    /// pushed.
    pub pushes: Vec<Push>,
    /// By how much contacts moved it away from where it was carried and wanted to go.
    pub pushed_out: DVec3,
    /// How deep anything is in the core, below the margin, metres: 0 but when crushed, or when rounds did not suffice.
    pub penetration: f64,
    /// Rounds that the movement took.
    pub rounds: u32,
    /// Changes of mode in this tick.
    pub mode_changes: u32,
    /// More changes were wanted than a tick allows (4): the rest follows in the next.
    pub changes_left: bool,
    /// The rounds sufficed: there is nothing on the way from where it was to where it is. What the body began inside of,
    /// or is crushed by, does not count. Of a body whose support was put elsewhere it says nothing: it is pushed out of what
    /// is there.
    pub is_clear: bool,
}
