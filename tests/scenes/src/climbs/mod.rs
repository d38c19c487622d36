//! A bot climbs many models, from the ground to the highest place that their graph calls reachable with its strength.

mod moves;
mod options;
mod table;

use std::path::Path;

use clamber_climber::{Climber, ClimberConfig, ClimberEvent, ContactQuery, StepRules};
use clamber_navigation::{
    Bot, BotConfig, ClimbGraph, Danger, Footing, Forecast, FutureSkin, NavigationError, View,
};
use clamber_surface::geometry::Similarity;
use clamber_surface::rig::Palette;
use clamber_surface::surface::{SkinnedSurface, SurfaceError};
use clamber_world::{HalfSpace, Obstacle, ObstacleId};
use glam::DVec3;
use thiserror::Error;

use moves::Moves;
pub use options::ClimbsOptions;
pub use table::table;

use crate::{Creature, CreatureError};

/// How far the bot looks ahead for shakes, and in which steps, seconds.
const LOOKS: f64 = 0.5;
const AHEAD: f64 = 0.1;

const GROUND: ObstacleId = ObstacleId(0);
const CREATURE: ObstacleId = ObstacleId(1);

/// Why a model cannot be climbed.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ClimbError {
    /// The model cannot be loaded or posed.
    #[error(transparent)]
    Creature(#[from] CreatureError),
    /// Its clips cannot be measured.
    #[error(transparent)]
    Battle(#[from] crate::battle::BattleError),
    /// Its skin cannot be divided into a graph.
    #[error(transparent)]
    Navigation(#[from] NavigationError),
    /// The climber refused its settings or its input.
    #[error(transparent)]
    Climber(#[from] clamber_climber::ClimberError),
}

impl From<SurfaceError> for ClimbError {
    fn from(error: SurfaceError) -> Self {
        Self::Creature(error.into())
    }
}

impl From<clamber_surface::rig::RigError> for ClimbError {
    fn from(error: clamber_surface::rig::RigError) -> Self {
        Self::Creature(error.into())
    }
}

/// A model, and how its climb went.
#[derive(Debug)]
pub struct Climb {
    /// The file's name, without its extension.
    pub model: String,
    /// How it went, or why it was not climbed.
    pub outcome: Result<Climbed, ClimbError>,
}

/// How a climb went.
#[derive(Clone, Debug, PartialEq)]
pub struct Climbed {
    /// Number of patches of the graph.
    pub patches: usize,
    /// Share of the skin that is reachable with the strength that a bot counts on.
    pub reachable: f64,
    /// Height of the creature, and of the highest place that is reachable with that, above the ground; metres.
    pub heights: [f64; 2],
    /// The least time from the ground to there, seconds.
    pub least: f64,
    /// When the bot got on, and when it came there, seconds.
    pub times: [Option<f64>; 2],
    /// How high it came, metres.
    pub highest: f64,
    /// How often its plan was changed, and how often it fell.
    pub plans: u64,
    /// How often it lost its hold.
    pub falls: u32,
}

impl Climbed {
    /// How many times the least time from the ground it took after it had got on; `None` if it did not come there.
    pub fn ratio(&self) -> Option<f64> {
        let [on, there] = self.times;
        Some((there? - on?) / self.least)
    }
}

/// Climbs every model. Calls `watch` after each climb, with the number of climbs done and of all climbs.
///
/// # Errors
/// [`crate::battle::BattleError`] if there are no models. A model that cannot be climbed is listed among the climbs with its error.
pub fn climb_all(
    options: &ClimbsOptions,
    mut watch: impl FnMut(&Climb, usize, usize),
) -> Result<Vec<Climb>, crate::battle::BattleError> {
    let files = options.files()?;
    let mut climbs = Vec::with_capacity(files.len());
    for file in &files {
        let model = file.file_stem().unwrap_or_default();
        let climb = Climb {
            model: model.to_string_lossy().into_owned(),
            outcome: climb(file, options),
        };
        watch(&climb, climbs.len() + 1, files.len());
        climbs.push(climb);
    }
    Ok(climbs)
}

/// Climbs one model.
///
/// # Errors
/// [`ClimbError`] if it cannot be loaded, posed, or divided into a graph.
pub fn climb(file: &Path, options: &ClimbsOptions) -> Result<Climbed, ClimbError> {
    let creature = Creature::load(file)?;
    climb_by(ClimberConfig::colossus_climber(), &creature, options)
}

/// Climbs a creature with a climber of one's own.
///
/// # Errors
/// [`ClimbError`] if the creature cannot be posed or divided into a graph, or the climber's numbers are out of range.
pub fn climb_by(
    config: ClimberConfig,
    creature: &Creature,
    options: &ClimbsOptions,
) -> Result<Climbed, ClimbError> {
    let tick_length = 1.0 / options.rate;
    let mut scene = Scene::new(creature, options)?;
    let rate = scene.moves.as_ref().map_or(1.0, |moves| moves.rate);
    let graph = creature.graph(&config, options.height, rate, &[])?;
    let strength = 1.0 - BotConfig::default().reserve;
    let reached = graph.reachable_with(strength);
    let height = |patch: usize| graph.patches()[patch].seat.y - scene.ground;
    let best = (0..reached.len()).filter(|patch| reached[*patch]);
    let best = best.max_by(|a, b| height(*a).total_cmp(&height(*b)));
    let area = |counts: &dyn Fn(usize) -> bool| -> f64 {
        let all = graph.patches().iter().enumerate();
        all.filter(|(index, _)| counts(*index))
            .map(|(_, patch)| patch.area)
            .sum()
    };
    let mut climbed = Climbed {
        patches: graph.patches().len(),
        reachable: area(&|patch| reached[patch]) / creature.area(options.height).max(1e-9),
        heights: [options.height, best.map_or(0.0, height)],
        least: f64::INFINITY,
        times: [None; 2],
        highest: 0.0,
        plans: 0,
        falls: 0,
    };
    let Some(best) = best else {
        return Ok(climbed);
    };
    let goal = graph.goal(&[best]);
    let least = |patch: usize| {
        let footings = [Footing::Stands, Footing::Holds];
        let [stands, holds] =
            footings.map(|footing| goal.least_seconds_with(patch, footing, strength));
        stands.min(holds)
    };
    let entries = graph.entries().iter().map(|entry| entry.patch);
    let first = entries.min_by(|a, b| least(*a).total_cmp(&least(*b)));
    let first = first.unwrap_or(best);
    climbed.least = least(first);
    let mut bot = Bot::new(std::sync::Arc::clone(&graph), BotConfig::default());
    let mut climber = scene.climber(config, &graph, first)?;
    let mut future = FutureSkin::new(std::sync::Arc::clone(&creature.collider));
    for tick in 0..(options.seconds * options.rate) as u64 {
        let seconds = tick as f64 * tick_length;
        scene.advance(creature, seconds)?;
        let told = scene.moves.as_ref().filter(|_| options.forecast);
        let forecast = told.map_or_else(Forecast::still, |moves| {
            moves.forecast(creature, &graph, seconds)
        });
        let shake_ahead = match &scene.moves {
            Some(moves) => {
                let mut pose = creature.skeleton.rest_pose();
                let place = scene.place;
                let mut ahead = |later: f64, palette: &mut Palette| {
                    let posed = moves.pose(creature, seconds + later, &mut pose);
                    posed.ok()?;
                    creature.skeleton.palette_into(&pose, palette).ok()?;
                    Some(place)
                };
                future.shake_ahead(&climber, CREATURE, &mut ahead, AHEAD, LOOKS)?
            }
            None => 0.0,
        };
        let view = View {
            seconds,
            climber: &climber,
            creature: CREATURE,
            surface: &scene.surface,
            goal: &goal,
            forecast: &forecast,
            danger: Danger::None,
            shake_ahead,
        };
        if view.is_on_creature() {
            climbed.times[0].get_or_insert(seconds);
        }
        if bot.is_there(&view) {
            climbed.times[1] = Some(seconds);
        }
        let input = bot.input(&view);
        climbed.highest = climbed
            .highest
            .max(climber.state().position.y - scene.ground);
        climbed.plans = bot.plans();
        if climbed.times[1].is_some() {
            break;
        }
        climbed.falls += scene.step(&mut climber, &input, tick_length)?;
    }
    Ok(climbed)
}

/// The creature on level ground.
struct Scene {
    surface: SkinnedSurface,
    floor: HalfSpace,
    ground: f64,
    place: Similarity,
    /// What it does; `None` at rest.
    moves: Option<Moves>,
}

impl Scene {
    fn new(creature: &Creature, options: &ClimbsOptions) -> Result<Self, ClimbError> {
        let (place, ground) = creature.standing(options.height)?;
        let moves = match options.moving {
            true => Some(Moves::new(creature, options.height)?),
            false => None,
        };
        let mut scene = Self {
            surface: SkinnedSurface::new(std::sync::Arc::clone(&creature.collider)),
            floor: HalfSpace::below(ground),
            ground,
            place,
            moves,
        };
        // It stands as it does at first: what jumps there is faster than a bullet.
        scene.surface.place(&scene.palette(creature, 0.0)?, place)?;
        Ok(scene)
    }

    /// A climber on the ground, some way from an entry.
    fn climber(
        &self,
        config: ClimberConfig,
        graph: &ClimbGraph,
        entry: usize,
    ) -> Result<Climber, ClimbError> {
        let patch = &graph.patches()[entry];
        let out = (patch.normal * DVec3::new(1.0, 0.0, 1.0)).normalize_or(DVec3::X);
        let level = patch.seat * DVec3::new(1.0, 0.0, 1.0);
        // Farther and farther out, until there is room.
        let room = |away: &f64| {
            let place = level + out * *away + DVec3::Y * (self.ground + 1.1 * config.body.radius);
            let hit = self
                .surface
                .in_world()
                .closest_point(place, 1.5 * config.body.radius);
            hit.is_none()
        };
        let away = |step: u32| 2.5 * config.body.radius * f64::from(step);
        let away = (3..60).map(away).find(room).unwrap_or(away(60));
        let feet = level + out * away + DVec3::Y * self.ground;
        let position = feet + DVec3::Y * (1.1 * config.body.radius);
        Ok(Climber::new(config, position)?)
    }

    /// Poses the creature: at rest, or by its clips in turn.
    fn advance(&mut self, creature: &Creature, seconds: f64) -> Result<(), ClimbError> {
        let palette = self.palette(creature, seconds)?;
        self.surface.advance(&palette, self.place)?;
        Ok(())
    }

    fn palette(&self, creature: &Creature, seconds: f64) -> Result<Palette, ClimbError> {
        let mut pose = creature.skeleton.rest_pose();
        if let Some(moves) = &self.moves {
            moves.pose(creature, seconds, &mut pose)?;
        }
        Ok(creature.skeleton.palette(&pose)?)
    }

    /// Steps the climber; gives how often it lost its hold.
    fn step(
        &self,
        climber: &mut Climber,
        input: &clamber_climber::ClimberInput,
        tick: f64,
    ) -> Result<u32, ClimbError> {
        let obstacles: [(ObstacleId, &dyn Obstacle); 2] =
            [(GROUND, &self.floor), (CREATURE, &self.surface)];
        let rule = |query: &ContactQuery<'_>| query.usual().with_grip(query.id == CREATURE);
        let rules = StepRules::by(&rule);
        let report = climber.step_with(input, &obstacles, &rules, tick)?;
        let lost = |event: &&ClimberEvent| {
            matches!(
                event,
                ClimberEvent::ShakenOff { .. }
                    | ClimberEvent::Thrown { .. }
                    | ClimberEvent::Slipped
            )
        };
        Ok(report.events.iter().filter(lost).count() as u32)
    }
}
