use super::certificate::{Apart, Last, Motion};
use super::number::number;
use crate::MovingPair;

/// What a sweep says of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Claim {
    /// When they first touch; `None` if they never do.
    pub time: Option<f64>,
    /// It may be farther away then than tolerated.
    pub undecided: bool,
}

/// Whether a [`Claim`] holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// Whether they are apart before the time claimed, or all the time.
    pub before: Apart,
    /// At that time they are within radius and tolerance.
    pub near: bool,
}

/// Below this share of the lengths involved a tolerance counts as that, as the sweeps say.
const LEAST_TOLERANCE: f64 = 1.0 / (1u64 << 45) as f64;

impl Claim {
    /// Checks the claim: proofs, in exact arithmetic where f64 leaves anything open.
    ///
    /// # Panics
    /// If a number of the pair, the time or the tolerance is not finite, or the time not in 0..=1.
    pub fn check(&self, pair: &MovingPair, tolerance: f32) -> Verdict {
        let motion = Motion::new(pair);
        let radius = f64::from(pair.radius);
        let Some(time) = self.time else {
            return Verdict {
                before: motion.apart(radius, 1.0, Last::Included),
                near: true,
            };
        };
        let tolerance = f64::from(tolerance).max(pair.size() * LEAST_TOLERANCE);
        let limit = number(radius) + number(tolerance);
        Verdict {
            before: motion.apart(radius, time, Last::Excluded),
            near: motion.exact().is_within(time, &limit),
        }
    }
}

impl Verdict {
    /// They touch before the time claimed.
    pub fn is_late(&self) -> bool {
        matches!(self.before, Apart::Until(_))
    }

    /// It could not be shown whether they do.
    pub fn is_unknown(&self) -> bool {
        matches!(self.before, Apart::Unknown(_))
    }
}
