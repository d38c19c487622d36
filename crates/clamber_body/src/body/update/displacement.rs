//! The displacement of the model from its stance's own place: it lets the motion go on between two stances, and decays.

use clamber_animation::Spring;
use glam::DVec3;

use super::Update;
use crate::body::limb::soft_half;
use crate::body::root::Root;
use crate::body::stance::Stance;

/// Least half time in which a displacement between two stances decays, seconds.
const LEAST_HALF_TIME: f64 = 0.09;

/// Growth of that half time with the displacement's initial speed, seconds per metre a second.
const HALF_TIME_PER_SPEED: f64 = 0.0233;

/// Limit of a new displacement's speed, metres a second: a body that lands faster does not go deeper.
const MAX_DISPLACEMENT_SPEED: f64 = 9.0;

/// Displacement of the model from its stance's own place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Displacement {
    offset: Spring<DVec3>,
    /// Half time of the decay, seconds.
    half: f64,
}

impl Displacement {
    /// A displacement at the start of a stance. It decays more slowly after a hard change of velocity, so that the body
    /// gives way softly.
    fn after(offset: Spring<DVec3>) -> Self {
        Self {
            offset,
            half: LEAST_HALF_TIME
                .max(HALF_TIME_PER_SPEED * offset.velocity.length())
                .max(soft_half(offset.value.length())),
        }
    }

    pub(super) fn value(&self) -> DVec3 {
        self.offset.value
    }
}

impl Update<'_> {
    /// The rest of the displacement between the model's shown place and its stance's place; `None` in a new stance and
    /// in the first frame.
    pub(super) fn kept_displacement(&self) -> Option<Displacement> {
        let memory = self.memory.filter(|memory| memory.stance == self.stance)?;
        let Displacement { mut offset, half } = memory.displacement;
        offset.value = self.carry.vector(offset.value);
        offset.velocity = self.carry.vector(offset.velocity);
        let state = self.frame.state;
        let motion = state.velocity - state.base_velocity;
        // The model lags behind changes of the climber's velocity, except those by gravity.
        let falls = matches!(self.stance, Stance::Air | Stance::Tumble);
        let gravity = if falls {
            self.frame.config.gravity
        } else {
            DVec3::ZERO
        };
        let expected = self.carry.vector(memory.climber.full_motion) + gravity * self.dt;
        let change = expected - motion;
        if self.stance == Stance::Upright {
            offset.velocity += self.level(change);
            // A step up or a push displaces the climber at once. The model follows softly.
            let expected = self.carry.point(memory.climber.position) + self.level(motion) * self.dt;
            offset.value += self.level(expected - state.position);
        } else {
            offset.velocity += change;
        }
        offset.step(DVec3::ZERO, half, self.dt);
        Some(Displacement { offset, half })
    }

    /// The displacement at the start of a stance. It lets the model's motion continue.
    pub(super) fn new_displacement(&self, target: &Root, motion: DVec3) -> Displacement {
        let Some(memory) = &self.memory else {
            return Displacement::after(Spring::default());
        };
        // The model keeps its velocity at first, and the spring brings it to rest at its new place.
        let velocity = self.carry.vector(memory.velocity) + memory.climber.base
            - self.frame.state.base_velocity;
        let expected = self.carry.point(memory.root.position) + velocity * self.dt;
        Displacement::after(Spring {
            value: expected - target.position,
            velocity: (velocity - motion).clamp_length_max(MAX_DISPLACEMENT_SPEED),
        })
    }
}
