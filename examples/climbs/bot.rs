//! A bot climbs a creature by its graph.

use std::error::Error;
use std::sync::Arc;

use clamber::climber::{
    Climber, ClimberConfig, ClimberEvent, ClimberInput, ContactQuery, StepRules,
};
use clamber::mesh::VertexId;
use clamber::rig::Palette;
use clamber::world::{HalfSpace, Obstacle, ObstacleId};
use clamber_navigation::{
    Bot, BotConfig, ClimbGraph, Danger, Footing, Forecast, FutureSkin, Goal, View,
};
use clamber_scenes::Creature;
use clamber_scenes::battle::positive;
use glam::DVec3;

use crate::stage::Stage;

/// How far the bot looks ahead for shakes, and in which steps, seconds.
const LOOKS: f64 = 0.5;
const AHEAD: f64 = 0.1;

const GROUND: ObstacleId = ObstacleId(0);
const CREATURE: ObstacleId = ObstacleId(1);

/// The conditions of a climb.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct ClimbOptions {
    /// Height of every creature.
    #[arg(long, value_name = "METRES", default_value_t = 20.0)]
    #[arg(value_parser = positive, allow_negative_numbers = true)]
    pub(crate) height: f64,

    /// Time that the bot has.
    #[arg(long, value_name = "SECONDS", default_value_t = 120.0)]
    #[arg(value_parser = positive, allow_negative_numbers = true)]
    pub(crate) seconds: f64,

    /// Ticks a second.
    #[arg(long, value_name = "HERTZ", default_value_t = 60.0)]
    #[arg(value_parser = positive, allow_negative_numbers = true)]
    pub(crate) rate: f64,

    /// Each model idles and walks by turns, 30 s each, slowed by Froude's law to its height; with neither it plays what
    /// else it has [default: it stands at rest].
    #[arg(long)]
    pub(crate) moving: bool,

    /// The bot is told what the model is about to do.
    #[arg(long, requires = "moving")]
    pub(crate) forecast: bool,
}

/// How a climb went.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Climbed {
    /// Number of patches of the graph.
    pub(crate) patches: usize,
    /// Share of the skin that is reachable with the strength that a bot counts on.
    pub(crate) reachable: f64,
    /// Height of the highest place that is reachable with that, above the ground, metres; 0 if there is none.
    pub(crate) top: f64,
    /// The least time from the ground to there, seconds.
    pub(crate) least: f64,
    /// When the bot got on, and when it came there, seconds.
    pub(crate) times: [Option<f64>; 2],
    /// How high it came, metres.
    pub(crate) highest: f64,
    /// How often its plan was changed.
    pub(crate) plans: u64,
    /// How often it lost its hold.
    pub(crate) falls: u32,
}

impl Climbed {
    /// How many times the least time from the ground it took after it had got on; `None` if it did not come there.
    pub(crate) fn ratio(&self) -> Option<f64> {
        let [on, there] = self.times;
        Some((there? - on?) / self.least)
    }
}

/// A bot climbs a creature, from the ground to the highest place that the graph calls reachable with its strength. All
/// skin can be gripped.
pub(crate) fn climb_by(
    config: ClimberConfig,
    creature: &Creature,
    options: &ClimbOptions,
) -> Result<Climbed, Box<dyn Error>> {
    let mut stage = Stage::new(creature, options.height, options.moving)?;
    let graph = creature.graph(&config, options.height, stage.rate, &[])?;
    let (mut climbed, goal) = asked(&graph, stage.ground, area(creature, options.height)?);
    let Some((goal, first)) = goal else {
        return Ok(climbed);
    };
    let mut bot = Bot::new(Arc::clone(&graph), BotConfig::default());
    let mut climber = standing(&stage, config, &graph, first)?;
    let mut future = FutureSkin::new(Arc::clone(&creature.rig.collider));
    let tick = 1.0 / options.rate;
    for seconds in (0..(options.seconds * options.rate) as u64).map(|index| index as f64 * tick) {
        stage.advance(seconds)?;
        let forecast = if options.forecast {
            stage.forecast(&graph, seconds)
        } else {
            Forecast::still()
        };
        let mut ahead = |later: f64, palette: &mut Palette| {
            *palette = stage.palette(seconds + later).ok()?;
            Some(stage.place)
        };
        let shake_ahead = if options.moving {
            future.shake_ahead(&climber, CREATURE, &mut ahead, AHEAD, LOOKS)?
        } else {
            0.0
        };
        let view = View {
            seconds,
            climber: &climber,
            creature: CREATURE,
            surface: &stage.surface,
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
        let high = climber.state().position.y - stage.ground;
        climbed.highest = climbed.highest.max(high);
        climbed.plans = bot.plan_count();
        if climbed.times[1].is_some() {
            break;
        }
        climbed.falls += step(&stage, &mut climber, &input, tick)?;
    }
    Ok(climbed)
}

/// Area of a creature's skin at rest when it is so many metres tall, square metres.
fn area(creature: &Creature, height: f64) -> Result<f64, Box<dyn Error>> {
    let (place, _) = creature.standing(height)?;
    let rest = creature.at_rest()?;
    let area = |corners: &[VertexId; 3]| {
        let [a, b, c] = corners.map(|vertex| rest[vertex.index()].as_dvec3() * place.scale);
        0.5 * (b - a).cross(c - a).length()
    };
    Ok(creature.rig.collider.triangles().iter().map(area).sum())
}

/// The graph's figures for a climb to the highest reachable patch, the goal there, and the entry with the shortest way;
/// no goal if no patch is reachable.
fn asked(graph: &ClimbGraph, ground: f64, area: f64) -> (Climbed, Option<(Goal, usize)>) {
    let strength = 1.0 - BotConfig::default().reserve;
    let reached = graph.reachable_with(strength);
    let patches = graph.patches();
    let height = |patch: usize| patches[patch].seat.y - ground;
    let there = || (0..reached.len()).filter(|patch| reached[*patch]);
    let best = there().max_by(|a, b| height(*a).total_cmp(&height(*b)));
    let mut climbed = Climbed {
        patches: patches.len(),
        reachable: there().map(|patch| patches[patch].area).sum::<f64>() / area.max(1e-9),
        top: best.map_or(0.0, height),
        least: f64::INFINITY,
        times: [None; 2],
        highest: 0.0,
        plans: 0,
        falls: 0,
    };
    let Some(best) = best else {
        return (climbed, None);
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
    (climbed, Some((goal, first)))
}

/// A climber on the ground, as near to an entry as it has room.
fn standing(
    stage: &Stage<'_>,
    config: ClimberConfig,
    graph: &ClimbGraph,
    entry: usize,
) -> Result<Climber, Box<dyn Error>> {
    let (patch, radius) = (&graph.patches()[entry], config.body.radius);
    let out = (patch.normal * DVec3::new(1.0, 0.0, 1.0)).normalize_or(DVec3::X);
    let level = patch.seat * DVec3::new(1.0, 0.0, 1.0);
    let surface = stage.surface.in_world();
    let room = |away: &f64| {
        let center = level + out * *away + DVec3::Y * (stage.ground + 1.1 * radius);
        surface.closest_point(center, 1.5 * radius).is_none()
    };
    // Farther and farther out, until there is room.
    let away = |step: u32| 2.5 * radius * f64::from(step);
    let away = (3..60).map(away).find(room).unwrap_or(away(60));
    let feet = level + out * away + DVec3::Y * stage.ground;
    Ok(Climber::new(config, feet + DVec3::Y * (1.1 * radius))?)
}

/// Steps the climber; returns how often it lost its hold.
fn step(
    stage: &Stage<'_>,
    climber: &mut Climber,
    input: &ClimberInput,
    tick: f64,
) -> Result<u32, Box<dyn Error>> {
    let floor = HalfSpace::below(stage.ground);
    let obstacles: [(ObstacleId, &dyn Obstacle); 2] =
        [(GROUND, &floor), (CREATURE, &stage.surface)];
    let rule = |query: &ContactQuery<'_>| query.usual().with_grip(query.id == CREATURE);
    let report = climber.step_with(input, &obstacles, &StepRules::by(&rule), tick)?;
    let lost = |event: &&ClimberEvent| {
        matches!(
            event,
            ClimberEvent::ShakenOff { .. } | ClimberEvent::Thrown { .. } | ClimberEvent::Slipped
        )
    };
    Ok(report.events.iter().filter(lost).count() as u32)
}
