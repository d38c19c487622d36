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
    /// The beam of its attack, if there is one in this tick.
    pub beam: Option<ActiveBeam>,
}

/// A beam, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActiveBeam {
    /// The state whose attack it is of.
    pub state: StateId,
    /// Where it goes out from.
    pub from: DVec3,
    /// Where it ends: at its length, or at what stops it.
    pub to: DVec3,
    /// Metres.
    pub radius: f64,
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
    /// An attack threw something: [`Creature::shots`](super::Creature::shots) has it as long as it flies.
    Threw {
        /// The state whose attack it is of.
        state: StateId,
        /// Its number.
        number: u64,
        /// From where, in world space.
        place: DVec3,
        /// Metres a second.
        velocity: DVec3,
    },
    /// What it threw has struck somebody, or met terrain or another creature. No event tells of a shot that ends
    /// otherwise: since its time is over, it is too far away, or there are too many.
    Burst {
        /// The state whose attack it was of.
        state: StateId,
        /// Its number.
        number: u64,
        /// Where, in world space.
        place: DVec3,
    },
    /// A wave goes out: [`Creature::waves`](super::Creature::waves) has it as long as it spreads.
    Wave {
        /// The state whose attack it is of.
        state: StateId,
        /// From where, in world space.
        place: DVec3,
        /// How far, metres.
        radius: f64,
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

/// A blow that a limb, a wave, a shot or a beam dealt somebody.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blow {
    /// Whom: [`Person::id`](super::Person::id).
    pub person: u64,
    /// Change of velocity, metres a second: along the motion of what struck; of a wave, away from where it began and up.
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
    /// The limb goes back, and hurts nobody. What the attack has thrown or sent out still does.
    Recovery,
}
