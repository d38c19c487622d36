//! Turns the head of the pose.

use clamber_animation::Spring;
use clamber_animation::ik::LookMemory;
use clamber_surface::geometry::Similarity;
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::state::{is_far, is_fast};
use super::{Creature, Surroundings};
use crate::brain::Gaze;
use crate::feet::Carried;
use crate::kind::HUMAN_HEIGHT;

/// Half time in which a gaze moves to a new target, begins and ends, seconds for a creature of human size.
const GAZE_HALF_TIME: f64 = 0.25;

/// Duration of one glance, seconds for a creature of `GIANT_HEIGHT`.
const GLANCE_TIME: f64 = 3.5;

/// Weight of the gaze below which the head is at rest.
const RESTING_GAZE_WEIGHT: f64 = 0.01;

/// How the head turns towards the target of the gaze.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct HeadTurn {
    look: LookMemory,
    /// The target as the head follows it, in world space.
    target: Spring<DVec3>,
    /// Share of the turn, from 0 to 1.
    weight: Spring<f64>,
}

impl HeadTurn {
    /// A head at rest, whose target is at a place.
    pub(super) fn towards(place: DVec3) -> Self {
        Self {
            look: LookMemory::default(),
            target: Spring::at(place),
            weight: Spring::at(0.0),
        }
    }

    /// True if the head does not turn to a target.
    pub(super) fn is_at_rest(&self) -> bool {
        self.weight.value.abs() < RESTING_GAZE_WEIGHT
    }

    /// Moves the target with the ground that carries the creature.
    pub(super) fn be_carried(&mut self, carried: &Carried) {
        self.target.value = carried.place(self.target.value);
        self.target.velocity = carried.vector(self.target.velocity);
    }

    /// True if target and weight are numbers that a creature reaches.
    pub(super) fn is_within_range(&self) -> bool {
        let Self { target, weight, .. } = self;
        !(is_far(target.value)
            || is_far(target.velocity)
            || is_fast(weight.value)
            || is_fast(weight.velocity))
    }
}

impl Creature {
    /// Turns the head towards the target of the gaze.
    pub(super) fn turn_head(&mut self, world: &Similarity, around: &Surroundings<'_>, dt: f64) {
        let kind = std::sync::Arc::clone(&self.kind);
        let Some(look) = kind.look() else { return };
        // Time scale: 1 for a creature of human size.
        let size = (self.size.height / HUMAN_HEIGHT).max(0.1).sqrt();
        let target = self.target(around);
        let weight = f64::from(u8::from(target.is_some()));
        let head = &mut self.state.head;
        head.weight.step(weight, GAZE_HALF_TIME * size, dt);
        if let Some(target) = target {
            if head.weight.value < 0.02 {
                head.target = Spring::at(target);
            }
            head.target.step(target, GAZE_HALF_TIME * size, dt);
        }
        let target = world.inverse_transform_point(head.target.value);
        let weight = head.weight.value.clamp(0.0, 1.0);
        if weight > 1e-3 {
            // A target inside the head leaves the pose as it is.
            let _ = look.solve(
                kind.skeleton(),
                &mut self.state.pose,
                target,
                weight,
                &mut head.look,
                dt / size,
            );
        } else {
            head.look = LookMemory::default();
        }
    }

    fn target(&self, around: &Surroundings<'_>) -> Option<DVec3> {
        match self.kind.brain().gaze(self.state.current()) {
            Gaze::Clip => None,
            Gaze::Prey => self.state.perceived.prey(),
            Gaze::Rider => {
                let rider = self.state.perceived.longest_rider()?;
                let mut people = around.people.iter();
                let rider = people.find(|person| person.id == rider)?;
                Some(rider.middle())
            }
            Gaze::Around => {
                let height = self.size.height;
                let glance = (self.state.ticks() as f64 * self.kind.brain().tick()
                    / (GLANCE_TIME * self.size.pace)) as u64;
                let mut lot = fastrand::Rng::with_seed(
                    self.config.seed ^ glance.wrapping_mul(0x9e37_79b9_7f4a_7c15),
                );
                let angle = self.state.yaw() + (lot.f64() - 0.5) * 2.0;
                let down = lot.f64() * 0.5;
                let way = DVec3::new(libm::sin(angle), -down, libm::cos(angle));
                let level = self.state.position() + DVec3::Y * (0.85 * height);
                Some(level + way * (2.0 * height))
            }
        }
    }
}
