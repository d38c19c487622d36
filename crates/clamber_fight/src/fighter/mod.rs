//! A fighter: a climber with weapons.

mod act;
mod around;
mod blade;
mod config;
mod cut;
mod frame;
mod ordered;
mod room;
mod shoot;
mod stab;
mod state;

use clamber_climber::{Climber, ClimberInput, StepReport, StepRules};
use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;
use serde::{Deserialize, Serialize};

pub(crate) use act::{Wielding, looks_every};
pub(crate) use around::Around;
pub use blade::Blade;
pub use config::{BowConfig, CrushConfig, FighterConfig, StoneConfig, SwordConfig};
pub use frame::FighterFrame;
pub(crate) use room::Room;
pub use state::{FighterState, StabTarget, WeaponAction};

use crate::arena::hash_of;
use crate::error::ArenaError;

/// Number of a fighter in an arena. Fighters are numbered in the order in which they join, and no number is used twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct FighterId(pub u32);

/// A climber with weapons.
#[derive(Clone, Debug)]
pub struct Fighter {
    id: FighterId,
    config: FighterConfig,
    /// Hash of the number and the configuration, which never change.
    mark: u64,
    climber: Climber,
    /// State without the climber's. The field `climber` in it is stale; [`Fighter::state`] fills it in.
    state: FighterState,
    report: StepReport,
}

impl Fighter {
    pub(crate) fn new(
        id: FighterId,
        config: FighterConfig,
        spawn: DVec3,
        seed: u64,
    ) -> Result<Self, ArenaError> {
        config.check()?;
        let climber = Climber::new(config.climber, spawn)?;
        let state = FighterState {
            climber: *climber.state(),
            act: WeaponAction::Ready,
            actions: 0,
            knockback: None,
            harm: 0.0,
            hit_stop: 0.0,
            dead: None,
            arrows: arrows(&config),
            random: seed,
            has_begun: false,
            spawn,
        };
        Ok(Self {
            id,
            mark: fighter_mark(id, &config),
            config,
            climber,
            state,
            report: StepReport::default(),
        })
    }

    /// The fighter's number in its arena. It never changes, and no other fighter gets it.
    pub fn id(&self) -> FighterId {
        self.id
    }

    /// The fighter's body and weapons.
    pub fn config(&self) -> &FighterConfig {
        &self.config
    }

    /// The climber, after the last tick.
    pub fn climber(&self) -> &Climber {
        &self.climber
    }

    /// What the fighter does with its weapons now, such as a cut, or drawing the bow.
    pub fn act(&self) -> &WeaponAction {
        &self.state.act
    }

    /// The results of its climber's last step, such as its events and its pushes against obstacles. Empty before the
    /// first step and after a restore.
    pub fn report(&self) -> &StepReport {
        &self.report
    }

    /// True from the fighter's death until it lives again: by [`FighterConfig::respawn`], once there is room, or by
    /// [`Order::Rise`](crate::Order::Rise).
    pub fn is_dead(&self) -> bool {
        self.state.dead.is_some()
    }

    /// Arrows left; `None` if they are not counted.
    pub fn arrows(&self) -> Option<u32> {
        let bow = self.config.bow.as_ref()?;
        bow.arrows.map(|_| self.state.arrows)
    }

    /// Strength of the current stab, from 0 to 1; 0 without a stab.
    pub fn charge(&self) -> f64 {
        match self.state.act {
            WeaponAction::Charge { charge, .. }
            | WeaponAction::Strike { charge, .. }
            | WeaponAction::Plunge { charge } => charge,
            _ => 0.0,
        }
    }

    /// How far its bow is drawn, from 0 to 1.
    pub fn drawn(&self) -> f64 {
        match self.state.act {
            WeaponAction::Draw { drawn } => drawn,
            _ => 0.0,
        }
    }

    /// A copy of all of the fighter that changes, for saving it. Its number and configuration are not included.
    pub fn state(&self) -> FighterState {
        FighterState {
            climber: *self.climber.state(),
            ..self.state.clone()
        }
    }

    pub(crate) fn mark(&self) -> u64 {
        self.mark
    }

    /// State without the climber's; the field `climber` in it is stale.
    pub(crate) fn rest(&self) -> &FighterState {
        &self.state
    }

    pub(crate) fn rest_mut(&mut self) -> &mut FighterState {
        &mut self.state
    }

    /// Steps the climber.
    pub(crate) fn step(
        &mut self,
        input: &ClimberInput,
        obstacles: &[(ObstacleId, &dyn Obstacle)],
        rules: &StepRules<'_>,
        dt: f64,
    ) -> Result<(), ArenaError> {
        self.report = self.climber.step_with(input, obstacles, rules, dt)?;
        Ok(())
    }

    /// Checks that its climber can be in a saved state.
    pub(crate) fn check(&self, state: &FighterState) -> Result<(), ArenaError> {
        let mut climber = Climber::new(self.config.climber, state.spawn)?;
        Ok(climber.restore(state.climber)?)
    }

    pub(crate) fn restore(&mut self, state: &FighterState) -> Result<(), ArenaError> {
        self.climber.restore(state.climber)?;
        self.state.clone_from(state);
        self.report = StepReport::default();
        Ok(())
    }
}

/// Hash of the constant part of a fighter: number and configuration.
pub(crate) fn fighter_mark(id: FighterId, config: &FighterConfig) -> u64 {
    hash_of(2, &(id, config))
}

fn arrows(config: &FighterConfig) -> u32 {
    config.bow.and_then(|bow| bow.arrows).unwrap_or(0)
}
