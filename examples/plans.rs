//! A bot climbs a breathing giant to the highest reachable place, by inputs alone, and predicts when a shake would
//! throw it off.
//!
//! The graph is built on a thread of its own, and kept in `target/plans`: the second start takes a tenth of a second.

use std::error::Error;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::mpsc::channel;

use clamber::climber::ContactQuery;
use clamber::glam::DVec3;
use clamber::gltf::{LoadOptions, load_with};
use clamber::navigation::{
    Bot, BotConfig, ClimbGraph, Danger, Forecast, FutureSkin, GraphConfig, View,
};
use clamber::prelude::*;
use clamber::world::HalfSpace;

type Failure = Box<dyn Error + Send + Sync>;

/// Length of a tick, seconds.
const TICK: f64 = 1.0 / 60.0;
/// Id of the ground.
const GROUND: ObstacleId = ObstacleId(0);
/// Id of the giant.
const GIANT: ObstacleId = ObstacleId(1);

fn main() -> Result<(), Failure> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/colossus.glb");
    let rig = Arc::new(load_with(file, &LoadOptions::default().with_height(40.0))?.rig);
    let mut config = GraphConfig::new(ClimberConfig::colossus_climber());
    config.grips = vec![SurfaceKind::Fur, SurfaceKind::Stone];
    let graph = graph(&rig, &config)?;
    println!("{} patches", graph.patches().len());

    // The goal is the highest patch that is reachable from the ground.
    let reachable = graph.reachable();
    let height = |patch: &usize| graph.patches()[*patch].seat.y;
    let all = (0..reachable.len()).filter(|patch| reachable[*patch]);
    let top = all.max_by(|a, b| height(a).total_cmp(&height(b)));
    let goal = graph.goal(&[top.ok_or("nothing can be reached")?]);

    let ground = HalfSpace::below(0.0);
    let mut giant = SkinnedSurface::new(Arc::clone(&rig.collider));
    let mut climber = Climber::new(config.climber, DVec3::new(5.0, 0.4, 30.0))?;
    let mut bot = Bot::new(Arc::clone(&graph), BotConfig::default());
    let mut skin = FutureSkin::new(Arc::clone(&rig.collider));
    // The climber grips the surfaces that the graph counts as holds.
    let rule = |query: &ContactQuery<'_>| query.usual().with_grip(config.can_grip(&query.tag()));
    let rules = StepRules::by(&rule);
    let idle = rig.clip("idle").ok_or("no clip idle")?.duration();
    let mut palette = Palette::default();
    let mut arrived = None;
    for tick in 0..60 * 120 {
        // First the giant moves, then the climber.
        let now = f64::from(tick) * TICK;
        pose(&rig, now, None, &mut palette)?;
        giant.advance(&palette, Similarity::IDENTITY)?;
        // The bot looks half a second ahead.
        let mut ahead = |seconds: f64, palette: &mut Palette| {
            let known = pose(&rig, now + seconds, None, palette);
            known.ok().map(|()| Similarity::IDENTITY)
        };
        let view = View {
            seconds: now,
            climber: &climber,
            creature: GIANT,
            surface: &giant,
            goal: &goal,
            // The giant's clip from now on.
            forecast: &Forecast::still().then(&graph, "idle", now % idle, idle),
            danger: Danger::None,
            shake_ahead: skin.shake_ahead(&climber, GIANT, &mut ahead, 0.1, 0.5)?,
        };
        if bot.is_there(&view) {
            arrived = Some(now);
            break;
        }
        let input = bot.input(&view);
        let around: [(ObstacleId, &dyn Obstacle); 2] = [(GROUND, &ground), (GIANT, &giant)];
        climber.step_with(&input, &around, &rules, TICK)?;
    }
    let arrived = arrived.ok_or("it did not come there within two minutes")?;
    println!("on top after {arrived:.1} s, {} plans", bot.plan_count());

    // Predicts the ride if the giant began to shake now.
    let mut shaking = |seconds: f64, palette: &mut Palette| {
        let known = pose(&rig, arrived + seconds, Some(seconds), palette);
        known.ok().map(|()| Similarity::IDENTITY)
    };
    let ride = skin.ride(&climber, GIANT, &mut shaking, TICK, 10.0)?;
    println!("in a shake: {ride:?}");
    Ok(())
}

/// The giant's graph, from its file if the file exists.
fn graph(rig: &Arc<Rig>, config: &GraphConfig) -> Result<Arc<ClimbGraph>, Failure> {
    let (rig, config) = (Arc::clone(rig), config.clone());
    let (tell, told) = channel();
    let build = std::thread::spawn(move || {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/target/plans");
        ClimbGraph::cached(folder.as_ref(), &rig, &config, |progress| {
            // A receiver that has been dropped cancels the build.
            match tell.send(progress) {
                Ok(()) => ControlFlow::Continue(()),
                Err(_) => ControlFlow::Break(()),
            }
        })
    });
    let mut stage = None;
    for progress in told {
        if stage.replace(progress.stage) != Some(progress.stage) {
            println!(
                "builds the graph: {:?}, {} steps",
                progress.stage, progress.of
            );
        }
    }
    let cached = build.join().map_err(|_| "the build panicked")??;
    println!("the graph: {:?}", cached.origin);
    Ok(Arc::new(cached.graph))
}

/// The palette of the breathing giant. With `shakes_for`, it has also shaken for this time, seconds; the shake fades in
/// over half a second.
fn pose(
    rig: &Rig,
    seconds: f64,
    shakes_for: Option<f64>,
    palette: &mut Palette,
) -> Result<(), Failure> {
    let rest = rig.skeleton.rest_pose();
    let idle = rig.clip("idle").ok_or("no clip idle")?;
    let mut pose = idle.sample(&rest, seconds, Playback::Loop)?;
    if let Some(shaken) = shakes_for {
        let shake = rig.clip("shake").ok_or("no clip shake")?;
        let shake = shake.sample(&rest, shaken, Playback::Clamp)?;
        pose = pose.blend(&shake, (shaken / 0.5).min(1.0))?;
    }
    rig.skeleton.palette_into(&pose, palette)?;
    Ok(())
}
