use super::arithmetic::number;
use super::certificate::{Apart, Last, Motion};
use crate::MovingPair;

/// The answer of a sweep for a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Claim {
    /// Time of first contact, from 0 to 1; `None` if the pair never touches.
    pub time: Option<f64>,
    /// True if the sweep says that the distance may exceed radius plus tolerance at that time.
    pub undecided: bool,
}

/// The result of checking a [`Claim`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// Whether the pair is apart before the claimed time; without one, whether it is apart from time 0 to 1.
    pub before: Apart,
    /// True if the distance at the claimed time is at most radius plus tolerance. Always true for a claim without a
    /// time.
    pub near: bool,
}

/// The least tolerance as a share of [`MovingPair::size`], as sweeps document it. A smaller tolerance is raised to
/// this.
const LEAST_TOLERANCE: f64 = 1.0 / (1u64 << 45) as f64;

impl Claim {
    /// Proves or refutes the claim, in exact arithmetic where f64 cannot decide.
    ///
    /// # Panics
    /// If a number of the pair, the time or the tolerance is not finite, or the time is not in 0..=1.
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
    /// True if the pair touches before the claimed time, or touches although the claim has no time.
    pub fn is_late(&self) -> bool {
        matches!(self.before, Apart::Until(_))
    }

    /// True if [`Verdict::is_late`] could be neither proved nor refuted.
    pub fn is_unknown(&self) -> bool {
        matches!(self.before, Apart::Unknown(_))
    }
}
