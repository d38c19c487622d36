use clamber_climber::{Blow, ClimberState};
use clamber_world::{Attachment, ObstacleId};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// All that changes in a fighter: a plain value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FighterState {
    /// The climber.
    pub climber: ClimberState,
    /// What it is doing with its weapons.
    pub act: Act,
    /// Its buttons in the last tick.
    pub actions: u32,
    /// A blow that it gets with the next tick.
    pub blow: Option<Blow>,
    /// Damage without a blow that it takes with the next tick.
    pub harm: f64,
    /// Seconds for which it is still held by the impact of its own weapon.
    pub hit_stop: f64,
    /// Seconds since its death; `None` while it lives.
    pub dead: Option<f64>,
    /// Arrows left, if they are counted.
    pub arrows: u32,
    /// State of its random stream, of which its arrows stray.
    pub random: u64,
    /// False until it has found room where it is: at its beginning, after it was placed, and after a creature was put
    /// there. It looks in its next step, and then now and then.
    pub has_begun: bool,
    /// Where it stands up again after its death: the centre of its climber's ball.
    pub spawn: DVec3,
}

/// Where the numbers of plates begin in [`Act::Cut`].
pub(super) const HARMED_PLATES: u32 = 1 << 31;

/// What a fighter does with its weapons.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Act {
    /// Nothing: it can begin something.
    #[default]
    Ready,
    /// Cuts with the sword.
    Cut {
        /// Seconds since it began.
        seconds: f64,
        /// What this cut has struck: creatures, and parts of them.
        struck: Vec<(ObstacleId, u32)>,
        /// What this cut has hurt: creatures, and the numbers of their weak points, or 2^31 more than those of plates.
        harmed: Vec<(ObstacleId, u32)>,
    },
    /// Raises the sword for a stab.
    Raise {
        /// Seconds since it began.
        seconds: f64,
        /// True in a fall or a jump.
        falls: bool,
    },
    /// Holds the sword up while the stab gets stronger.
    Charge {
        /// Share of the full strength, from 0 to 1.
        charge: f64,
        /// True in a fall or a jump.
        falls: bool,
    },
    /// The blade comes down.
    Strike {
        /// Seconds since it began.
        seconds: f64,
        /// Share of the full strength.
        charge: f64,
        /// Where it goes.
        target: Target,
    },
    /// Falls with the blade ahead.
    Plunge {
        /// Share of the full strength.
        charge: f64,
    },
    /// Pulls the blade out.
    PullOut {
        /// Seconds left.
        seconds: f64,
        /// Where the blade is.
        target: Target,
    },
    /// Draws the bow.
    Draw {
        /// Share of a full draw, from 0 to 1.
        drawn: f64,
    },
    /// Has thrown a stone.
    Throw {
        /// Seconds left.
        seconds: f64,
    },
}

/// Where a stab goes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Target {
    /// Not yet chosen: at the end of this tick.
    Open,
    /// A point of a creature's skin: the blade's tip is there when it strikes.
    Skin(Attachment),
    /// Nothing in reach: the blade goes into the air.
    Air,
}

impl FighterState {
    pub(crate) fn is_finite(&self) -> bool {
        let target = |target: &Target| match target {
            Target::Skin(at) => at.is_finite(),
            Target::Open | Target::Air => true,
        };
        let act = match &self.act {
            Act::Ready => true,
            Act::Cut { seconds, .. } | Act::Raise { seconds, .. } | Act::Throw { seconds } => {
                is_time(*seconds)
            }
            Act::Charge { charge, .. } | Act::Plunge { charge } => is_share(*charge),
            Act::Draw { drawn } => is_share(*drawn),
            Act::Strike {
                seconds,
                charge,
                target: to,
            } => is_time(*seconds) && is_share(*charge) && target(to),
            Act::PullOut {
                seconds,
                target: at,
            } => is_time(*seconds) && target(at),
        };
        let blow = self
            .blow
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
