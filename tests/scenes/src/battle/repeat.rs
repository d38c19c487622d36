//! How a clip is repeated. One that is not a loop is played to its end and back again, so that all poses come from the
//! file and nothing jumps. (`SkinnedSurface::teleport` at the seam would report no motion either, but it teleports
//! whatever stands on the skin, and rides exist to test carrying.)

use clamber_animation::Seam;

/// Seconds in which a clip that turns back slows down to rest, at most the clip's length. A shorter time jerks harder.
const TURN: f64 = 0.25;

/// How a clip goes on after its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Repeat {
    /// The clip begins again.
    Loop,
    /// The clip runs backwards to its beginning, and forwards again.
    BackAndForth,
    /// The clip stays at its beginning.
    Hold,
}

impl Repeat {
    /// How a clip with this seam is repeated.
    pub fn of(seam: Seam) -> Self {
        if seam.is_loop() {
            Self::Loop
        } else {
            Self::BackAndForth
        }
    }

    /// The time within a clip of length `duration`, `time` seconds after the clip was first played. All in seconds.
    pub fn time(self, time: f64, duration: f64) -> f64 {
        if duration <= 0.0 || self == Self::Hold {
            return 0.0;
        }
        if self == Self::Loop {
            return time.rem_euclid(duration);
        }
        // A triangle wave with its corners rounded to parabolas over `turn` seconds, which makes each half `turn`
        // longer.
        let turn = TURN.min(duration);
        let half = duration + turn;
        let phase = time.rem_euclid(2.0 * half);
        let along = phase.min(2.0 * half - phase);
        let rounded = |from_end: f64| {
            if from_end < turn {
                0.5 * from_end * from_end / turn
            } else {
                from_end - 0.5 * turn
            }
        };
        if along < 0.5 * half {
            rounded(along)
        } else {
            duration - rounded(half - along)
        }
    }
}
