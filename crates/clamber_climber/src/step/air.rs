//! The frame of a body in the air: the velocity against which its own motion is measured.
//!
//! The frame has the velocity of the last obstacle that the body touched. A body that has touched nothing for a while
//! takes on the velocity of the air: a lift or a train that it left long ago is no longer its frame.

use glam::DVec3;

use super::Tick;

/// Time for which a body that touches nothing keeps the frame of the last obstacle that it touched, seconds.
const FRAME_KEPT_TIME: f64 = 1.0;

/// Time in which the frame then changes to the velocity of the air, seconds.
const FRAME_FADE_TIME: f64 = 1.0;

impl Tick<'_> {
    /// True for a body that no support carries.
    pub(super) fn is_free(&self) -> bool {
        self.carried.is_none()
    }

    /// Velocity of the obstacles that the last movement touched; `None` if it touched none.
    ///
    /// If the obstacles move apart, every velocity between two of theirs is a candidate, and the candidate nearest to
    /// the frame so far is taken. So a body between a piston and a wall stays in the frame of the room, and a body
    /// between two closing walls stays in the frame in which they close. (The mean was tried, and presses bodies
    /// through walls. So does the velocity of the obstacle that moves most like the frame, in closing wedges.)
    pub(super) fn touched_velocity(&self) -> Option<DVec3> {
        let frame = self.state.base_velocity;
        let touched = self.mover.touched();
        let velocity = |index: usize| self.mover.velocity_of(&touched[index]);
        // Other characters do not count: in the air they are no frame, and on the ground they have the ground's.
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
        let (before, air) = (self.state.untouched, self.judge.rules.air_velocity);
        let after = before + self.dt();
        self.state.untouched = after.min(FRAME_KEPT_TIME + FRAME_FADE_TIME);
        let left = FRAME_KEPT_TIME + FRAME_FADE_TIME - before.max(FRAME_KEPT_TIME);
        let passed = after - before.max(FRAME_KEPT_TIME);
        if passed >= left {
            self.state.base_velocity = air;
        } else if passed > 0.0 {
            // Linear in time, for ticks of any length.
            let frame = self.state.base_velocity;
            self.state.base_velocity = frame + (air - frame) * (passed / left);
        }
    }
}

/// The point between `a` and `b` that is nearest to `to`.
pub(super) fn nearest_between(a: DVec3, b: DVec3, to: DVec3) -> DVec3 {
    let way = b - a;
    let length_sq = way.length_squared();
    if length_sq == 0.0 {
        return a;
    }
    a + way * ((to - a).dot(way) / length_sq).clamp(0.0, 1.0)
}
