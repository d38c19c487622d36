//! How high the ground is below somebody who walks: smooth over steps, and without lag.

use clamber_animation::Spring;
use glam::DVec3;

use super::hold::Surroundings;

/// Where the ground is looked for, as shares of the leg: from above the feet to below (Unreal's foot placement: 0.75 m
/// and 1 m), and half of the way over which it is averaged.
const ABOVE: f64 = 0.9;
const BELOW: f64 = 1.2;
const HALF_WINDOW: f64 = 0.36;

/// Points at which the ground is looked for, each way.
const POINTS: i32 = 3;

/// How much higher or lower than below the feet the ground counts, as a share of the leg and of the distance.
const STEP: f64 = 0.3;
const SLOPE: f64 = 1.4;

/// Time for half of the way to the ground's height, seconds: Unreal's spring of the pelvis. It does not lag on slopes,
/// since it follows with the slope's own speed.
const SETTLE: f64 = 0.09;

/// The ground below the feet.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Ground {
    /// Height that is shown, along up, less the height that was found.
    error: Spring<f64>,
    /// The height that was found, and how it changes, metres and metres a second.
    found: f64,
    rate: f64,
}

/// What is looked for in one frame.
pub(crate) struct Look<'a> {
    pub(crate) around: &'a Surroundings<'a>,
    pub(crate) up: DVec3,
    /// The lowest point of the body's ball.
    pub(crate) bottom: DVec3,
    /// Level velocity relative to the ground.
    pub(crate) velocity: DVec3,
    pub(crate) leg: f64,
}

impl Look<'_> {
    fn height_at(&self, away: DVec3) -> Option<f64> {
        let from = self.bottom + away + self.up * (ABOVE * self.leg);
        let found = self
            .around
            .cast(from, -self.up, (ABOVE + BELOW) * self.leg)?;
        Some(found.contact.point.dot(self.up))
    }

    /// The ground's height and how fast it changes.
    fn find(&self) -> (f64, f64) {
        let bottom = self.bottom.dot(self.up);
        let middle = self.height_at(DVec3::ZERO);
        let middle = middle.filter(|height| (height - bottom).abs() < 0.5 * self.leg);
        let middle = middle.unwrap_or(bottom);
        let speed = self.velocity.length();
        let walks = (speed / (0.3 * self.leg)).min(1.0);
        if walks < 1e-3 {
            return (middle, 0.0);
        }
        let ahead = self.velocity / speed;
        let (mut sum, mut ends) = (middle, [middle; 2]);
        for side in [-1, 1] {
            let mut last = middle;
            for point in 1..=POINTS {
                let far = HALF_WINDOW * self.leg * f64::from(point) / f64::from(POINTS);
                let height = self.height_at(ahead * (far * f64::from(side)));
                // Walls, and holes beside the way, are no ground.
                let most = STEP * self.leg + SLOPE * far;
                let height = height.filter(|height| (height - middle).abs() < most);
                last = height.unwrap_or(last);
                let share = if point == POINTS { 0.5 } else { 1.0 };
                sum += last * share;
            }
            ends[usize::from(side > 0)] = last;
        }
        let mean = sum / f64::from(2 * POINTS);
        let slope = (ends[1] - ends[0]) / (2.0 * HALF_WINDOW * self.leg);
        (middle + (mean - middle) * walks, slope * speed * walks)
    }
}

impl Ground {
    /// Starts at what is found.
    pub(crate) fn at(look: &Look<'_>) -> Self {
        let (found, rate) = look.find();
        Self {
            error: Spring::default(),
            found,
            rate,
        }
    }

    /// `carried` is how far the ground moved along up.
    pub(crate) fn step(&mut self, look: &Look<'_>, carried: f64, dt: f64) {
        let (found, rate) = look.find();
        let expected = self.found + carried + 0.5 * (self.rate + rate) * dt;
        self.error.value += expected - found;
        self.error.step(0.0, SETTLE, dt);
        self.found = found;
        self.rate = rate;
    }

    /// The ground's rise per metre of the way.
    pub(crate) fn slope(&self, speed: f64) -> f64 {
        if speed > 0.1 { self.rate / speed } else { 0.0 }
    }

    pub(crate) fn height(&self) -> f64 {
        self.found + self.error.value
    }
}
