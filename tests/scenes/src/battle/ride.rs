//! A ride: a creature that plays its clips by a timetable, and the scripted climber on its back.

use std::sync::Arc;

use clamber_climber::{
    Climber, ClimberConfig, ClimberInput, ClimberMode, ClimberState, GripConfig, StepReport,
};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{MaterialPoint, Obstacle};
use glam::DVec3;

use super::choreography::Choreography;
use super::{SceneError, TICK};
use crate::Creature;

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

/// Height above the skin from which the climber is dropped again, metres. Small, since a moving creature soon carries
/// its back away from under the climber.
const DROP_AGAIN: f64 = 0.1;

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

/// Speed of skin relative to the creature as a whole up to which a rider jumps from it, metres a second: the jump takes
/// a second, in which the rider cannot steer.
const JUMP_SPEED: f64 = 0.4;
/// Shake of the skin up to which a rider jumps from it, metres a second squared.
const JUMP_SHAKE: f64 = 3.0;

/// A little more than the seconds that a jump takes on level ground. A rider that is in the air for longer has missed
/// its landing, and grips. With a smaller value it would grip skin that it could have landed on.
const JUMP_SECONDS: f64 = 1.2;

/// A creature that plays its clips by a timetable, and its rider. Where the skin gets too steep to stand on, the rider
/// holds on and climbs up to where it can stand again.
pub(super) struct Ride<'a> {
    pub(super) choreography: Choreography<'a>,
    pub(super) surface: SkinnedSurface,
    pub(super) climber: Climber,
    pub(super) report: StepReport,
    holds_on: bool,
    /// The rider jumps as soon as the skin is calm.
    wants_jump: bool,
    /// When the rider jumped or was first dropped, seconds; `None` after it has stood again.
    flies_since: Option<f64>,
    /// Velocity of the creature as a whole over the last tick, without its clips, metres a second.
    velocity: DVec3,
    /// Height of the creature, metres.
    height: f64,
}

impl<'a> Ride<'a> {
    /// A creature `height` metres tall at the beginning of its timetable, without a rider yet.
    pub(super) fn new(creature: &'a Creature, height: f64) -> Result<Self, SceneError> {
        let mut choreography = Choreography::new(creature, height)?;
        let mut surface = SkinnedSurface::new(Arc::clone(&creature.rig.collider));
        let (palette, world_from_model) = choreography.pose()?;
        surface.teleport(palette, world_from_model)?;
        Ok(Self {
            choreography,
            surface,
            climber: Climber::new(ClimberConfig::walker(), DVec3::ZERO)?,
            report: StepReport::default(),
            holds_on: false,
            wants_jump: false,
            // In the air above the creature.
            flies_since: Some(0.0),
            velocity: DVec3::ZERO,
            height,
        })
    }

    /// Poses the creature for the next tick.
    pub(super) fn advance(&mut self) -> Result<(), SceneError> {
        let before = self.surface.world_from_model().translation;
        self.choreography.advance(TICK);
        let (palette, world_from_model) = self.choreography.pose()?;
        self.surface.advance(palette, world_from_model)?;
        self.velocity = (self.surface.world_from_model().translation - before) / TICK;
        Ok(())
    }

    /// Drops the rider again, just above a place on the skin: it grips whatever it meets. It is at rest relative to the
    /// creature as a whole: the place itself may be moving fast, and its velocity would throw the climber away.
    pub(super) fn drop_again(&mut self, place: DVec3) -> Result<(), SceneError> {
        self.climber.restore(ClimberState {
            velocity: self.velocity,
            ..*rider_above(place, DROP_AGAIN)?.state()
        })?;
        (self.holds_on, self.wants_jump, self.flies_since) = (true, false, None);
        Ok(())
    }

    /// Restores the time of the clips, seconds, and the distance walked, metres; the skin stands there without motion.
    pub(super) fn go_to(&mut self, played: [f64; 2]) -> Result<(), SceneError> {
        [self.choreography.time, self.choreography.walked] = played;
        let (palette, world_from_model) = self.choreography.pose()?;
        self.surface.teleport(palette, world_from_model)?;
        self.velocity = DVec3::ZERO;
        Ok(())
    }

    /// The rider's input that carries out an intent. `perch` is the material point that a patrol stays near, and
    /// `seconds` the time since the beginning.
    pub(super) fn input(
        &mut self,
        intent: Intent,
        perch: &MaterialPoint,
        seconds: f64,
    ) -> ClimberInput {
        self.wants_jump |= intent == Intent::Jump;
        self.look_at_footing(seconds);
        let mut input = ClimberInput::default();
        if self.holds_on {
            // Up, to where it can stand again.
            (input.grip, input.climb) = (true, self.climber.config().up());
        } else if self.wants_jump && self.is_calm() {
            (self.wants_jump, self.flies_since) = (false, Some(seconds));
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
        match (state.mode, slope) {
            (ClimberMode::Standing, Some(slope)) => {
                self.flies_since = None;
                self.holds_on = slope > HOLD_ON || self.holds_on && slope >= STAND_UP;
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
        let is_forth = (seconds / LEG).rem_euclid(2.0) < 1.0;
        let ahead = if is_forth { 1.0 } else { -1.0 };
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

/// A climber for a ride, in the air `drop` metres above a place. No acceleration of the creature throws it off or makes
/// it hang.
pub(super) fn rider_above(place: DVec3, drop: f64) -> Result<Climber, SceneError> {
    let strong = ClimberConfig::colossus_climber().grip;
    let mut config = ClimberConfig::walker();
    config.ground.throw_acceleration = f64::INFINITY;
    config.grip = strong.map(|grip| GripConfig {
        hang_acceleration: f64::INFINITY,
        ..grip
    });
    let position = place + config.up() * (drop + config.body.radius);
    Ok(Climber::new(config, position)?)
}
