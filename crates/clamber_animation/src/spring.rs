//! Critically damped springs in closed form: the same motion at any frame rate.
//!
//! The differential equation `x'' = -2 w x' - w^2 (x - goal)` has the solution `x - goal = (a + b t) e^(-w t)`. A step
//! evaluates this solution, so one long step equals many short ones, and no step is too long (Holden 2021,
//! "Spring-It-On: The Game Developer's Spring-Roll-Call").

use core::ops::{Add, Mul, Sub};

use clamber_surface::geometry::{rotation_from_axis_angle, rotation_vector};
use glam::{DQuat, DVec3};

/// The solution of `(1 + x) e^(-x) = 1/2`, no unit: a spring that starts at rest has covered half of its way after `x /
/// w` seconds.
const HALF: f64 = 1.678_346_990_016_661;

/// A value that a spring can move: a number or a vector. Its default must be zero.
pub trait Springy:
    Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self>
{
}

impl<T> Springy for T where
    T: Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self>
{
}

/// A value that follows a goal as fast as it can without overshooting when it starts at rest.
///
/// ```
/// use clamber_animation::Spring;
///
/// let mut height = Spring::at(0.0);
/// height.step(1.0, 0.1, 0.1);
/// assert!((height.value - 0.5).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Spring<T> {
    /// Current value.
    pub value: T,
    /// Rate of change of the value, per second.
    pub velocity: T,
}

impl<T: Springy> Spring<T> {
    /// A spring at rest at a value.
    pub fn at(value: T) -> Self {
        Self {
            value,
            velocity: T::default(),
        }
    }

    /// Advances the spring by `dt` seconds towards `goal`. From rest, it covers half of the way in `half_time` seconds.
    /// With a half time of 0 or less it arrives at the goal at once; with a `dt` of 0 or less nothing changes.
    pub fn step(&mut self, goal: T, half_time: f64, dt: f64) {
        if dt <= 0.0 {
            return;
        }
        if half_time <= 0.0 {
            *self = Self::at(goal);
            return;
        }
        let rate = HALF / half_time;
        let left = libm::exp(-rate * dt);
        let away = self.value - goal;
        let pull = self.velocity + away * rate;
        self.value = goal + (away + pull * dt) * left;
        self.velocity = (self.velocity - pull * (rate * dt)) * left;
    }
}

/// A rotation that follows a goal along the shorter arc: a [`Spring`] on the rotation vector from the goal.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RotationSpring {
    /// Current rotation, a unit quaternion.
    pub rotation: DQuat,
    /// Rate of change of the rotation vector from the goal, radians per second. Near the goal it is the angular
    /// velocity.
    pub velocity: DVec3,
}

impl RotationSpring {
    /// A spring at rest at a rotation.
    pub fn at(rotation: DQuat) -> Self {
        Self {
            rotation,
            velocity: DVec3::ZERO,
        }
    }

    /// Advances the spring by `dt` seconds towards the unit quaternion `goal`; see [`Spring::step`].
    pub fn step(&mut self, goal: DQuat, half_time: f64, dt: f64) {
        let mut spring = Spring {
            value: rotation_vector(self.rotation * goal.conjugate()),
            velocity: self.velocity,
        };
        spring.step(DVec3::ZERO, half_time, dt);
        self.rotation = (rotation_from_vector(spring.value) * goal).normalize();
        self.velocity = spring.velocity;
    }
}

/// Moves a value towards a goal: by half of the remaining way in each `half_time` seconds, at any frame rate.
/// Exponential decay keeps no velocity, so the motion starts abruptly; where that is visible, use a [`Spring`].
pub fn damp<T: Springy>(value: T, goal: T, half_time: f64, dt: f64) -> T {
    if dt <= 0.0 {
        return value;
    }
    if half_time <= 0.0 {
        return goal;
    }
    goal + (value - goal) * libm::exp2(-dt / half_time)
}

/// The square of the largest angle, radians squared, up to which a rotation is computed from Taylor series: half a
/// radian. At larger angles the series would lose digits.
const SMALL: f64 = 0.25;

/// The rotation of a rotation vector: its length is the angle in radians, its direction the axis.
pub(crate) fn rotation_from_vector(vector: DVec3) -> DQuat {
    let square = vector.length_squared();
    if square > SMALL {
        let angle = square.sqrt();
        return rotation_from_axis_angle(vector / angle, angle);
    }
    // Sine and cosine of half the angle by Taylor series, with an error below 1e-16.
    let half = 0.25 * square;
    let series = |terms: [f64; 6]| terms.iter().fold(0.0, |sum, term| 1.0 - half * term * sum);
    let sin = series([
        1.0 / 156.0,
        1.0 / 110.0,
        1.0 / 72.0,
        1.0 / 42.0,
        1.0 / 20.0,
        1.0 / 6.0,
    ]);
    let cos = series([
        1.0 / 132.0,
        1.0 / 90.0,
        1.0 / 56.0,
        1.0 / 30.0,
        1.0 / 12.0,
        1.0 / 2.0,
    ]);
    let axis = vector * (0.5 * sin);
    DQuat::from_xyzw(axis.x, axis.y, axis.z, cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Scene B22: springs follow a fixed goal for one second, at several frame rates.
    #[test]
    fn springs_do_not_depend_on_the_frame_rate() {
        let follow = |rate: usize| {
            let mut spring = Spring {
                value: DVec3::new(1.0, -2.0, 0.5),
                velocity: DVec3::new(-3.0, 0.0, 8.0),
            };
            let mut turn = RotationSpring::at(rotation_from_vector(DVec3::new(1.0, 0.4, -0.2)));
            let mut damped = 3.0;
            for _ in 0..rate {
                let dt = 1.0 / rate as f64;
                spring.step(DVec3::ZERO, 0.2, dt);
                turn.step(DQuat::IDENTITY, 0.2, dt);
                damped = damp(damped, 1.0, 0.2, dt);
            }
            (spring.value, rotation_vector(turn.rotation), damped)
        };
        let once = follow(1);
        assert!(once.0.is_finite() && once.1.is_finite());
        for rate in [30, 60, 144, 1000] {
            let often = follow(rate);
            assert!((often.0 - once.0).length() < 1e-6, "{rate}: {often:?}");
            assert!((often.1 - once.1).length() < 1e-6, "{rate}: {often:?}");
            assert!((often.2 - once.2).abs() < 1e-6, "{rate}: {often:?}");
        }
    }

    #[test]
    fn small_turns_by_series_are_those_by_sines() {
        let axis = DVec3::new(0.36, -0.48, 0.8);
        for step in 0..=2000 {
            let angle = 0.6 * f64::from(step) / 2000.0;
            let (by_series, by_sines) = (
                rotation_from_vector(axis * angle),
                rotation_from_axis_angle(axis, angle),
            );
            assert!((by_series - by_sines).length() < 4e-16, "{angle}");
        }
        assert_eq!(rotation_from_vector(DVec3::ZERO), DQuat::IDENTITY);
    }

    #[test]
    fn half_the_way_is_done_after_the_half_time() {
        for half_time in [1e-6, 0.1, 3.0] {
            let mut spring = Spring::at(2.0);
            spring.step(-2.0, half_time, half_time);
            assert!(spring.value.abs() < 1e-9, "{half_time}: {spring:?}");
            assert!((damp(2.0, -2.0, half_time, half_time)).abs() < 1e-9);
        }
    }

    #[test]
    fn no_time_changes_nothing_and_no_half_time_arrives() {
        let spring = Spring {
            value: 1.0,
            velocity: 5.0,
        };
        let mut still = spring;
        still.step(9.0, 0.1, 0.0);
        assert_eq!(still, spring);
        still.step(9.0, 0.0, 0.1);
        assert_eq!(still, Spring::at(9.0));
        assert_eq!(damp(1.0, 9.0, 0.1, 0.0), 1.0);
    }
}
