//! The scripted climber on the creature's back.

use clamber_climber::{ClimberInput, ClimberMode};
use clamber_world::{MaterialPoint, Obstacle};
use glam::DVec3;

use super::ride::Ride;

/// What the script asks of the climber in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Intent {
    /// Stand without input, as long as the skin is level enough.
    Stand,
    /// Walk to and fro along the back, around the perch.
    Patrol,
    /// Patrol, and jump as soon as the skin is calm.
    Jump,
}

/// Seconds for which a patrol walks in one direction.
const LEG: f64 = 2.5;

/// Distance from the perch at which a patrol turns round, as a share of the creature's height.
const REACH: f64 = 0.06;

/// Distance from its target at which a patrol has arrived, metres.
const ARRIVED: f64 = 0.2;

/// Slope above which a rider holds on, radians: 40 degrees, well below the 50 degrees that it can stand on.
const HOLD_ON: f64 = 0.7;
/// Slope below which a rider that holds on stands up again, radians: 30 degrees.
const STAND_UP: f64 = 0.52;

/// Distance ahead of the rider at which a patrol looks for skin, metres.
const AHEAD: f64 = 0.6;
/// Height above and below the feet in which it looks for skin, metres.
const STEP: f64 = 0.5;
/// Slope of the skin ahead up to which a patrol walks on, radians.
const WALKABLE: f64 = 0.6;

/// Speed of skin relative to the creature as a whole up to which a rider jumps from it, metres a second: the jump takes a
/// second, in which the rider cannot steer.
const JUMP_SPEED: f64 = 0.4;
/// Shake of the skin up to which a rider jumps from it, metres a second squared.
const JUMP_SHAKE: f64 = 3.0;

/// A little more than the seconds that a jump takes on level ground. A rider that is in the air for longer has missed
/// its landing, and grips. With a smaller value it would grip skin that it could have landed on.
const JUMP_SECONDS: f64 = 1.2;

/// What a rider remembers. Where the skin gets too steep to stand on, it holds on and climbs up to where it can stand
/// again.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rider {
    holds_on: bool,
    /// The rider jumps as soon as the skin is calm.
    wants_jump: bool,
    /// When the rider jumped or was first dropped, seconds; `None` after it has stood again.
    flies_since: Option<f64>,
}

impl Rider {
    /// A rider at the beginning: in the air above the creature.
    pub(super) const FIRST: Self = Self {
        holds_on: false,
        wants_jump: false,
        flies_since: Some(0.0),
    };

    /// A rider that was dropped again, just above the skin: it grips whatever it meets.
    pub(super) const DROPPED: Self = Self {
        holds_on: true,
        wants_jump: false,
        flies_since: None,
    };
}

impl Ride<'_> {
    /// The rider's input that carries out an intent. `perch` is the material point that a patrol stays near, and
    /// `seconds` the time since the beginning.
    pub(super) fn input(
        &mut self,
        intent: Intent,
        perch: &MaterialPoint,
        seconds: f64,
    ) -> ClimberInput {
        self.rider.wants_jump |= intent == Intent::Jump;
        self.look_at_footing(seconds);
        let mut input = ClimberInput::default();
        if self.rider.holds_on {
            // Up, to where it can stand again.
            (input.grip, input.climb) = (true, self.climber.config().up());
        } else if self.rider.wants_jump && self.is_calm() {
            (self.rider.wants_jump, self.rider.flies_since) = (false, Some(seconds));
            input.jump = true;
        } else if matches!(intent, Intent::Patrol | Intent::Jump) {
            input.walk = self.patrol(perch, seconds);
        }
        input
    }

    /// Decides whether the rider holds on.
    fn look_at_footing(&mut self, seconds: f64) {
        let (state, up) = (self.climber.state(), self.climber.config().up());
        let slope = state.support.map(|support| {
            let cosine = support.normal_in_world().dot(up);
            libm::acos(cosine.clamp(-1.0, 1.0))
        });
        let rider = &mut self.rider;
        match (state.mode, slope) {
            (ClimberMode::Standing, Some(slope)) => {
                rider.flies_since = None;
                rider.holds_on |= slope > HOLD_ON;
                if slope < STAND_UP {
                    rider.holds_on = false;
                }
            }
            (ClimberMode::Sliding, _) => rider.holds_on = true,
            (mode, Some(slope)) if mode.is_holding() => rider.holds_on = slope > STAND_UP,
            // In the air: by a jump, until the landing is missed, or because the skin moved away.
            _ => {
                let flies = rider.flies_since.map(|since| seconds - since);
                rider.holds_on |= flies.is_none_or(|flies| flies > JUMP_SECONDS);
            }
        }
    }

    /// True if the climber stands on skin that moves evenly, along with the creature.
    fn is_calm(&self) -> bool {
        let state = self.climber.state();
        let velocity = state.support_velocity.unwrap_or(state.velocity);
        state.mode == ClimberMode::Standing
            && velocity.distance(self.velocity) < JUMP_SPEED
            && state.shake.length() < JUMP_SHAKE
    }

    /// The direction to walk in: towards the end of the patrol, or none if there is no walkable skin ahead.
    fn patrol(&self, perch: &MaterialPoint, seconds: f64) -> DVec3 {
        let Some(middle) = self.surface.motion(perch, 1.0) else {
            return DVec3::ZERO;
        };
        let forward = self.surface.world_from_model().rotation * DVec3::Z;
        let ahead = if (seconds / LEG).rem_euclid(2.0) < 1.0 {
            1.0
        } else {
            -1.0
        };
        let target = middle.position + forward * (ahead * REACH * self.height);
        let position = self.climber.state().position;
        let level = (target - position) * DVec3::new(1.0, 0.0, 1.0);
        let direction = level.normalize_or_zero();
        let config = self.climber.config();
        let up = config.up();
        let feet = position - up * config.body.radius;
        let above = feet + direction * AHEAD + up * STEP;
        let ground = self.surface.cast_ray(above, -up, 2.0 * STEP);
        let is_walkable = ground.is_some_and(|g| g.normal.dot(up) > libm::cos(WALKABLE));
        if level.length() > ARRIVED && is_walkable {
            direction * 0.6
        } else {
            DVec3::ZERO
        }
    }
}
