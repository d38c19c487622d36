use std::sync::Arc;

use clamber_climber::{Climber, ClimberConfig, ClimberInput, GripConfig, StepReport, StepRules};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;

use super::choreography::Choreography;
use super::rider::Rider;
use super::{CREATURE, SceneError, TERRAIN, TICK};
use crate::Creature;

/// A creature that plays its clips by a timetable, and its rider.
pub(super) struct Ride<'a> {
    pub(super) choreography: Choreography<'a>,
    pub(super) surface: SkinnedSurface,
    pub(super) climber: Climber,
    pub(super) report: StepReport,
    pub(super) rider: Rider,
    /// Velocity of the creature as a whole over the last tick, without its clips, metres a second.
    pub(super) velocity: DVec3,
    /// Height of the creature, metres.
    pub(super) height: f64,
}

impl<'a> Ride<'a> {
    /// A creature `height` metres tall at the beginning of its timetable, without a rider yet.
    pub(super) fn new(creature: &'a Creature, height: f64) -> Result<Self, SceneError> {
        let mut choreography = Choreography::new(creature, height)?;
        let mut surface = SkinnedSurface::new(Arc::clone(&creature.rig.collider));
        let (palette, world_from_model) = choreography.pose()?;
        surface.place(palette, world_from_model)?;
        Ok(Self {
            choreography,
            surface,
            climber: Climber::new(ClimberConfig::walker(), DVec3::ZERO)?,
            report: StepReport::default(),
            rider: Rider::FIRST,
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

    /// Steps the rider on the creature that was posed for this tick.
    pub(super) fn step(
        &mut self,
        input: &ClimberInput,
        terrain: &dyn Obstacle,
        rules: &StepRules<'_>,
    ) -> Result<(), SceneError> {
        let obstacles: [(ObstacleId, &dyn Obstacle); 2] =
            [(TERRAIN, terrain), (CREATURE, &self.surface)];
        self.report = self.climber.step_with(input, &obstacles, rules, TICK)?;
        Ok(())
    }

    /// Restores the time of the clips, seconds, and the distance walked, metres; the skin stands there without motion.
    pub(super) fn go_to(&mut self, time: f64, walked: f64) -> Result<(), SceneError> {
        (self.choreography.time, self.choreography.walked) = (time, walked);
        let (palette, world_from_model) = self.choreography.pose()?;
        self.surface.place(palette, world_from_model)?;
        self.velocity = DVec3::ZERO;
        Ok(())
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
