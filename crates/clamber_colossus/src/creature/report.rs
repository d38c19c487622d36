use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::brain::StateId;

/// What happened in one step of a creature: its events, the blows that it dealt, and its beam.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CreatureReport {
    /// Events of the step, in order.
    pub events: Vec<CreatureEvent>,
    /// Blows that the creature dealt to people. Give each one to its climber's next step, as a knockback
    /// of the same velocity and damage.
    pub blows: Vec<StrikeHit>,
    /// Beam of the creature's attack in this tick; `None` if it sends none.
    pub beam: Option<ActiveBeam>,
}

/// The beam of an attack in one tick, in world space. It lasts from the clip's marker `active` to its marker
/// `recovery`, and ends at once if the creature stops attacking.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActiveBeam {
    /// State of the brain whose attack sends the beam: the one in which the creature attacks now.
    /// [`Brain::path`](crate::Brain::path) gives its name.
    pub state: StateId,
    /// Start of the beam, in world space, metres: the last joint of the attack's limb
    /// ([`Attack::limb`](crate::brain::Attack::limb)).
    pub from: DVec3,
    /// End of the beam, in world space, metres: at its full length, or at the obstacle that stops it.
    pub to: DVec3,
    /// Radius of the beam, metres.
    pub radius: f64,
}

/// An event of a creature's step: an action of the creature, or an effect on it. A beam and a blow to a person are no
/// events: [`CreatureReport::beam`] and [`CreatureReport::blows`] have them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum CreatureEvent {
    /// The brain went from one state to another.
    Entered {
        /// The state that was left.
        from: StateId,
        /// The state that was entered.
        to: StateId,
    },
    /// The creature's clip passed a marker.
    Marker {
        /// The marker's name.
        name: String,
    },
    /// The creature has arrived where the game had sent it, and follows its brain again.
    Arrived {
        /// The place to which the creature was sent, in world space, metres.
        place: DVec3,
    },
    /// The creature has given up its errand, since it is blocked or its brain is in a final state. It follows its brain
    /// again.
    Stopped {
        /// The place to which the creature was sent, in world space, metres.
        place: DVec3,
    },
    /// A foot of the creature came down: for sounds and dust.
    Plant {
        /// Index of the leg in [`BodyFile::legs`](crate::BodyFile::legs).
        leg: usize,
        /// Position of the ball of the foot, in world space, metres.
        place: DVec3,
    },
    /// An attack released a shot: [`Creature::shots`](super::Creature::shots) lists it while it flies.
    Threw {
        /// State whose attack released the shot.
        state: StateId,
        /// Number of the shot.
        number: u64,
        /// Start of the shot, in world space, metres.
        place: DVec3,
        /// Initial velocity, in world space, metres a second.
        velocity: DVec3,
    },
    /// A shot struck a person, or met terrain or another creature. There is no event for a shot that ends because its
    /// time is over, it is too far away, or there are too many shots.
    Burst {
        /// State whose attack released the shot.
        state: StateId,
        /// Number of the shot.
        number: u64,
        /// Position of the shot's centre, in world space, metres.
        place: DVec3,
    },
    /// An attack sent out a wave: [`Creature::waves`](super::Creature::waves) lists it while it spreads.
    Wave {
        /// State whose attack sent out the wave.
        state: StateId,
        /// Centre of the wave, in world space, metres.
        place: DVec3,
        /// Radius at which the wave ends, metres.
        radius: f64,
    },
    /// A weak point took damage.
    Hurt {
        /// Index of the weak point in [`CreatureKind::weak_points`](crate::CreatureKind::weak_points).
        weak_point: usize,
        /// The damage done, in the unit of the weak point's hit points.
        damage: f64,
        /// True if the weak point has no hit points left.
        used_up: bool,
    },
    /// A plate staggered under a blow.
    Staggered {
        /// Index of the plate in [`CreatureKind::plates`](crate::CreatureKind::plates).
        plate: usize,
        /// True if the plate breaks off: its triangles are hidden from queries, and people on them fall.
        breaks: bool,
    },
}

/// A blow that a creature dealt to a person in its last step: by a limb, a wave, a shot or a beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrikeHit {
    /// [`Person::id`](super::Person::id) of the person.
    pub person: u64,
    /// Change of the person's velocity, in world space, metres a second: along the motion of the limb or the shot,
    /// along the beam, or up and away from the centre of the wave.
    pub velocity: DVec3,
    /// Share of the person's full hit points that the blow costs, 0 to 1.
    pub damage: f64,
    /// Point where the blow met the person, in world space, metres. For a shot or a beam it is on the middle line of
    /// its path; for a wave, the point of the axis of the person's body that is nearest to the wave's centre.
    pub place: DVec3,
    /// State whose attack dealt the blow.
    pub state: StateId,
}

/// Where an attack is in its clip: before the marker `active`, between `active` and `recovery`, or after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum AttackPhase {
    /// The limb is raised: time to get away.
    WindUp,
    /// The limb hurts people that it touches.
    Active,
    /// The limb goes back, and hurts nobody. Waves and shots of the attack still do.
    Recovery,
}
