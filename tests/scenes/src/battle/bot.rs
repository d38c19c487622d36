//! A bot that plans its way to the creature's weak points, and wounds it there.

use std::sync::Arc;

use clamber_climber::{ClimberInput, ClimberMode};
use clamber_colossus::{AttackPhase, Brain, CreatureConfig, CreatureKind};
use clamber_fight::{Arena, ArenaConfig, CreatureId};
use clamber_navigation::{Bot, BotConfig, ClimbGraph, Danger, Forecast, Goal, View};
use glam::DVec3;

use super::choreography::no_height;
use super::eyes::Eyes;
use super::fencer::Fencer;
use super::outcrop::Crossing;
use super::{BattleOptions, CREATURE, GRIP, SceneError, TICK};
use crate::{Creature, valley};

/// Place where the creature begins, x and z, metres: beyond the outcrop.
const HOME: [f64; 2] = [65.0, 0.0];

/// Distance from its place within which the creature stays, metres.
const ARENA: f64 = 35.0;
/// Distance up to which the creature sees, metres.
const SIGHT: f64 = 60.0;

/// Height below which a fighter has left the valley, metres.
const FLOOR: f64 = -30.0;

/// Largest distance of a plate's patches from the weak point that the plate covers, metres on a creature of the height
/// [`TALL`]; proportionally less on a smaller one.
const COVER: f64 = 1.2;
/// Distance beyond a weak point's radius up to which a climber can wound it, metres on a creature of that height.
const BESIDE: f64 = 0.5;
/// Height of the giant, metres.
const TALL: f64 = 41.0;

/// Shake up to which the bot moves up to its goal's weak point, metres a second squared.
const STEADY: f64 = 6.0;

/// An arena with the creature alone.
pub(super) fn arena(
    creature: &Creature,
    brain: Brain,
    options: &BattleOptions,
) -> Result<Arena, SceneError> {
    let kind = CreatureKind::new(&creature.rig, brain)?;
    // The height in the brain's file is at a scale of 1.
    let tall = kind.brain().file().body.height.unwrap_or(kind.height());
    let scale = options.height() / tall;
    if !(scale.is_normal() && scale > 0.0) {
        return Err(no_height(creature, options.height()));
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

/// The creature of an arena from [`arena()`].
#[expect(
    clippy::expect_used,
    reason = "the creature joins first and never leaves"
)]
pub(super) fn giant(arena: &Arena) -> &clamber_colossus::Creature {
    arena.creature(CreatureId(0)).expect("there is a creature")
}

/// What the bot sees of the creature's actions. A creature attacks if it raises a limb against somebody, or strikes, or
/// its wave or shot is on its way.
fn danger(life: &clamber_colossus::Creature) -> Danger {
    let attack = life.attack().map(|(_, phase)| phase);
    if matches!(attack, Some(AttackPhase::WindUp | AttackPhase::Active))
        || life.waves().next().is_some()
        || life.shots().next().is_some()
    {
        Danger::Attacks
    } else if life.state().speed().abs() < 0.5 {
        Danger::None
    } else {
        Danger::Moves
    }
}

/// What to strike, and the ways there.
#[derive(Clone, Debug)]
pub(super) struct Target {
    /// The weak point, by its index.
    pub(super) weak_point: usize,
    /// The plate over the weak point, by its index.
    pub(super) plate: Option<usize>,
    goal: Goal,
}

/// The bot's plan and memory.
#[derive(Clone, Debug)]
pub(super) struct Planner {
    bot: Bot,
    targets: Vec<Target>,
    /// The current target, by its index.
    at: usize,
    forecast: Forecast,
    fencer: Fencer,
    crossing: Crossing,
    eyes: Eyes,
    /// The highest weak point at rest.
    highest: Option<usize>,
    arrived: Option<f64>,
}

impl Planner {
    /// A bot against the creature of an arena. [`SceneError`] if no weak point can be reached from the ground.
    pub(super) fn new(
        arena: &Arena,
        graph: Arc<ClimbGraph>,
        creature: &Creature,
    ) -> Result<Self, SceneError> {
        let life = giant(arena);
        let leads = |target: &Target| {
            let mut entries = graph.entries().iter();
            entries.any(|entry| target.goal.least_seconds_from(entry.patch).is_finite())
        };
        let targets: Vec<Target> = targets(life, &graph).into_iter().filter(leads).collect();
        if targets.is_empty() {
            let name = &creature.name;
            let reason = "no grippable skin leads from near the ground to a weak point";
            return Err(format!("found no way up {name}: {reason}; try --story ride").into());
        }
        let forecast = Forecast::still()
            .then(&graph, "idle", 0.0, 4.5)
            .then(&graph, "shake", 0.0, 4.5);
        let height = |point: &usize| place(life, *point).y;
        let points = 0..life.kind().weak_points().len();
        Ok(Self {
            bot: Bot::new(graph, BotConfig::default()),
            targets,
            at: 0,
            forecast,
            fencer: Fencer::default(),
            crossing: Crossing::default(),
            eyes: Eyes::new(&creature.rig.collider),
            highest: points.max_by(|a, b| height(a).total_cmp(&height(b))),
            arrived: None,
        })
    }

    /// The bot, its goal, and when it first came to the highest weak point, seconds.
    pub(super) fn bot(&self) -> (&Bot, &Goal, Option<f64>) {
        (&self.bot, &self.targets[self.at].goal, self.arrived)
    }

    /// The climber was put back to the start.
    pub(super) fn begin_again(&mut self) {
        self.bot.forget();
        self.fencer.begin_again();
        self.crossing = Crossing::default();
    }

    /// The input of the tick that begins at `seconds`.
    pub(super) fn input(&mut self, arena: &Arena, seconds: f64) -> ClimberInput {
        let (life, fighter) = (giant(arena), &arena.fighters()[0]);
        let danger = danger(life);
        let is_attacked = danger == Danger::Attacks;
        self.choose(arena);
        let climber = fighter.climber();
        let shake_ahead = self.eyes.shake_ahead(life, climber);
        let state = climber.state();
        let target = &self.targets[self.at];
        let view = View {
            seconds,
            climber,
            creature: CREATURE,
            surface: life.surface(),
            goal: &target.goal,
            forecast: &self.forecast,
            danger,
            shake_ahead,
        };
        let support = state.support.map(|support| support.attachment.obstacle);
        if support != Some(CREATURE) {
            if let Some(input) = self.crossing.input(climber, seconds, is_attacked) {
                return input;
            }
            if state.mode == ClimberMode::Standing
                && let Some(shot) = self.fencer.shoot(arena, is_attacked)
            {
                return shot;
            }
            return self.bot.input(&view);
        }
        if let Some(stab) = self.fencer.stab(arena, target) {
            return stab;
        }
        let is_there = self.bot.is_there(&view);
        if self.bot.wants_rest(&view) || !is_there {
            return self.bot.input(&view);
        }
        if Some(target.weak_point) == self.highest {
            self.arrived.get_or_insert(seconds);
        }
        if !life.is_open(target.weak_point) || state.shake.length() > STEADY {
            return GRIP;
        }
        match self.fencer.miss(arena, target) {
            Some(miss) => ClimberInput {
                climb: miss.normalize_or_zero(),
                walk: miss,
                ..GRIP
            },
            None => self.bot.input(&view),
        }
    }

    /// Chooses another target if the current one is reached: the nearest by the way from where the climber is.
    fn choose(&mut self, arena: &Arena) {
        let open = self.open(giant(arena));
        if open.contains(&self.at) || open.is_empty() {
            return;
        }
        let support = arena.fighters()[0].climber().state().support;
        let here = support.and_then(|support| {
            let material = support.attachment.material;
            let weights = material.coordinates.map(|weight| weight as f32);
            self.bot.graph().patch_near(material.triangle()?, weights)
        });
        let left = |target: &usize| {
            let goal = &self.targets[*target].goal;
            here.map_or(0.0, |here| goal.least_seconds_from(here))
        };
        let nearest = open.into_iter().min_by(|a, b| left(a).total_cmp(&left(b)));
        self.at = nearest.unwrap_or(0);
        self.bot.forget();
    }

    /// The present targets: open weak points without a whole plate, and plates that cover one. If there are none, those
    /// that are going to be open.
    fn open(&self, life: &clamber_colossus::Creature) -> Vec<usize> {
        let is_whole = |plate: usize| life.state().plate(plate) > 0;
        let is_next = |index: &usize| {
            let target = &self.targets[*index];
            let covers = |other: &Target| {
                other.weak_point == target.weak_point && other.plate.is_some_and(is_whole)
            };
            let is_bare = || !self.targets.iter().any(covers);
            let left = life.state().hit_points().get(target.weak_point);
            left.is_some_and(|left| *left > 0.0) && target.plate.map_or_else(is_bare, is_whole)
        };
        let next: Vec<usize> = (0..self.targets.len()).filter(is_next).collect();
        let is_open = |index: &usize| life.is_open(self.targets[*index].weak_point);
        let open: Vec<usize> = next.iter().copied().filter(is_open).collect();
        if open.is_empty() { next } else { open }
    }
}

/// Position of a weak point at rest, in the units of the creature's file.
fn place(life: &clamber_colossus::Creature, weak_point: usize) -> DVec3 {
    let kind = life.kind();
    let point = &kind.weak_points()[weak_point];
    let palette = kind.skeleton().palette(&kind.skeleton().rest_pose());
    let palette = palette.unwrap_or_default();
    let at = point.position.as_dvec3();
    let frame = palette.model_from_joint(point.joint);
    frame.map_or(DVec3::ZERO, |frame| frame.transform_point3(at))
}

/// For each weak point: the plates that cover it, and itself.
fn targets(life: &clamber_colossus::Creature, graph: &ClimbGraph) -> Vec<Target> {
    let (kind, scale) = (life.kind(), life.scale());
    let size = life.height() / TALL;
    let mut targets = Vec::new();
    for (weak_point, point) in kind.weak_points().iter().enumerate() {
        let place = place(life, weak_point) * scale;
        let is_of = |patch: usize, plate: usize| {
            let triangle = graph.patches()[patch].triangle;
            kind.plates()[plate].triangles.contains(&triangle)
        };
        let plates = 0..kind.plates().len();
        let mut add = |plate: Option<usize>, patches: &[usize]| {
            targets.push(Target {
                weak_point,
                plate,
                goal: graph.goal(patches),
            });
        };
        let over = graph.patches_near(place, COVER * size);
        for plate in plates.clone() {
            let on = over.iter().copied().filter(|patch| is_of(*patch, plate));
            let on: Vec<usize> = on.collect();
            if !on.is_empty() {
                add(Some(plate), &on);
            }
        }
        let reach = f64::from(point.radius) * scale + BESIDE * size;
        let is_skin = |patch: &usize| !plates.clone().any(|plate| is_of(*patch, plate));
        let beside = graph.patches_near(place, reach);
        let beside: Vec<usize> = beside.into_iter().filter(is_skin).collect();
        add(None, &beside);
    }
    targets
}
