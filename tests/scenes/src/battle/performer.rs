//! The creature's part of a battle: it lives by its brain, or plays its clips by a timetable.

use std::sync::Arc;

use clamber_climber::{
    Climber, ClimberConfig, ClimberInput, ClimberState, ContactRuleFn, StepReport, StepRules,
};
use clamber_colossus::brain::Act;
use clamber_colossus::{AttackPhase, Brain, CreatureConfig};
use clamber_fight::{
    Arena, ArenaConfig, ArenaState, CreatureId, Fighter, FighterConfig, FighterId,
};
use clamber_surface::mesh::TriangleId;
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::scene::{CREATURE, TERRAIN, TICK};
use super::{BattleError, BattleOptions, Choreography};
use crate::{Creature, valley};

/// Where a creature with a brain begins, metres: beyond the outcrop.
const HOME: [f64; 2] = [65.0, 0.0];

/// It stays within this distance of there, and sees as far, metres.
const ARENA: f64 = 35.0;
const SIGHT: f64 = 60.0;

/// Whoever is lower than this has left the valley, metres.
const FLOOR: f64 = -30.0;

/// The creature that fights, and who fights it.
const GIANT: CreatureId = CreatureId(0);
const HERO: FighterId = FighterId(0);

/// The creature's part of a battle, and the climber: both fight in an arena, or the climber rides a timetable.
pub struct Performer<'a> {
    creature: &'a Creature,
    part: Part<'a>,
    velocity: DVec3,
}

enum Part<'a> {
    Fights(Box<Arena>),
    Plays(Box<Play<'a>>),
}

/// A creature that plays its clips by a timetable, and its rider.
struct Play<'a> {
    choreography: Choreography<'a>,
    surface: SkinnedSurface,
    climber: Climber,
    report: StepReport,
}

/// All that changes in a performer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum PerformerState {
    /// Of a fight: the climber's as well.
    Fights(Box<ArenaState>),
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
    /// It stays where it is.
    pub(super) stays: bool,
    /// It raises a limb against somebody, or strikes, or what it has let out is on its way.
    pub(super) attacks: bool,
}

impl<'a> Performer<'a> {
    /// A creature at the beginning of a battle: with a brain if the options have one, or else with a timetable. Nobody
    /// fights or rides it yet.
    ///
    /// # Errors
    /// [`BattleError::NoHeight`] if it is flat, [`BattleError::Brain`] and [`BattleError::Colossus`] if its brain cannot be
    /// read or does not fit it, [`BattleError::Creature`] if a clip does not fit its skeleton.
    pub fn new(creature: &'a Creature, options: &BattleOptions) -> Result<Self, BattleError> {
        let part = match options.load_brain()? {
            Some(brain) => Part::Fights(Box::new(arena(creature, brain, options)?)),
            None => {
                let mut choreography = Choreography::new(creature, options.height())?;
                let mut surface = SkinnedSurface::new(Arc::clone(&creature.collider));
                let (palette, world_from_model) = choreography.pose()?;
                surface.place(palette, world_from_model)?;
                Part::Plays(Box::new(Play {
                    choreography,
                    surface,
                    climber: Climber::new(ClimberConfig::walker(), DVec3::ZERO)?,
                    report: StepReport::default(),
                }))
            }
        };
        Ok(Self {
            creature,
            part,
            velocity: DVec3::ZERO,
        })
    }

    /// Lets a climber enter. In a fight it has sword and bow.
    ///
    /// # Errors
    /// [`BattleError`] if the climber cannot be made.
    pub(super) fn enter(
        &mut self,
        config: ClimberConfig,
        position: DVec3,
    ) -> Result<(), BattleError> {
        match &mut self.part {
            Part::Fights(arena) => {
                let config = FighterConfig {
                    climber: config,
                    respawn: Some(3.0),
                    ..FighterConfig::hero()
                };
                arena.add_fighter(config, position)?;
            }
            Part::Plays(play) => play.climber = Climber::new(config, position)?,
        }
        Ok(())
    }

    /// Puts a rider somewhere.
    ///
    /// # Errors
    /// [`BattleError::Climber`] if it refuses the state.
    pub(super) fn put(&mut self, state: ClimberState) -> Result<(), BattleError> {
        match &mut self.part {
            Part::Fights(arena) => {
                let mut saved = arena.save();
                if let Some(fighter) = saved.fighters.first_mut() {
                    fighter.state.climber = state;
                }
                arena.restore(&saved)?;
            }
            Part::Plays(play) => play.climber.restore(state)?,
        }
        Ok(())
    }

    /// Poses a creature with a timetable for the next tick. One that fights decides in its own step.
    ///
    /// # Errors
    /// [`BattleError`] if the creature cannot be posed.
    pub(super) fn advance(&mut self) -> Result<(), BattleError> {
        let Part::Plays(play) = &mut self.part else {
            return Ok(());
        };
        let before = play.surface.world_from_model().translation;
        play.choreography.advance(TICK)?;
        let (palette, world_from_model) = play.choreography.pose()?;
        play.surface.advance(palette, world_from_model)?;
        self.velocity = (self.surface().world_from_model().translation - before) / TICK;
        Ok(())
    }

    /// Lets a tick pass: the whole arena's, or the rider's on the creature that was posed for it.
    ///
    /// # Errors
    /// [`BattleError`] if the creature cannot be posed, or the input is not finite.
    pub(super) fn step(
        &mut self,
        input: &ClimberInput,
        terrain: &dyn Obstacle,
        rule: &ContactRuleFn<'_>,
    ) -> Result<(), BattleError> {
        let before = self.surface().world_from_model().translation;
        let rules = StepRules::by(rule);
        match &mut self.part {
            Part::Fights(arena) => {
                arena.step_with(&[*input], &[], &[(TERRAIN, terrain)], &rules)?;
                let moved = self.surface().world_from_model().translation - before;
                self.velocity = moved / TICK;
            }
            Part::Plays(play) => {
                let obstacles: [(ObstacleId, &dyn Obstacle); 2] =
                    [(TERRAIN, terrain), (CREATURE, &play.surface)];
                play.report = play.climber.step_with(input, &obstacles, &rules, TICK)?;
            }
        }
        Ok(())
    }

    /// The creature as it was loaded.
    pub fn creature(&self) -> &'a Creature {
        self.creature
    }

    /// The arena of a fight; `None` if the creature plays a timetable.
    pub fn arena(&self) -> Option<&Arena> {
        match &self.part {
            Part::Fights(arena) => Some(arena),
            Part::Plays(_) => None,
        }
    }

    /// The creature that lives; `None` if it plays a timetable.
    pub fn life(&self) -> Option<&clamber_colossus::Creature> {
        self.arena()?.creature(GIANT)
    }

    /// The triangles of each of its plates; none if it plays a timetable.
    pub(super) fn plates(&self) -> Vec<Vec<TriangleId>> {
        let plates = self.life().map_or(&[][..], |life| life.kind().plates());
        plates.iter().map(|plate| plate.triangles.clone()).collect()
    }

    /// Who fights; `None` if the creature plays a timetable.
    pub fn fighter(&self) -> Option<&Fighter> {
        self.arena()?.fighter(HERO)
    }

    /// The climber.
    pub fn climber(&self) -> &Climber {
        match &self.part {
            // Somebody has entered.
            Part::Fights(arena) => arena.fighters()[0].climber(),
            Part::Plays(play) => &play.climber,
        }
    }

    /// The report of the climber's last step.
    pub fn report(&self) -> &StepReport {
        match &self.part {
            Part::Fights(arena) => arena.fighters()[0].report(),
            Part::Plays(play) => &play.report,
        }
    }

    /// The skin, as posed by the last step.
    pub fn surface(&self) -> &SkinnedSurface {
        match &self.part {
            Part::Fights(arena) => life(arena).surface(),
            Part::Plays(play) => &play.surface,
        }
    }

    /// The palette of the last step.
    pub fn palette(&self) -> &Palette {
        match &self.part {
            Part::Fights(arena) => life(arena).palette(),
            Part::Plays(play) => play.choreography.palette(),
        }
    }

    /// Velocity of the creature as a whole over the last tick, without its clips, metres a second.
    pub fn velocity(&self) -> DVec3 {
        self.velocity
    }

    /// What it is doing, as text for messages.
    pub fn playing(&self) -> String {
        match &self.part {
            Part::Fights(arena) => {
                let life = life(arena);
                life.kind().brain().path(life.state().current()).to_owned()
            }
            Part::Plays(play) => play.choreography.playing(),
        }
    }

    /// Names of the clips that are not loops and are therefore played back and forth.
    pub fn turned_back(&self) -> Vec<String> {
        match &self.part {
            Part::Fights(_) => Vec::new(),
            Part::Plays(play) => play.choreography.turned_back(),
        }
    }

    pub(super) fn sight(&self) -> Sight {
        match &self.part {
            Part::Fights(arena) => {
                let life = life(arena);
                let attack = life.attack().map(|(_, phase)| phase);
                let act = life.kind().brain().act(life.state().current());
                let is_quiet = !matches!(act, Some(Act::Walk(_) | Act::Once(_)))
                    && life.state().speed().abs() < 0.5;
                let attacks = matches!(attack, Some(AttackPhase::WindUp | AttackPhase::Active))
                    || life.waves().next().is_some()
                    || life.shots().next().is_some();
                Sight {
                    is_calm: is_quiet && !attacks,
                    stays: life.state().speed().abs() < 0.5,
                    attacks,
                }
            }
            Part::Plays(play) => Sight {
                is_calm: play.choreography.is_calm(),
                stays: play.choreography.is_calm(),
                attacks: false,
            },
        }
    }

    pub(super) fn state(&self) -> PerformerState {
        match &self.part {
            Part::Fights(arena) => PerformerState::Fights(Box::new(arena.save())),
            Part::Plays(play) => {
                let (time, walked) = play.choreography.progress();
                PerformerState::Plays { time, walked }
            }
        }
    }

    /// Restores a state, and the climber's; the skin stands there without motion.
    pub(super) fn restore(
        &mut self,
        state: &PerformerState,
        climber: ClimberState,
    ) -> Result<(), BattleError> {
        match (&mut self.part, state) {
            (Part::Fights(arena), PerformerState::Fights(state)) => arena.restore(state)?,
            (Part::Plays(play), PerformerState::Plays { time, walked }) => {
                play.climber.restore(climber)?;
                play.choreography.go_to((*time, *walked));
                let (palette, world_from_model) = play.choreography.pose()?;
                play.surface.place(palette, world_from_model)?;
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

/// An arena with the creature alone.
fn arena(creature: &Creature, brain: Brain, options: &BattleOptions) -> Result<Arena, BattleError> {
    let kind = creature.with_brain(brain)?;
    // What its brain says of its height is at a scale of 1.
    let tall = kind.brain().file().body.height.unwrap_or(kind.height());
    let scale = options.height() / tall;
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
    let mut arena = Arena::new(ArenaConfig {
        tick: TICK,
        floor: FLOOR,
        seed: options.seed,
        ..ArenaConfig::default()
    })?;
    arena.add_creature(Arc::new(kind), config)?;
    Ok(arena)
}

/// The creature of an arena.
#[expect(
    clippy::expect_used,
    reason = "it is the first that joins, and nobody lets it leave"
)]
fn life(arena: &Arena) -> &clamber_colossus::Creature {
    arena.creature(CreatureId(0)).expect("there is a creature")
}
