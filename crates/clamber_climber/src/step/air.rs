//! The frame of a body in the air: the velocity against which its own motion is measured.
//!
//! It is the velocity of what the body touched last. A body that has touched nothing for a while takes on the velocity
//! of the air, so that a lift or a train that it left long ago no longer says what "up" or "still" means to it.

use glam::DVec3;

use super::Tick;

/// How long a body that touches nothing keeps the frame of what it touched last, seconds.
const KEPT: f64 = 1.0;

/// How long the frame then takes to become that of the air, seconds.
const FADES: f64 = 1.0;

impl Tick<'_> {
    /// True for a body that nothing carries.
    pub(super) fn is_free(&self) -> bool {
        self.carried.is_none()
    }

    /// Velocity of what the last movement touched; `None` if it touched nothing.
    ///
    /// Among things that move apart, the nearest to the frame so far of all velocities between two of theirs. So a body
    /// between a piston and a wall stays in the frame of the room, and one between two closing walls in the frame in
    /// which they close. (The mean was tried, and presses bodies through walls. So does the one that moves most alike,
    /// in closing wedges.)
    pub(super) fn touched_velocity(&self) -> Option<DVec3> {
        let frame = self.state.base_velocity;
        let touched = self.mover.touched();
        let velocity = |index: usize| self.mover.velocity_of(&touched[index]);
        // Others in the air are no frame, and those on the ground have it from there.
        let counts = |index: &usize| !self.mover.is_character(&touched[*index]);
        let nearest = (0..touched.len()).filter(counts).flat_map(|a| {
            let from = velocity(a);
            let others = (0..=a).filter(counts);
            others.map(move |b| nearest_between(from, velocity(b), frame))
        });
        nearest.reduce(|best, other| {
            if other.distance_squared(frame) < best.distance_squared(frame) {
                other
            } else {
                best
            }
        })
    }

    /// Updates the frame of a free body after a movement.
    pub(super) fn update_frame(&mut self) {
        if let Some(velocity) = self.touched_velocity() {
            self.state.base_velocity = velocity;
            self.state.untouched = 0.0;
            return;
        }
        let (before, air) = (self.state.untouched, self.rules.air_velocity);
        let after = before + self.dt();
        self.state.untouched = after.min(KEPT + FADES);
        let left = KEPT + FADES - before.max(KEPT);
        let passed = after - before.max(KEPT);
        if passed >= left {
            self.state.base_velocity = air;
        } else if passed > 0.0 {
            // A straight line in time, whatever the length of the ticks.
            let frame = self.state.base_velocity;
            self.state.base_velocity = frame + (air - frame) * (passed / left);
        }
    }
}

/// The point between `a` and `b` that is nearest to another one.
pub(super) fn nearest_between(a: DVec3, b: DVec3, to: DVec3) -> DVec3 {
    let way = b - a;
    let length_sq = way.length_squared();
    if length_sq == 0.0 {
        return a;
    }
    a + way * ((to - a).dot(way) / length_sq).clamp(0.0, 1.0)
}
