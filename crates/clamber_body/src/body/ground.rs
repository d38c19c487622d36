//! Height of the ground below a walking body: smooth over steps, without lag on slopes.

use clamber_animation::Spring;
use glam::DVec3;

use super::hold::Surroundings;

/// Height above the body's lowest point at which rays to the ground begin, as a share of the leg's length (Unreal's
/// foot placement: 0.75 m).
const RAY_START_HEIGHT: f64 = 0.9;

/// Depth below the body's lowest point at which rays to the ground end, as a share of the leg's length (Unreal's foot
/// placement: 1 m).
const RAY_END_DEPTH: f64 = 1.2;

/// Half of the distance over which the height is averaged, as a share of the leg's length.
const HALF_WINDOW: f64 = 0.36;

/// Number of rays to the ground ahead, and as many behind.
const RAYS_AHEAD: i32 = 3;

/// Difference in height from the ground in the middle up to which a ray's hit counts as ground, as a share of the leg's
/// length.
const MAX_STEP_HEIGHT: f64 = 0.3;

/// Growth of that difference with the ray's distance from the middle, metres per metre.
const STEP_HEIGHT_PER_DISTANCE: f64 = 1.4;

/// Half time of the shown height's way to the ground's height, seconds: Unreal's pelvis spring. On slopes the height
/// does not lag, since it also moves at the slope's rate.
const HEIGHT_HALF_TIME: f64 = 0.09;

/// The ground below the feet.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Ground {
    /// Shown height less the found height, metres along up.
    error: Spring<f64>,
    /// The found height along up, metres.
    found: f64,
    /// Rate of change of the found height, metres a second.
    rate: f64,
}

/// Input of the search for the ground in one frame.
pub(crate) struct Look<'a> {
    pub(crate) around: &'a Surroundings<'a>,
    pub(crate) up: DVec3,
    /// The lowest point of the climber's ball.
    pub(crate) bottom: DVec3,
    /// Level velocity relative to the ground.
    pub(crate) velocity: DVec3,
    pub(crate) leg: f64,
}

impl Look<'_> {
    fn height_at(&self, away: DVec3) -> Option<f64> {
        let from = self.bottom + away + self.up * (RAY_START_HEIGHT * self.leg);
        let found = self.around.cast(
            from,
            -self.up,
            (RAY_START_HEIGHT + RAY_END_DEPTH) * self.leg,
        )?;
        Some(found.contact.point.dot(self.up))
    }

    /// The ground's mean height along up, metres, and its rate of change, metres a second.
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
            for point in 1..=RAYS_AHEAD {
                let far = HALF_WINDOW * self.leg * f64::from(point) / f64::from(RAYS_AHEAD);
                let height = self.height_at(ahead * (far * f64::from(side)));
                // Walls, and holes beside the path, do not count as ground.
                let most = MAX_STEP_HEIGHT * self.leg + STEP_HEIGHT_PER_DISTANCE * far;
                let height = height.filter(|height| (height - middle).abs() < most);
                last = height.unwrap_or(last);
                let share = if point == RAYS_AHEAD { 0.5 } else { 1.0 };
                sum += last * share;
            }
            ends[usize::from(side > 0)] = last;
        }
        let mean = sum / f64::from(2 * RAYS_AHEAD);
        let slope = (ends[1] - ends[0]) / (2.0 * HALF_WINDOW * self.leg);
        (middle + (mean - middle) * walks, slope * speed * walks)
    }
}

impl Ground {
    /// Starts with the shown height at the found height.
    pub(crate) fn at(look: &Look<'_>) -> Self {
        let (found, rate) = look.find();
        Self {
            error: Spring::default(),
            found,
            rate,
        }
    }

    /// Advances the shown height by `dt` seconds. `carried` is how far the climber's support moved along up, metres.
    pub(crate) fn step(&mut self, look: &Look<'_>, carried: f64, dt: f64) {
        let (found, rate) = look.find();
        let expected = self.found + carried + 0.5 * (self.rate + rate) * dt;
        self.error.value += expected - found;
        self.error.step(0.0, HEIGHT_HALF_TIME, dt);
        self.found = found;
        self.rate = rate;
    }

    /// The ground's rise per metre of way, at a speed in metres a second.
    pub(crate) fn slope(&self, speed: f64) -> f64 {
        if speed > 0.1 { self.rate / speed } else { 0.0 }
    }

    pub(crate) fn height(&self) -> f64 {
        self.found + self.error.value
    }
}
