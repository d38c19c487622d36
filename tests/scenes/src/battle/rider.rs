//! The scripted climber on the creature's back.

use clamber_climber::{Climber, ClimberInput, ClimberMode};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{MaterialPoint, Obstacle};
use glam::DVec3;

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

/// The part of the scene that a rider sees.
pub(super) struct RiderScene<'a> {
    pub(super) surface: &'a SkinnedSurface,
    /// The material point that a patrol keeps near.
    pub(super) perch: &'a MaterialPoint,
    /// Velocity of the creature as a whole, metres a second.
    pub(super) velocity: DVec3,
    /// Time since the beginning, seconds.
    pub(super) seconds: f64,
    /// Height of the creature, metres.
    pub(super) height: f64,
}

/// Drives a climber that rides: where the skin gets too steep to stand on, it holds on and climbs up to where it can
/// stand again.
#[derive(Clone, Debug)]
pub(super) struct Rider {
    holds_on: bool,
    /// It jumps as soon as the skin is calm.
    wants_jump: bool,
    /// When it jumped or was first dropped, seconds; `None` after it has stood again.
    flies_since: Option<f64>,
}

impl Rider {
    /// A rider at the beginning: in the air above the creature.
    pub(super) fn new() -> Self {
        Self {
            holds_on: false,
            wants_jump: false,
            flies_since: Some(0.0),
        }
    }

    /// Tells the rider that it was dropped again, just above the skin: it grips whatever it meets.
    pub(super) fn dropped(&mut self) {
        *self = Self {
            holds_on: true,
            wants_jump: false,
            flies_since: None,
        };
    }

    /// The input that carries out an intent.
    pub(super) fn input(
        &mut self,
        intent: Intent,
        climber: &Climber,
        scene: &RiderScene<'_>,
    ) -> ClimberInput {
        self.wants_jump |= intent == Intent::Jump;
        self.look_at_its_footing(climber, scene.seconds);
        if self.holds_on {
            // Up, to where it can stand again.
            return ClimberInput {
                grip: true,
                climb: climber.config().up(),
                ..ClimberInput::default()
            };
        }
        if self.wants_jump && is_calm(climber, scene) {
            self.wants_jump = false;
            self.flies_since = Some(scene.seconds);
            return ClimberInput {
                jump: true,
                ..ClimberInput::default()
            };
        }
        let walks = matches!(intent, Intent::Patrol | Intent::Jump);
        ClimberInput {
            walk: if walks {
                patrol(climber, scene)
            } else {
                DVec3::ZERO
            },
            ..ClimberInput::default()
        }
    }

    /// Decides whether the rider holds on.
    fn look_at_its_footing(&mut self, climber: &Climber, seconds: f64) {
        let (state, up) = (climber.state(), climber.config().up());
        let slope = state.support.map(|support| {
            let cosine = support.normal_in_world().dot(up);
            libm::acos(cosine.clamp(-1.0, 1.0))
        });
        match (state.mode, slope) {
            (ClimberMode::Standing, Some(slope)) => {
                self.flies_since = None;
                self.holds_on |= slope > HOLD_ON;
                if slope < STAND_UP {
                    self.holds_on = false;
                }
            }
            (ClimberMode::Sliding, _) => self.holds_on = true,
            (mode, Some(slope)) if mode.is_holding() => self.holds_on = slope > STAND_UP,
            // In the air: by a jump, until the landing is missed, or because the skin moved away.
            _ => {
                let flies = self.flies_since.map(|since| seconds - since);
                self.holds_on |= flies.is_none_or(|flies| flies > JUMP_SECONDS);
            }
        }
    }
}

/// True if the climber stands on skin that moves evenly, along with the creature.
fn is_calm(climber: &Climber, scene: &RiderScene<'_>) -> bool {
    let state = climber.state();
    let velocity = state.support_velocity.unwrap_or(state.velocity);
    state.mode == ClimberMode::Standing
        && velocity.distance(scene.velocity) < JUMP_SPEED
        && state.shake.length() < JUMP_SHAKE
}

/// The direction to walk in: towards the end of the patrol, or none if there is no walkable skin ahead.
fn patrol(climber: &Climber, scene: &RiderScene<'_>) -> DVec3 {
    let Some(middle) = scene.surface.motion(scene.perch, 1.0) else {
        return DVec3::ZERO;
    };
    let forward = scene.surface.world_from_model().rotation * DVec3::Z;
    let ahead = if (scene.seconds / LEG).rem_euclid(2.0) < 1.0 {
        1.0
    } else {
        -1.0
    };
    let target = middle.position + forward * (ahead * REACH * scene.height);
    let position = climber.state().position;
    let level = (target - position) * DVec3::new(1.0, 0.0, 1.0);
    let direction = level.normalize_or_zero();
    let up = climber.config().up();
    let feet = position - up * climber.config().body.radius;
    let above = feet + direction * AHEAD + up * STEP;
    let ground = scene.surface.cast_ray(above, -up, 2.0 * STEP);
    let is_walkable = ground.is_some_and(|g| g.normal.dot(up) > libm::cos(WALKABLE));
    if level.length() > ARRIVED && is_walkable {
        direction * 0.6
    } else {
        DVec3::ZERO
    }
}
