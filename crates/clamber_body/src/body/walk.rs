//! Mixes the locomotion clips and advances the gait's cycle.

use clamber_animation::damp;
use glam::DVec3;

use crate::Figure;
use crate::figure::Stride;

/// Half time of a change between clips, seconds.
const MIX_HALF_TIME: f64 = 0.08;

/// Share of the walk clip's speed from which the walk is shown at full weight. Below it, steps get shorter.
const FULL_WALK_SHARE: f64 = 0.7;

/// Factor in the limit `1 / (1 + SLOPE_SHORTENING * slope)` of the walk's weight and of its steps; the slope is the
/// rise per metre.
const SLOPE_SHORTENING: f64 = 1.8;

/// Length of the leg for which the clips are made, metres. Speeds change with the square root of the leg's length
/// (Froude).
pub(crate) const REFERENCE_LEG_LENGTH: f64 = 0.831;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Walk {
    /// Weights of the locomotion clips, in the order of [`STRIDES`](crate::figure::STRIDES). They sum to 1.
    pub(crate) shares: [f64; 5],
    /// Weight of locomotion against standing, from 0 (stands) to 1 (walks).
    pub(crate) going: f64,
    /// Phase of the cycle, 0 to 1; the left foot comes down at 0.
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

    /// Advances the cycle by `dt` seconds. `velocity` is relative to the ground; `ahead` and `left` are directions of
    /// the body.
    pub(crate) fn step(
        &mut self,
        figure: &Figure,
        velocity: DVec3,
        [ahead, left]: [DVec3; 2],
        slope: f64,
        dt: f64,
    ) {
        let speed = velocity.length();
        let size = (REFERENCE_LEG_LENGTH / figure.leg_length()).sqrt();
        let strides = figure.gait().strides();
        let [walk, run] = [0, 1].map(|clip| strides[clip].speed * size);
        let goes = (speed / (FULL_WALK_SHARE * walk)).min(1.0);
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
                *share = damp(*share, wanted / sum.max(1e-9), MIX_HALF_TIME, dt);
            }
        }
        // Steps are shorter on slopes and stairs, so that legs reach.
        let most = 1.0 / (1.0 + SLOPE_SHORTENING * slope.abs());
        let wanted = goes.sqrt().min(most);
        self.going = damp(self.going, wanted, MIX_HALF_TIME, dt);
        self.stride = figure.gait().mixed(&self.shares);
        // Steps are shorter where only a part of the walk is shown.
        let length = self.stride.length * wanted.max(0.3);
        self.rate = if speed > 0.02 {
            speed / length.max(1e-6)
        } else {
            0.0
        };
        self.phase = (self.phase + self.rate * dt).rem_euclid(1.0);
    }

    /// True if feet follow the cycle of the gait.
    pub(crate) fn is_going(&self) -> bool {
        self.going > 0.35 && self.rate > 0.0
    }
}
