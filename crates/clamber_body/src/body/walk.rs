//! Which clips of walking are mixed, and where in its cycle the body is.

use clamber_animation::damp;
use glam::DVec3;

use crate::Figure;
use crate::figure::Stride;

/// Time for half of a change between clips, seconds.
const MIX: f64 = 0.08;

/// Share of a walk's speed at which all of the walk is shown; below it, steps get shorter.
const FULL: f64 = 0.7;

/// How much shorter steps are on a slope, per rise.
const SHORTER: f64 = 1.8;

/// Leg for which clips are made, metres: speeds change with the square root of its length (Froude).
pub(crate) const LEG: f64 = 0.831;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Walk {
    /// Shares of the clips of [`STRIDES`](crate::figure::STRIDES), of the part that is not idle; they sum to 1.
    pub(crate) shares: [f64; 5],
    /// 0 stands, 1 walks.
    pub(crate) going: f64,
    /// Share of the cycle; at 0 the left foot comes down.
    pub(crate) phase: f64,
    /// Cycles a second.
    pub(crate) rate: f64,
    pub(crate) stride: Stride,
}

impl Walk {
    pub(crate) fn standing(figure: &Figure) -> Self {
        let shares = [1.0, 0.0, 0.0, 0.0, 0.0];
        Self {
            shares,
            going: 0.0,
            phase: 0.0,
            rate: 0.0,
            stride: figure.gait().mixed(&shares),
        }
    }

    /// `velocity` is relative to the ground; `ahead` and `left` are the body's.
    pub(crate) fn step(
        &mut self,
        figure: &Figure,
        velocity: DVec3,
        [ahead, left]: [DVec3; 2],
        slope: f64,
        dt: f64,
    ) {
        let speed = velocity.length();
        let size = (LEG / figure.leg_length()).sqrt();
        let strides = figure.gait().strides();
        let [walk, run] = [0, 1].map(|clip| strides[clip].speed * size);
        let goes = (speed / (FULL * walk)).min(1.0);
        if speed > 1e-3 {
            let way = velocity / speed;
            let [x, z] = [way.dot(left), way.dot(ahead)];
            let runs = ((speed - walk) / (run - walk).max(1e-6)).clamp(0.0, 1.0);
            let square = |part: f64| part.max(0.0) * part.max(0.0);
            let (forward, back) = (square(z), square(-z));
            let wanted = [
                forward * (1.0 - runs),
                forward * runs,
                back,
                square(x),
                square(-x),
            ];
            let sum: f64 = wanted.iter().sum();
            for (share, wanted) in self.shares.iter_mut().zip(wanted) {
                *share = damp(*share, wanted / sum.max(1e-9), MIX, dt);
            }
        }
        // Shorter steps on slopes and stairs, so that legs reach.
        let most = 1.0 / (1.0 + SHORTER * slope.abs());
        let wanted = goes.sqrt().min(most);
        self.going = damp(self.going, wanted, MIX, dt);
        self.stride = figure.gait().mixed(&self.shares);
        // Shorter steps where only a part of the walk is shown.
        let length = self.stride.length * wanted.max(0.3);
        self.rate = if speed > 0.02 {
            speed / length.max(1e-6)
        } else {
            0.0
        };
        self.phase = (self.phase + self.rate * dt).rem_euclid(1.0);
    }

    /// True if feet follow the cycle.
    pub(crate) fn is_going(&self) -> bool {
        self.going > 0.35 && self.rate > 0.0
    }
}
