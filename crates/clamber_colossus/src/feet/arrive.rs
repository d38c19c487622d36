//! Moves a value to its goal, at rest, in a given time and with a bounded acceleration.

use clamber_animation::Spring;
use glam::DVec3;

/// Initial acceleration of [`arrive`].
pub(super) fn pull([value, velocity]: [f64; 2], goal: f64, left: f64) -> f64 {
    (goal - value) * (6.0 / (left * left)) - velocity * (4.0 / left)
}

/// Shortest of the times `left`, 1.2 `left`, 1.2² `left`, ... for which [`arrive`] needs at most the acceleration
/// `most` at its beginning and at its end, seconds.
pub(super) fn unhurried(spring: &Spring<DVec3>, goal: DVec3, left: f64, most: f64) -> f64 {
    let (away, velocity) = (goal - spring.value, spring.velocity);
    let mut left = left;
    for _ in 0..24 {
        let way = away * (6.0 / (left * left));
        let (begins, ends) = (way - velocity * (4.0 / left), velocity * (2.0 / left) - way);
        if begins.length().max(ends.length()) <= most {
            break;
        }
        left *= 1.2;
    }
    left
}

/// Moves a value by one tick along a cubic in time that brings the value to rest at its goal in `left` seconds. The
/// acceleration is at most `most`, even if the value then arrives later.
pub(super) fn arrive<T: Bounded>(spring: &mut Spring<T>, goal: T, left: f64, most: f64, dt: f64) {
    let away = goal - spring.value;
    let acceleration = away * (6.0 / (left * left)) - spring.velocity * (4.0 / left);
    let acceleration = acceleration.within(most);
    let dt = dt.min(left);
    spring.value = spring.value + spring.velocity * dt + acceleration * (0.5 * dt * dt);
    spring.velocity = spring.velocity + acceleration * dt;
}

/// A value whose length can be limited.
pub(super) trait Bounded: clamber_animation::Springy {
    fn within(self, most: f64) -> Self;
}

impl Bounded for f64 {
    fn within(self, most: f64) -> Self {
        self.clamp(-most, most)
    }
}

impl Bounded for DVec3 {
    fn within(self, most: f64) -> Self {
        self.clamp_length_max(most)
    }
}
