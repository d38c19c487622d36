//! Feet whose skin also follows the shin: they stand on their skin as it is posed, not as it is at rest.

use clamber_surface::geometry::Similarity;
use glam::DVec3;

use super::Creature;
use super::legs::PutLeg;
use crate::kind::Leg;

/// Most iterations in which a foot is moved until its skin is on the ground.
const MOST_PRESS_ROUNDS: u32 = 4;

/// Distance from the ground at which the iterations end, as a share of the leg's length.
const PRESSED_DISTANCE: f64 = 2e-4;

impl Creature {
    /// Moves a planted foot of the pose along the ground's normal, until its lowest skin is at the height of the sole
    /// at rest.
    pub(super) fn press_foot(&mut self, world: &Similarity, leg: &Leg, put: &PutLeg) {
        let blended = &leg.sole.blended;
        if blended.is_empty() || !put.is_planted {
            return;
        }
        let normal = world.rotation.conjugate() * put.normal;
        let ground = put.ball.dot(normal) - leg.sole.ball_height;
        let mut places = std::mem::take(&mut self.sole);
        let mut put = *put;
        for _ in 0..MOST_PRESS_ROUNDS {
            blended.skin(self.kind.skeleton(), &self.state.pose, &mut places);
            let heights = places.iter().map(|place: &DVec3| place.dot(normal));
            let off = heights.fold(f64::INFINITY, f64::min) - ground;
            if off.abs() < PRESSED_DISTANCE * leg.length || !off.is_finite() {
                break;
            }
            put.ankle -= normal * (off * put.flat);
            self.bend_leg(leg, &put);
            if put.flat < 1.0 - 1e-3 {
                // The foot is still coming down: one iteration is enough.
                break;
            }
        }
        self.sole = places;
    }
}
