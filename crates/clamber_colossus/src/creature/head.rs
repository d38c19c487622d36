//! Turns the head of the pose.

use clamber_animation::ik::LookMemory;
use clamber_surface::geometry::Similarity;
use glam::DVec3;

use super::{Creature, Surroundings};
use crate::brain::Gaze;
use crate::kind::HUMAN;

/// Half time in which a gaze moves to a new target, begins and ends, seconds for a creature of human size.
const LOOKS: f64 = 0.25;

/// Duration of one glance, seconds for a creature of `GIANT` height.
const GLANCE: f64 = 3.5;

impl Creature {
    /// Turns the head towards the target of the gaze.
    pub(super) fn turn_head(&mut self, world: &Similarity, around: &Surroundings<'_>, dt: f64) {
        let kind = std::sync::Arc::clone(&self.kind);
        let Some(look) = kind.look() else { return };
        // Time scale: 1 for a creature of human size.
        let size = (self.size.height / HUMAN).max(0.1).sqrt();
        let target = self.target(around);
        let weight = f64::from(u8::from(target.is_some()));
        self.state.gaze_weight.step(weight, LOOKS * size, dt);
        if let Some(target) = target {
            if self.state.gaze_weight.value < 0.02 {
                self.state.gaze = clamber_animation::Spring::at(target);
            }
            self.state.gaze.step(target, LOOKS * size, dt);
        }
        let target = world.inverse_transform_point(self.state.gaze.value);
        let weight = self.state.gaze_weight.value.clamp(0.0, 1.0);
        if weight > 1e-3 {
            // A target inside the head leaves the pose as it is.
            let _ = look.solve(
                kind.skeleton(),
                &mut self.state.pose,
                target,
                weight,
                &mut self.state.look,
                dt / size,
            );
        } else {
            self.state.look = LookMemory::default();
        }
    }

    fn target(&self, around: &Surroundings<'_>) -> Option<DVec3> {
        match self.kind.brain().gaze(self.state.current()) {
            Gaze::Clip => None,
            Gaze::Prey => self.state.prey.map(|(_, place)| place),
            Gaze::Rider => {
                let ride = self.state.rides.iter().max_by_key(|ride| ride.ticks)?;
                let rider = around
                    .people
                    .iter()
                    .find(|person| person.id == ride.person)?;
                Some(rider.middle())
            }
            Gaze::Around => {
                let height = self.size.height;
                let glance = (self.state.ticks as f64 * self.kind.brain().tick()
                    / (GLANCE * self.size.pace)) as u64;
                let mut lot = fastrand::Rng::with_seed(
                    self.config.seed ^ glance.wrapping_mul(0x9e37_79b9_7f4a_7c15),
                );
                let angle = self.state.yaw + (lot.f64() - 0.5) * 2.0;
                let down = lot.f64() * 0.5;
                let way = DVec3::new(libm::sin(angle), -down, libm::cos(angle));
                let level = self.state.position + DVec3::Y * (0.85 * height);
                Some(level + way * (2.0 * height))
            }
        }
    }
}
