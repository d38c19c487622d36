//! The scripted climber on the creature's back.

use clamber_climber::{Climber, ClimberInput, ClimberMode};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{MaterialPoint, Obstacle};
use glam::DVec3;

/// What the script asks for at a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Intent {
    /// No input at all, as long as the skin is level enough to stand on.
    Stand,
    /// Walk along the back, up and down around the perch.
    Patrol,
    /// Patrol, and jump as soon as the skin is calm.
    Jump,
    /// Come over the ground and climb to the top.
    Climb,
}

/// Seconds in one direction.
const LEG: f64 = 2.5;

/// How far from the perch a patrol turns round, as a share of the creature's height.
const REACH: f64 = 0.06;

/// Where a patrol has arrived, metres from its target.
const ARRIVED: f64 = 0.2;

/// Slope from which a rider holds on, and below which it stands up again, radians: 40 and 30 degrees, well within the 50
/// that it can stand on.
const HOLD_ON: f64 = 0.7;
const STAND_UP: f64 = 0.52;

/// How far ahead a patrol looks for skin to walk on, how far below or above it, metres, and how steep it may be, radians.
const AHEAD: f64 = 0.6;
const STEP: f64 = 0.5;
const WALKABLE: f64 = 0.6;

/// A rider jumps from skin that moves no faster than this relative to the creature as a whole, metres a second, and that
/// shakes no more than that, metres a second squared: it stays in the air for a second, and cannot steer there.
const JUMP_SPEED: f64 = 0.4;
const JUMP_SHAKE: f64 = 3.0;

/// Seconds that a jump lasts on level ground, and some more: a rider still in the air then has missed its landing. Sooner it
/// would grip skin that it could have landed on.
const JUMP_SECONDS: f64 = 1.2;

/// What a rider sees of the scene.
pub(super) struct RiderScene<'a> {
    pub(super) surface: &'a SkinnedSurface,
    /// The material point that a patrol keeps near.
    pub(super) perch: &'a MaterialPoint,
    /// Of the creature as a whole, metres a second.
    pub(super) velocity: DVec3,
    /// Since the beginning.
    pub(super) seconds: f64,
    /// Of the creature, metres.
    pub(super) height: f64,
}

/// Rides; where the skin gets too steep to stand on it holds on, and climbs up to where it can stand again.
#[derive(Clone, Debug)]
pub(super) struct Rider {
    holds_on: bool,
    /// It means to jump.
    wants_jump: bool,
    /// When it jumped, or was first dropped, seconds; `None` once it has stood since.
    flies_since: Option<f64>,
}

impl Rider {
    /// In the air above the creature, at the beginning.
    pub(super) fn new() -> Self {
        Self {
            holds_on: false,
            wants_jump: false,
            flies_since: Some(0.0),
        }
    }

    /// It was dropped on the creature again, just above the skin: it grips what comes.
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

    /// Decides whether it holds on.
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
            // In the air: of its own accord until it has missed its landing, or because the skin left it.
            _ => {
                let flies = self.flies_since.map(|since| seconds - since);
                self.holds_on |= flies.is_none_or(|flies| flies > JUMP_SECONDS);
            }
        }
    }
}

/// Whether what it stands on moves along with the creature, and evenly.
fn is_calm(climber: &Climber, scene: &RiderScene<'_>) -> bool {
    let state = climber.state();
    let velocity = state.support_velocity.unwrap_or(state.velocity);
    state.mode == ClimberMode::Standing
        && velocity.distance(scene.velocity) < JUMP_SPEED
        && state.shake.length() < JUMP_SHAKE
}

/// Where to walk: towards the end of the patrol, as long as there is skin ahead to walk on.
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
