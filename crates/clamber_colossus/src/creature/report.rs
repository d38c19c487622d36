use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::brain::StateId;

/// What happened in a creature's step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CreatureReport {
    /// What happened, in order.
    pub events: Vec<CreatureEvent>,
    /// Whom it struck. Give each to its climber with the next tick's input.
    pub blows: Vec<Blow>,
}

/// Something that a creature did, or that happened to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum CreatureEvent {
    /// It went from one state to another.
    Entered {
        /// The state that was left.
        from: StateId,
        /// The state that was entered.
        to: StateId,
    },
    /// Its clip passed a marker.
    Marker {
        /// The marker's name.
        name: String,
    },
    /// It is where the game had sent it, and does what its brain wants again.
    Arrived {
        /// Where it was sent.
        place: DVec3,
    },
    /// It does not get on to where the game had sent it, and does what its brain wants again.
    Stopped {
        /// Where it was sent.
        place: DVec3,
    },
    /// A foot came down.
    Plant {
        /// The leg, by its index in the file.
        leg: usize,
        /// Where its ball is, in world space.
        place: DVec3,
    },
    /// A weak point was hurt.
    Hurt {
        /// The weak point, by its index.
        weak_point: usize,
        /// The damage done.
        damage: f64,
        /// True if it is used up by that.
        used_up: bool,
    },
    /// A plate took a blow too many.
    Staggered {
        /// The plate, by its index.
        plate: usize,
        /// True if it breaks off: its triangles are hidden from queries, and people on them fall.
        breaks: bool,
    },
}

/// A blow that a limb dealt somebody.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blow {
    /// Whom: [`Person::id`](super::Person::id).
    pub person: u64,
    /// Change of velocity, metres a second: along the limb's motion.
    pub velocity: DVec3,
    /// Hit points, 0 to 1.
    pub damage: f64,
    /// Where it struck, in world space.
    pub place: DVec3,
    /// The state whose attack it was.
    pub state: StateId,
}

/// Where an attack is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum AttackPhase {
    /// The limb is raised: the time to get away.
    WindUp,
    /// The limb hurts whom it touches.
    Active,
    /// The limb goes back, and hurts nobody.
    Recovery,
}
