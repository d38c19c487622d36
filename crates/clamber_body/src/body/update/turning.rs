//! Turns the body to its stance's rotation: it leans into changes of its velocity, and rolls while it tumbles.

use clamber_animation::{RotationSpring, Spring, damp};
use clamber_surface::geometry::rotation_from_axis_angle;
use glam::{DQuat, DVec3};

use super::Update;
use crate::body::root::facing_to;
use crate::body::stance::Stance;

/// Half time of the body's turn to its stance's rotation, seconds.
const TURN_HALF_TIME: f64 = 0.11;

/// [`TURN_HALF_TIME`] on a wall and while hanging, seconds: longer, since hands and feet have to follow around corners.
const TURN_HALF_TIME_ON_WALL: f64 = 0.22;

/// Half time of the low-pass filter on the velocity that a body leans by, seconds.
const LEAN_FILTER_HALF_TIME: f64 = 0.18;

/// Lean per change of velocity, radians per metre a second.
const LEAN_PER_SPEED: f64 = 0.05;

/// Largest lean, radians.
const MOST_LEAN: f64 = 0.16;

/// Largest speed at which a tumbling body rolls, radians a second.
const MAX_ROLL_RATE: f64 = 8.0;

/// Half time of a change of that speed, seconds.
const ROLL_HALF_TIME: f64 = 0.1;

/// Least cosine between up and the normal of level skin.
const LEVEL_SKIN_COSINE: f64 = 0.94;

/// The body's rotation, and the motion that it leans by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turning {
    turn: RotationSpring,
    /// Low-pass filtered level velocity. The body leans into the difference from the current one.
    slow: Spring<DVec3>,
}

impl Turning {
    pub(super) fn rotation(&self) -> DQuat {
        self.turn.rotation
    }
}

impl Update<'_> {
    /// The body's rotation in this frame.
    pub(super) fn turned(&self, motion: DVec3) -> Turning {
        let state = self.frame.state;
        let facing = self.figure.humanoid().facing;
        let [ahead, mut above] = self.stance.directions(state, self.up);
        above = self.crawls().unwrap_or(above);
        let mut wanted = facing_to(facing, ahead, above);
        let level = self.level(motion);
        let Some(memory) = &self.memory else {
            return Turning {
                turn: RotationSpring::at(wanted),
                slow: Spring::at(level),
            };
        };
        let Turning { mut turn, mut slow } = memory.turning;
        slow.value = self.carry.vector(slow.value);
        slow.velocity = self.carry.vector(slow.velocity);
        slow.step(level, LEAN_FILTER_HALF_TIME, self.dt);
        turn.rotation = self.carry.rotation(turn.rotation);
        turn.velocity = self.carry.vector(turn.velocity);
        if self.stance == Stance::Upright {
            let change = level - slow.value;
            let angle = (LEAN_PER_SPEED * change.length()).min(MOST_LEAN);
            let axis = self.up.cross(change).try_normalize();
            wanted = axis.map_or(wanted, |axis| {
                rotation_from_axis_angle(axis, angle) * wanted
            });
        }
        if self.stance == Stance::Tumble {
            // The body rolls over in the direction of motion.
            let rate = (level.length() / self.frame.config.body.radius).min(MAX_ROLL_RATE);
            let wanted = self.up.cross(level).normalize_or_zero() * rate;
            let roll = damp(turn.velocity, wanted, ROLL_HALF_TIME, self.dt);
            let angle = roll.length() * self.dt;
            if angle > 0.0 {
                let turned = rotation_from_axis_angle(roll.normalize(), angle);
                turn.rotation = (turned * turn.rotation).normalize();
            }
            turn.velocity = roll;
        } else {
            let half = match self.stance {
                Stance::Wall | Stance::Hang => TURN_HALF_TIME_ON_WALL,
                _ => TURN_HALF_TIME,
            };
            turn.step(wanted, half, self.dt);
        }
        Turning { turn, slow }
    }

    /// Direction of the head on level skin, where no direction along the skin points up: as in the last frame.
    fn crawls(&self) -> Option<DVec3> {
        let support = self.frame.state.support.as_ref()?;
        let normal = support.normal_in_world();
        if self.stance != Stance::Wall || normal.dot(self.up) < LEVEL_SKIN_COSINE {
            return None;
        }
        let before = self.memory.filter(|memory| memory.stance == Stance::Wall)?;
        let head = self.carry.rotation(before.turning.turn.rotation) * DVec3::Y;
        (head - normal * head.dot(normal)).try_normalize()
    }
}
