//! Measures building the giant's climb graph, a plan on it, a bot, and predictions.
//!
//! - The graph on one core: built once, and once more read from its file.
//! - Plans to each weak point, from random reachable patches with random stamina. The forecast alternates between 4.5 s
//!   of idling and 4.5 s of shaking. Median and slowest plan.
//! - A bot that climbs the giant at rest: its tick compared with its climber's tick, median and mean. The mean includes
//!   its plans.
//! - Predictions: a ride of ten seconds, and a landing from five metres above the giant.
//!
//! Prints a table and writes it to `target/measure/planning.csv`: name, value, bound, holds.
//!
//! Run it with `cargo bench -p clamber_benches --bench planning`; briefly with `-- --test`.

use std::error::Error;
use std::ops::ControlFlow;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

use clamber::climber::{Climber, ClimberConfig, ClimberInput, ContactQuery, StepRules};
use clamber::geometry::Similarity;
use clamber::rig::{Palette, Playback};
use clamber::surface::SkinnedSurface;
use clamber::world::{HalfSpace, Obstacle, ObstacleId};
use clamber_navigation::{
    Airborne, Bot, BotConfig, ClimbGraph, Danger, Footing, Forecast, FutureSkin, GraphConfig,
    GraphOrigin, Start, View,
};
use clamber_scenes::measure::{Bound, Cells, exit_code, is_brief, quantile};
use clamber_scenes::{Creature, giant};
use fastrand::Rng;
use glam::DVec3;

/// Height of the giant, metres.
const HEIGHT: f64 = 40.0;

/// Length of a tick, seconds.
const TICK: f64 = 1.0 / 60.0;

/// Obstacle id of the ground.
const GROUND: ObstacleId = ObstacleId(0);

/// Obstacle id of the giant.
const GIANT: ObstacleId = ObstacleId(1);

type Failure = Box<dyn Error>;

fn main() -> ExitCode {
    exit_code(run(is_brief()))
}

fn run(brief: bool) -> Result<(), Failure> {
    let mut cells = Cells::default();
    let creature = giant::giant()?;
    let start = Instant::now();
    let graph = creature.graph(&ClimberConfig::colossus_climber(), HEIGHT, 1.0, &[])?;
    let seconds = start.elapsed().as_secs_f64();
    cells.push("the graph of the giant, s", seconds, Bound::Most(20.0));
    cells.value("patches", graph.patches().len() as f64);
    cells.value("jumps", graph.jumps() as f64);
    cells.value("the graph from its file, s", read(&creature)?);
    plans(&creature, &graph, if brief { 10 } else { 500 }, &mut cells)?;
    climb(
        &creature,
        &graph,
        if brief { 300 } else { 3600 },
        &mut cells,
    )?;
    predictions(&creature, if brief { 3 } else { 200 }, &mut cells)?;
    cells.finish("planning", brief)
}

/// The time to read the giant's graph from its cache file, seconds.
fn read(creature: &Creature) -> Result<f64, Failure> {
    let mut config = GraphConfig::new(ClimberConfig::colossus_climber());
    (config.world_from_model, config.ground) = creature.standing(HEIGHT)?;
    let folder = std::env::temp_dir().join("clamber_planning");
    let get = || {
        ClimbGraph::cached(&folder, &creature.rig, &config, |_| {
            ControlFlow::Continue(())
        })
    };
    get()?;
    let start = Instant::now();
    let cached = get()?;
    let seconds = start.elapsed().as_secs_f64();
    std::fs::remove_dir_all(&folder)?;
    match cached.origin {
        GraphOrigin::Read => Ok(seconds),
        other => Err(format!("the graph is not read: {other:?}").into()),
    }
}

fn plans(
    creature: &Creature,
    graph: &ClimbGraph,
    count: usize,
    cells: &mut Cells,
) -> Result<(), Failure> {
    let (place, _) = creature.standing(HEIGHT)?;
    let palette = creature.rest_palette()?;
    let forecast = Forecast::still()
        .then(graph, "idle", 0.0, 4.5)
        .then(graph, "shake", 0.0, 4.5);
    let reachable: Vec<usize> = (0..graph.patches().len())
        .zip(graph.reachable())
        .filter_map(|(patch, is_reachable)| is_reachable.then_some(patch))
        .collect();
    let mut rng = Rng::with_seed(28);
    let (mut goals, mut times, mut found) = (Vec::new(), Vec::new(), 0);
    for point in &creature.rig.weak_points {
        let frame = palette.model_from_joint(point.joint).ok_or("no joint")?;
        let at = place.transform_point(frame.transform_point3(point.position.as_dvec3()));
        let begin = Instant::now();
        let goal = graph.goal(&graph.patches_near(at, 1.5));
        goals.push(begin.elapsed().as_secs_f64() * 1e3);
        for _ in 0..count {
            let patch = reachable[rng.usize(0..reachable.len())];
            let footing = if graph.patches()[patch].can_hold {
                Footing::Holds
            } else {
                Footing::Stands
            };
            let start = Start {
                patch,
                footing,
                seconds: 0.0,
                stamina: rng.f64(),
            };
            let begin = Instant::now();
            let plan = graph.plan(&[start], &goal, &forecast);
            times.push(begin.elapsed().as_secs_f64() * 1e3);
            found += usize::from(plan.is_some());
        }
    }
    cells.value("a goal, median, ms", quantile(&mut goals, 0.5));
    cells.push(
        "a plan, median, ms",
        quantile(&mut times, 0.5),
        Bound::Most(50.0),
    );
    cells.push(
        "a plan, slowest, ms",
        quantile(&mut times, 1.0),
        Bound::Most(50.0),
    );
    cells.value("share of plans found", found as f64 / times.len() as f64);
    Ok(())
}

fn climb(
    creature: &Creature,
    graph: &Arc<ClimbGraph>,
    ticks: u32,
    cells: &mut Cells,
) -> Result<(), Failure> {
    let (place, ground) = creature.standing(HEIGHT)?;
    let floor = HalfSpace::below(ground);
    let mut surface = SkinnedSurface::new(Arc::clone(&creature.rig.collider));
    let top = (0..graph.patches().len()).zip(graph.reachable());
    let top = top.filter_map(|(patch, is_reachable)| is_reachable.then_some(patch));
    let height = |patch: &usize| graph.patches()[*patch].seat.y;
    let top = top.max_by(|a, b| height(a).total_cmp(&height(b)));
    let goal = graph.goal(&[top.ok_or("nothing is reachable")?]);
    let forecast = Forecast::still();
    let mut config = ClimberConfig::colossus_climber();
    config.stamina = None;
    let before = DVec3::new(10.0, ground + config.body.radius + 0.05, 10.0);
    let rule = |query: &ContactQuery<'_>| query.usual().with_grip(query.id == GIANT);
    let mut climber = Climber::new(config, before)?;
    let mut bot = Bot::new(Arc::clone(graph), BotConfig::default());
    let (mut thinks, mut steps) = (Vec::new(), Vec::new());
    for tick in 0..ticks {
        let seconds = f64::from(tick) * TICK;
        surface.advance(&creature.palette("idle", seconds)?, place)?;
        let view = View {
            seconds,
            climber: &climber,
            creature: GIANT,
            surface: &surface,
            goal: &goal,
            forecast: &forecast,
            danger: Danger::None,
            shake_ahead: 0.0,
        };
        if bot.is_there(&view) {
            // The bot has arrived: the climb starts again from the ground.
            climber = Climber::new(config, before)?;
            bot.forget();
            continue;
        }
        let is_on_it = view.is_on_creature();
        let begin = Instant::now();
        let input = bot.input(&view);
        let think = begin.elapsed().as_secs_f64() * 1e6;
        let around: [(ObstacleId, &dyn Obstacle); 2] = [(GROUND, &floor), (GIANT, &surface)];
        let begin = Instant::now();
        climber.step_with(&input, &around, &StepRules::by(&rule), TICK)?;
        let step = begin.elapsed().as_secs_f64() * 1e6;
        if is_on_it {
            thinks.push(think);
            steps.push(step);
        }
    }
    let mean = |times: &[f64]| times.iter().sum::<f64>() / times.len().max(1) as f64;
    let means = [mean(&thinks), mean(&steps)];
    let medians = [quantile(&mut thinks, 0.5), quantile(&mut steps, 0.5)];
    cells.value("a bot's tick, median, us", medians[0]);
    cells.value("its climber's tick, median, us", medians[1]);
    cells.push(
        "bot / climber, medians",
        medians[0] / medians[1],
        Bound::Most(1.0),
    );
    cells.value("bot / climber, means, with its plans", means[0] / means[1]);
    cells.value("plans", bot.plan_count() as f64);
    Ok(())
}

fn predictions(creature: &Creature, count: usize, cells: &mut Cells) -> Result<(), Failure> {
    let (place, _) = creature.standing(HEIGHT)?;
    let clip = creature.rig.clip("breathe");
    let clip = clip.ok_or("the giant has no clip breathe")?;
    let mut pose = creature.rig.skeleton.rest_pose();
    let mut future = |seconds: f64, palette: &mut Palette| -> Option<Similarity> {
        clip.sample_into(seconds, Playback::Loop, &mut pose).ok()?;
        creature.rig.skeleton.palette_into(&pose, palette).ok()?;
        Some(place)
    };
    let mut surface = SkinnedSurface::new(Arc::clone(&creature.rig.collider));
    surface.teleport(&creature.rest_palette()?, place)?;
    let mut skin = FutureSkin::new(Arc::clone(&creature.rig.collider));
    let mut climber = Climber::new(
        ClimberConfig::colossus_climber(),
        DVec3::new(0.0, 41.0, -1.0),
    )?;
    let rule = |query: &ContactQuery<'_>| query.usual().with_grip(true);
    let rules = StepRules::by(&rule);
    let grip = ClimberInput {
        grip: true,
        ..ClimberInput::IDLE
    };
    let flight = Airborne {
        climber: &climber,
        input: &grip,
        rules: &rules,
        creature: GIANT,
        others: &[],
    };
    let mut times = Vec::new();
    for _ in 0..count {
        let begin = Instant::now();
        let landing = skin.landing(&flight, &mut future, TICK, 3.0)?;
        times.push(begin.elapsed().as_secs_f64() * 1e6);
        landing.ok_or("the climber does not come down on the giant")?;
    }
    cells.value("a landing, median, us", quantile(&mut times, 0.5));
    while climber.state().support.is_none() {
        let around: [(ObstacleId, &dyn Obstacle); 1] = [(GIANT, &surface)];
        climber.step_with(&grip, &around, &rules, TICK)?;
    }
    times.clear();
    for _ in 0..count {
        let begin = Instant::now();
        skin.ride(&climber, GIANT, &mut future, TICK, 10.0)?;
        times.push(begin.elapsed().as_secs_f64() * 1e6);
    }
    cells.value("a ride of 10 s, median, us", quantile(&mut times, 0.5));
    Ok(())
}
