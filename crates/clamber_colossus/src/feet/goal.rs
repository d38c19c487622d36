//! The goal of a foot in a tick: where its clip has it, and where it is to land.

use glam::DVec3;

/// Shortest duration of a step that is not in a clip, as a multiple of `sqrt(leg / g)`.
pub(crate) const STEP_TIME: f64 = 1.5;

/// Shares of a swing at which the ground on its way is checked.
pub(crate) const SWING_SHARES: [f64; 3] = [0.25, 0.5, 0.75];

/// A swinging foot does not come down if its clip stands for less than this, as a share of the duration of a step.
const TOO_SHORT_STAND: f64 = 0.2;

/// Gravitational acceleration, metres a second squared. It sets the duration of steps.
pub(crate) const GRAVITY: f64 = 9.81;

/// The goal of a foot in a tick, in world space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FootGoal {
    /// Position of the ball in the clip.
    pub(crate) clip: DVec3,
    /// Position of the ball in the clip once the clip has faded in.
    pub(crate) settled: DVec3,
    /// True if the foot stands in the clip.
    pub(crate) stands: bool,
    /// Seconds for which the foot still stands in the clip.
    pub(crate) stands_for: f64,
    /// Seconds until the foot next stands in the clip.
    pub(crate) lands_in: f64,
    /// Position of the ball in the clip at that time, for ground at the height of the creature's origin.
    pub(crate) lands_at: DVec3,
    /// Horizontal vector from `lands_at` to the place where the foot is to land.
    pub(crate) aside: DVec3,
    /// Largest horizontal acceleration of the offset, metres a second squared.
    pub(crate) most_aside: f64,
    /// Largest vertical acceleration of the offset in a swing, metres a second squared.
    pub(crate) most_up: f64,
    /// Height of the ball in the clip at [`SWING_SHARES`] of the time until it lands.
    pub(crate) ahead: [f64; 3],
    /// Yaw of the foot in the clip, radians.
    pub(crate) heading: f64,
    /// Height of the ball of a standing foot above the ground, metres.
    pub(crate) ball_height: f64,
    /// Length of the leg, metres.
    pub(crate) leg: f64,
    /// True if the foot may take a step of its own.
    pub(crate) may_step: bool,
    /// True if the foot checks in this tick whether its ground is still there.
    pub(crate) looks: bool,
    /// True if the clip walks or turns, so that it has steps of its own.
    pub(crate) is_gait: bool,
    /// True if the clip lifts the foot before it ends.
    pub(crate) is_lifted: bool,
}

impl FootGoal {
    /// True if the clip lifts the foot so soon that the foot need not come down before.
    pub(super) fn is_lifted_soon(&self) -> bool {
        self.is_gait && self.stands_for < TOO_SHORT_STAND * self.step_time()
    }

    /// Shortest duration of a step that is not in the clip, seconds.
    pub(super) fn step_time(&self) -> f64 {
        STEP_TIME * (self.leg / GRAVITY).sqrt()
    }
}
