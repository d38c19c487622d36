use clamber_climber::{ClimberState, Knockback};
use clamber_world::{Attachment, ObstacleId};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// All of a fighter that changes and has to be saved: a plain value. Its number and configuration are not included.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FighterState {
    /// State of its climber: position, velocity, support, stamina and hit points.
    pub climber: ClimberState,
    /// What it does with its weapons now.
    pub act: WeaponAction,
    /// The [`ClimberInput::actions`](clamber_climber::ClimberInput::actions) of its last input, to tell new presses of
    /// buttons.
    pub actions: u32,
    /// The blow that reaches it in its next step; `None` without one.
    pub knockback: Option<Knockback>,
    /// Hit points that it loses in the next tick without a blow.
    pub harm: f64,
    /// Seconds for which the impact of its own blade still holds it.
    pub hit_stop: f64,
    /// Seconds since its death; `None` while it is alive.
    pub dead: Option<f64>,
    /// Arrows left; 0 if they are not counted ([`BowConfig::arrows`](crate::BowConfig::arrows)).
    pub arrows: u32,
    /// State of its random stream, from which the straying of arrows is drawn.
    pub random: u64,
    /// False until it has found room: when it joins, after an order moved or revived it, and after an order put a
    /// creature on it. It looks for room at once, then every half second.
    pub has_begun: bool,
    /// Spawn point after a death: the centre of its climber's ball, in world space, metres.
    pub spawn: DVec3,
}

/// Offset of the indices of plates in the list `harmed` of [`WeaponAction::Cut`]. Indices of weak points are below it.
pub(super) const HARMED_PLATES: u32 = 1 << 31;

/// What a fighter does with its weapons: one thing at a time, from the press of a button until it can do the next.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum WeaponAction {
    /// No act: a new one can begin.
    #[default]
    Ready,
    /// Cuts with the sword.
    Cut {
        /// Seconds since the cut began.
        seconds: f64,
        /// Parts of creatures that this cut has struck: the creature's obstacle id, and the part's index.
        struck: Vec<(ObstacleId, u32)>,
        /// Weak points and plates that this cut has hurt: the creature's obstacle id, and the index. 2^31 is added to
        /// the index of a plate.
        harmed: Vec<(ObstacleId, u32)>,
    },
    /// Raises the sword for a stab.
    Raise {
        /// Seconds since it began to raise the sword.
        seconds: f64,
        /// True if it has been in the air all the time.
        falls: bool,
    },
    /// Holds the raised sword while the stab gets stronger.
    Charge {
        /// Share of the full strength, from 0 to 1.
        charge: f64,
        /// True if it has been in the air all the time.
        falls: bool,
    },
    /// Brings the blade down.
    Strike {
        /// Seconds since the strike began.
        seconds: f64,
        /// Share of the full strength, from 0 to 1.
        charge: f64,
        /// Where the blade goes.
        target: StabTarget,
    },
    /// Falls with the blade below its body: a stab in a fall, which lands on the skin that the blade touches.
    Plunge {
        /// Share of the full strength, from 0 to 1.
        charge: f64,
    },
    /// Cannot act yet after a stab: the blade is held where the stab has ended, in the skin or in the air, until the
    /// fighter can act again.
    PullOut {
        /// Seconds left.
        seconds: f64,
        /// Where the blade is: in this point of skin, or in the air.
        target: StabTarget,
    },
    /// Draws the bow.
    Draw {
        /// Share of a full draw, from 0 to 1.
        drawn: f64,
    },
    /// Has thrown a stone, and cannot act yet.
    Throw {
        /// Seconds left.
        seconds: f64,
    },
}

/// Where the blade of a stab goes: into a point of a creature's skin, whether or not a weak point is there, or into the
/// air. The rules of the fight choose it, not the player. A game only reads it, for example to draw the sword.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum StabTarget {
    /// Not chosen yet: the step in which the strike begins chooses it at its end.
    Open,
    /// A point of a creature's skin, which the target follows as the skin moves. The blade's tip is there when it
    /// strikes. The attachment's offset from the point is a unit vector: the direction of the blade.
    Skin(Attachment),
    /// No skin in reach: the stab hits the air.
    Air,
}

impl FighterState {
    pub(crate) fn is_finite(&self) -> bool {
        let target = |target: &StabTarget| match target {
            StabTarget::Skin(at) => at.is_finite(),
            StabTarget::Open | StabTarget::Air => true,
        };
        let act = match &self.act {
            WeaponAction::Ready => true,
            WeaponAction::Cut { seconds, .. }
            | WeaponAction::Raise { seconds, .. }
            | WeaponAction::Throw { seconds } => is_time(*seconds),
            WeaponAction::Charge { charge, .. } | WeaponAction::Plunge { charge } => {
                is_share(*charge)
            }
            WeaponAction::Draw { drawn } => is_share(*drawn),
            WeaponAction::Strike {
                seconds,
                charge,
                target: to,
            } => is_time(*seconds) && is_share(*charge) && target(to),
            WeaponAction::PullOut {
                seconds,
                target: at,
            } => is_time(*seconds) && target(at),
        };
        let blow = self
            .knockback
            .is_none_or(|blow| blow.velocity.is_finite() && is_share(blow.damage));
        act && blow
            && self.spawn.is_finite()
            && is_time(self.harm)
            && is_time(self.hit_stop)
            && is_time(self.dead.unwrap_or(0.0))
    }
}

fn is_time(x: f64) -> bool {
    (0.0..=f64::MAX).contains(&x)
}

fn is_share(x: f64) -> bool {
    (0.0..=1.0).contains(&x)
}
