//! The creature's part of a battle: it lives by its brain, or plays its clips by a timetable.

use std::sync::Arc;

use clamber_climber::{Blow, Climber};
use clamber_colossus::brain::Act;
use clamber_colossus::{AttackPhase, Brain, CreatureConfig, Surroundings};
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::Obstacle;
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::scene::{CREATURE, TICK};
use super::{BattleError, BattleOptions, Choreography};
use crate::person::person;
use crate::{Creature, valley};

/// Where a creature with a brain begins, metres: beyond the outcrop.
const HOME: [f64; 2] = [65.0, 0.0];

/// It stays within this distance of there, and sees as far, metres.
const ARENA: f64 = 35.0;
const SIGHT: f64 = 60.0;

/// The climber's number among the people that the creature senses.
const CLIMBER: u64 = 0;

/// The creature's part of a battle.
pub struct Performer<'a> {
    creature: &'a Creature,
    part: Part<'a>,
    velocity: DVec3,
}

enum Part<'a> {
    Lives(Box<clamber_colossus::Creature>),
    Plays(Box<(Choreography<'a>, SkinnedSurface)>),
}

/// All that changes in a performer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum PerformerState {
    /// Of a creature with a brain.
    Lives(Box<clamber_colossus::CreatureState>),
    /// Of a timetable.
    Plays {
        /// Time of the creature's clips, seconds: the sum of the ticks' lengths.
        time: f64,
        /// Distance that the creature has walked, metres.
        walked: f64,
    },
}

/// What a climber sees of what the creature is doing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Sight {
    /// It stays where it is, and neither shakes nor attacks: its feet may be approached.
    pub(super) is_calm: bool,
    /// It raises a limb against somebody, or strikes.
    pub(super) attacks: bool,
}

impl<'a> Performer<'a> {
    /// A creature at the beginning of a battle: with a brain if the options have one, or else with a timetable.
    ///
    /// # Errors
    /// [`BattleError::NoHeight`] if it is flat, [`BattleError::Brain`] and [`BattleError::Colossus`] if its brain cannot be
    /// read or does not fit it, [`BattleError::Creature`] if a clip does not fit its skeleton.
    pub fn new(creature: &'a Creature, options: &BattleOptions) -> Result<Self, BattleError> {
        let part = match options.load_brain()? {
            Some(brain) => Part::Lives(Box::new(alive(creature, brain, options)?)),
            None => {
                let mut choreography = Choreography::new(creature, options.height())?;
                let mut surface = SkinnedSurface::new(Arc::clone(&creature.collider));
                let (palette, world_from_model) = choreography.pose()?;
                surface.place(palette, world_from_model)?;
                Part::Plays(Box::new((choreography, surface)))
            }
        };
        Ok(Self {
            creature,
            part,
            velocity: DVec3::ZERO,
        })
    }

    /// Lets a tick pass, and gives the blow that the climber gets with it.
    ///
    /// # Errors
    /// [`BattleError`] if the creature cannot be posed.
    pub fn step(
        &mut self,
        climber: &Climber,
        terrain: &dyn Obstacle,
    ) -> Result<Option<Blow>, BattleError> {
        let before = self.surface().world_from_model().translation;
        let mut blow = None;
        match &mut self.part {
            Part::Lives(life) => {
                let around = Surroundings {
                    terrain: &[terrain],
                    people: &[person(climber, CLIMBER, CREATURE)],
                    noises: &[],
                };
                let report = life.step(&around)?;
                blow = report.blows.first().map(|blow| Blow {
                    velocity: blow.velocity,
                    damage: blow.damage.clamp(0.0, 1.0),
                    by: Some(CREATURE),
                });
            }
            Part::Plays(plays) => {
                let (choreography, surface) = &mut **plays;
                choreography.advance(TICK)?;
                let (palette, world_from_model) = choreography.pose()?;
                surface.advance(palette, world_from_model)?;
            }
        }
        let moved = self.surface().world_from_model().translation - before;
        self.velocity = moved / TICK;
        Ok(blow)
    }

    /// The creature as it was loaded.
    pub fn creature(&self) -> &'a Creature {
        self.creature
    }

    /// The creature that lives; `None` if it plays a timetable.
    pub fn life(&self) -> Option<&clamber_colossus::Creature> {
        match &self.part {
            Part::Lives(life) => Some(life),
            Part::Plays(_) => None,
        }
    }

    /// The skin, as posed by the last step.
    pub fn surface(&self) -> &SkinnedSurface {
        match &self.part {
            Part::Lives(life) => life.surface(),
            Part::Plays(plays) => &plays.1,
        }
    }

    /// The palette of the last step.
    pub fn palette(&self) -> &Palette {
        match &self.part {
            Part::Lives(life) => life.palette(),
            Part::Plays(plays) => plays.0.palette(),
        }
    }

    /// Velocity of the creature as a whole over the last tick, without its clips, metres a second.
    pub fn velocity(&self) -> DVec3 {
        self.velocity
    }

    /// What it is doing, as text for messages.
    pub fn playing(&self) -> String {
        match &self.part {
            Part::Lives(life) => life.kind().brain().path(life.state().current()).to_owned(),
            Part::Plays(plays) => plays.0.playing(),
        }
    }

    /// Names of the clips that are not loops and are therefore played back and forth.
    pub fn turned_back(&self) -> Vec<String> {
        match &self.part {
            Part::Lives(_) => Vec::new(),
            Part::Plays(plays) => plays.0.turned_back(),
        }
    }

    pub(super) fn sight(&self) -> Sight {
        match &self.part {
            Part::Lives(life) => {
                let attack = life.attack().map(|(_, phase)| phase);
                let act = life.kind().brain().act(life.state().current());
                let is_quiet =
                    !matches!(act, Some(Act::Walk(_) | Act::Once(_))) && life.state().speed() < 0.5;
                let attacks = matches!(attack, Some(AttackPhase::WindUp | AttackPhase::Active));
                Sight {
                    is_calm: is_quiet && !attacks,
                    attacks,
                }
            }
            Part::Plays(plays) => Sight {
                is_calm: plays.0.is_calm(),
                attacks: false,
            },
        }
    }

    pub(super) fn state(&self) -> PerformerState {
        match &self.part {
            Part::Lives(life) => PerformerState::Lives(Box::new(life.state().clone())),
            Part::Plays(plays) => {
                let (time, walked) = plays.0.progress();
                PerformerState::Plays { time, walked }
            }
        }
    }

    /// Restores a state; the skin stands there without motion.
    pub(super) fn restore(&mut self, state: &PerformerState) -> Result<(), BattleError> {
        match (&mut self.part, state) {
            (Part::Lives(life), PerformerState::Lives(state)) => life.restore((**state).clone())?,
            (Part::Plays(plays), PerformerState::Plays { time, walked }) => {
                let (choreography, surface) = &mut **plays;
                choreography.go_to((*time, *walked));
                let (palette, world_from_model) = choreography.pose()?;
                surface.place(palette, world_from_model)?;
            }
            _ => {
                let reason = "the snapshot is of a battle with a brain, or this one is".to_owned();
                return Err(BattleError::Snapshot(reason));
            }
        }
        self.velocity = DVec3::ZERO;
        Ok(())
    }
}

fn alive(
    creature: &Creature,
    brain: Brain,
    options: &BattleOptions,
) -> Result<clamber_colossus::Creature, BattleError> {
    let kind = creature.with_brain(brain)?;
    let scale = options.height() / kind.height();
    if !(scale.is_normal() && scale > 0.0) {
        return Err(BattleError::NoHeight {
            creature: creature.name.clone(),
            height: options.height(),
        });
    }
    let [x, z] = HOME;
    let config = CreatureConfig {
        position: DVec3::new(x, valley::height(x, z), z),
        scale,
        seed: options.seed,
        arena: ARENA,
        sight: SIGHT,
        ..CreatureConfig::default()
    };
    Ok(clamber_colossus::Creature::new(Arc::new(kind), config)?)
}
