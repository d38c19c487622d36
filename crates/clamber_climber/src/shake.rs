//! How hard a hold is shaken: its acceleration through a low-pass filter, and what of it is too much.
//!
//! The filter answers a velocity change of V within a tick by V / time constant, however short the
//! tick: it is exact for an acceleration that is constant over each tick. Accelerations themselves
//! have no limit on animation that is keyed by straight lines, and cannot be compared with anything.

use glam::DVec3;

/// The filtered acceleration of what is held on to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Shake {
    /// Metres a second squared, in the space of the velocities.
    pub acceleration: DVec3,
}

impl Shake {
    /// One tick of `dt` seconds in which the velocity changed by `velocity_change`, metres a second.
    ///
    /// A time constant of zero or less does not filter. Nothing changes if `dt` is not positive, or
    /// the result would not be finite.
    pub(crate) fn step(&mut self, velocity_change: DVec3, time_constant: f64, dt: f64) {
        if !(dt > 0.0 && dt.is_finite()) {
            return;
        }
        let ticks = dt / time_constant;
        let (kept, gained) = if time_constant > 0.0 {
            (libm::exp(-ticks), -libm::expm1(-ticks))
        } else {
            (0.0, 1.0)
        };
        let next = self.acceleration * kept + velocity_change / dt * gained;
        if next.is_finite() {
            self.acceleration = next;
        }
    }
}

/// The integral of `max(0, |acceleration| - threshold)` over a tick, metres a second, by the
/// trapezoid of its ends.
///
/// Of a shake with ten ticks a swing, summed over swings, it is within 5 % of the integral; with
/// twenty, within 3. The straight line between the accelerations was tried: it cuts every crest
/// and loses twice that, where the trapezoid gains on the flanks what it loses on the crests.
///
/// Zero if an argument is not finite or `dt` is not positive; a threshold below zero counts as zero.
pub(crate) fn excess(before: &Shake, after: &Shake, threshold: f64, dt: f64) -> f64 {
    if !(threshold.is_finite() && dt > 0.0) {
        return 0.0;
    }
    let above = |shake: &Shake| (shake.acceleration.length() - threshold.max(0.0)).max(0.0);
    let excess = 0.5 * dt * (above(before) + above(after));
    if excess.is_finite() { excess } else { 0.0 }
}

#[cfg(test)]
mod tests;
