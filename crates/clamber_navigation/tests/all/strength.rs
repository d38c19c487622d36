//! A climber that tires: the patches that it reaches, and a bot that does not start a way for which its stamina does
//! not suffice.

#![allow(clippy::unwrap_used, reason = "a test whose body does not fit fails")]

use std::sync::Arc;

use crate::support::{Body, climber, graph_of, skeleton};
use clamber_climber::{Climber, ClimberEvent, ContactQuery, StepRules};
use clamber_navigation::{
    Bot, BotConfig, ClimbGraph, Danger, Forecast, Goal, GraphConfig, Start, View,
};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::SurfaceKind::Fur;
use clamber_surface::rig::{Channel, Clip, Interpolation, JointId, Keyframes, Playback};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{HalfSpace, Obstacle, ObstacleId};
use fastrand::Rng;
use glam::{DVec3, Vec3};

/// Ticks per second.
const RATE: f64 = 60.0;

/// A wall of fur, 6 m wide, from one height to another at `z`. It faces +z.
fn wall(x: f32, from: f32, to: f32, z: f32) -> Body {
    let place = |u: f32, v: f32| Vec3::new(x + 6.0 * (u - 0.5), from + (to - from) * v, z);
    Body::grid([12, (2.0 * (to - from)) as u32], place, |_, _| Fur)
}

/// Horizontal fur behind the top of a wall.
fn top(x: f32, height: f32, from: f32, to: f32) -> Body {
    let place = |u: f32, v: f32| Vec3::new(x + 6.0 * (u - 0.5), height, from + (to - from) * v);
    Body::grid([12, 6], place, |_, _| Fur)
}

/// A wall of 16 m with a step at half of its height, and a horizontal top. The step rises by `rises` times its depth.
fn step_wall(x: f32, deep: f32, rises: f32) -> Body {
    let step = |u: f32, v: f32| Vec3::new(x + 6.0 * (u - 0.5), 8.0 + rises * deep * v, -deep * v);
    wall(x, 0.0, 8.0, 0.0)
        .and(&Body::grid([12, 6], step, |_, _| Fur))
        .and(&wall(x, 8.0 + rises * deep, 16.0, -deep))
        .and(&top(x, 16.0, -deep, -6.0))
}

/// The configuration of a climber that can hold on for this many seconds.
fn lasts(seconds: f64) -> GraphConfig {
    let mut config = climber();
    if let Some(stamina) = &mut config.climber.stamina {
        stamina.hold_drain = 1.0 / seconds;
    }
    config
}

/// The graph of a body with clips.
fn graph(body: &Body, config: &GraphConfig, clips: &[Clip]) -> Arc<ClimbGraph> {
    graph_of(body, config, clips, Similarity::IDENTITY)
}

/// The result of a climb.
#[derive(Debug, Default)]
struct Went {
    /// Time and stamina when the climber was on the body first.
    on: Option<(f64, f64)>,
    there: Option<f64>,
    falls: u32,
}

/// A clip that is played over and over.
#[derive(Clone, Copy, Default)]
struct Played<'a> {
    clip: Option<&'a Clip>,
    /// Before this time the body keeps still, and the bot's forecast is still as well.
    from: f64,
    /// Until this time the bot is told to keep away.
    away_until: f64,
}

impl<'a> From<&'a Clip> for Played<'a> {
    fn from(clip: &'a Clip) -> Self {
        Self {
            clip: Some(clip),
            ..Self::default()
        }
    }
}

/// Lets a bot climb a body that plays a clip, from a place on the ground, with some stamina.
fn climb(
    (body, played): (&Body, Played<'_>),
    graph: &Arc<ClimbGraph>,
    goal: &Goal,
    (from, stamina): (DVec3, f64),
    (begins, lasts): (f64, f64),
) -> Went {
    let skeleton = skeleton();
    let mut surface = SkinnedSurface::new(body.mesh());
    let at = |seconds: f64| played.clip.filter(|_| seconds >= played.from);
    let pose = |seconds: f64| {
        let mut pose = skeleton.rest_pose();
        if let Some(clip) = at(seconds) {
            let time = seconds % clip.duration();
            clip.sample_into(time, Playback::Clamp, &mut pose).unwrap();
        }
        skeleton.palette(&pose).unwrap()
    };
    surface
        .teleport(&pose(begins), Similarity::IDENTITY)
        .unwrap();
    let config = graph.config().climber;
    let radius = config.body.radius;
    let mut who = Climber::new(config, from + DVec3::Y * 1.02 * radius).unwrap();
    let mut state = *who.state();
    state.stamina = stamina;
    who.restore(state).unwrap();
    let mut bot = Bot::new(Arc::clone(graph), BotConfig::default());
    let floor = HalfSpace::below(0.0);
    let rule = |query: &ContactQuery<'_>| query.usual().with_grip(query.id == ObstacleId(1));
    let mut went = Went::default();
    for tick in 0..(lasts * RATE) as u32 {
        let seconds = begins + f64::from(tick) / RATE;
        surface
            .advance(&pose(seconds), Similarity::IDENTITY)
            .unwrap();
        let forecast = at(seconds).map_or_else(Forecast::still, |clip| {
            let length = clip.duration();
            Forecast::still().then(graph, &clip.name, seconds % length, length)
        });
        let view = View {
            seconds,
            climber: &who,
            creature: ObstacleId(1),
            surface: &surface,
            goal,
            forecast: &forecast,
            danger: if seconds < played.away_until {
                Danger::Moves
            } else {
                Danger::None
            },
            shake_ahead: 0.0,
        };
        if view.is_on_creature() {
            went.on.get_or_insert((seconds, who.state().stamina));
        }
        if bot.is_there(&view) {
            went.there = Some(seconds);
            break;
        }
        let input = bot.input(&view);
        let obstacles: [(ObstacleId, &dyn Obstacle); 2] =
            [(ObstacleId(0), &floor), (ObstacleId(1), &surface)];
        let rules = StepRules::by(&rule);
        let report = who
            .step_with(&input, &obstacles, &rules, 1.0 / RATE)
            .unwrap();
        let fell = |event: &&ClimberEvent| {
            matches!(
                event,
                ClimberEvent::ShakenOff { .. }
                    | ClimberEvent::Thrown { .. }
                    | ClimberEvent::Slipped
            )
        };
        went.falls += report.events.iter().filter(fell).count() as u32;
    }
    went
}

fn goal_near(graph: &ClimbGraph, place: DVec3) -> Goal {
    graph.goal(&graph.patches_near(place, 1.0))
}

/// A patch that is reached with some stamina has a plan to it. Plans compare stamina in twelve levels, so one level
/// more is given to the plan.
#[test]
fn what_is_reached_with_some_strength_has_a_plan() {
    let mut rng = Rng::with_seed(53);
    let (mut reached, mut not) = (0, 0);
    for deep in [0.5, 2.0] {
        let graph = graph(&step_wall(0.0, deep, 0.0), &lasts(14.0), &[]);
        for stamina in [0.05, 0.3, 0.5, 0.8, 1.0] {
            let known = graph.reachable_with(stamina);
            let surely = graph.reachable_with(stamina - 1.0 / 11.0);
            let starts: Vec<Start> = graph.starts_on_ground(stamina).collect();
            for _ in 0..100 {
                let patch = rng.usize(0..graph.patches().len());
                let plan = graph.plan(&starts, &graph.goal(&[patch]), &Forecast::still());
                let told = format!("{deep} {stamina} {patch}");
                assert!(known[patch] || plan.is_none(), "{told}");
                assert!(!surely[patch] || plan.is_some(), "{told}");
                reached += u32::from(known[patch]);
                not += u32::from(!known[patch]);
            }
        }
        let tireless = graph.reachable();
        let strong = graph.reachable_with(1.0);
        let both = strong.iter().zip(&tireless);
        assert!(both.clone().all(|(strong, tireless)| *tireless || !strong));
    }
    assert!(reached > 200 && not > 200, "{reached} {not}");
}

/// The bot's stamina is enough for half of the wall. It rests on the step, however narrow that is, and walks on it,
/// although it arrives there holding on.
#[test]
fn a_bot_takes_the_rests_that_it_planned() {
    let config = lasts(9.0);
    for (deep, rises) in [
        (1.0, 0.0),
        (1.5, 0.0),
        (3.0, 0.0),
        (1.5, 0.4),
        (3.0, 0.4),
        (3.0, 0.6),
        (3.0, 0.9),
        (3.0, 1.0),
    ] {
        let body = step_wall(0.0, deep, rises);
        let graph = graph(&body, &config, &[]);
        let goal = goal_near(&graph, DVec3::new(0.0, 16.0, -f64::from(deep) - 1.0));
        let from = (DVec3::new(0.5, 0.0, 3.0), 1.0);
        let went = climb((&body, Played::default()), &graph, &goal, from, (0.0, 60.0));
        assert_eq!(went.falls, 0, "{deep}, {rises}: {went:?}");
        // A bot that also holds on across the step takes 14.6 to 16.6 s.
        let there = went.there.unwrap();
        assert!(there < 14.3, "{deep}, {rises}: {went:?}");
    }
}

/// The nearer wall is too high for the bot's stamina. The other wall has a step.
#[test]
fn a_bot_gets_on_where_its_strength_is_enough() {
    let sheer = wall(0.0, 0.0, 16.0, -1.5);
    let body = step_wall(8.0, 1.5, 0.0)
        .and(&sheer)
        .and(&top(0.0, 16.0, -1.5, -6.0));
    let graph = graph(&body, &lasts(9.0), &[]);
    let tops = [-1.0, 8.0].map(|x| graph.patches_near(DVec3::new(x, 16.0, -3.0), 1.0));
    let goal = graph.goal(&tops.concat());
    let from = (DVec3::new(-1.0, 0.0, 2.0), 1.0);
    let went = climb((&body, Played::default()), &graph, &goal, from, (0.0, 90.0));
    assert!(went.there.is_some() && went.falls == 0, "{went:?}");
}

/// A tired bot refills its stamina on the ground, even if it walks into the wall.
#[test]
fn a_tired_bot_rests_before_it_gets_on() {
    let body = step_wall(0.0, 1.5, 0.0);
    let graph = graph(&body, &climber(), &[]);
    let goal = goal_near(&graph, DVec3::new(0.0, 8.0, -0.7));
    for (stamina, away) in [(0.02, 4.0), (0.3, 2.0), (0.6, 1.0), (0.8, 0.9)] {
        let from = (DVec3::new(0.0, 0.0, away), stamina);
        let went = climb((&body, Played::default()), &graph, &goal, from, (0.0, 60.0));
        let (_, had) = went.on.unwrap();
        assert!(had > 0.85, "{stamina}: {went:?}");
        assert!(went.there.is_some() && went.falls == 0, "{went:?}");
    }
}

/// The time for which [`shakes`] is calm, and then the time for which it shakes, seconds.
const CALM: f64 = 14.0;

/// A clip that shakes half of the time harder than any climber can hold on.
fn shakes() -> Clip {
    let calm = CALM as f32;
    let times: Vec<f32> = (0..=2800).map(|step| step as f32 / 100.0).collect();
    let x = |time: f32| {
        if time < calm {
            0.0
        } else {
            // Up to 60 m/s².
            0.6 * libm::sinf(10.0 * (time - calm)) * (1.0 - libm::expf(-(time - calm)))
        }
    };
    let places = times.iter().map(|time| Vec3::X * x(*time)).collect();
    let channel = Channel::new(
        JointId(0),
        Interpolation::Linear,
        times,
        Keyframes::Translation(places),
    );
    Clip::new("shakes", vec![channel.unwrap()])
}

/// The bot waits for the calm half, whenever it comes.
#[test]
fn a_bot_that_is_told_waits_for_calm() {
    let clip = shakes();
    let body = wall(0.0, 0.0, 8.0, 0.0).and(&top(0.0, 8.0, 0.0, -6.0));
    let graph = graph(&body, &climber(), std::slice::from_ref(&clip));
    let goal = goal_near(&graph, DVec3::new(0.0, 8.0, -1.5));
    for begins in [1.0, 9.0, 12.0, 18.0, 26.0] {
        let from = (DVec3::new(0.3, 0.0, 2.0), 1.0);
        let went = climb(
            (&body, Played::from(&clip)),
            &graph,
            &goal,
            from,
            (begins, 4.0 * CALM),
        );
        assert!(
            went.there.is_some() && went.falls == 0,
            "{begins}: {went:?}"
        );
    }
}

/// Time in which the bot kept away from a creature that walked about or kept still does not count as waiting for calm.
#[test]
fn a_bot_that_had_to_keep_away_waits_all_the_same() {
    let clip = shakes();
    let body = wall(0.0, 0.0, 8.0, 0.0).and(&top(0.0, 8.0, 0.0, -6.0));
    let graph = graph(&body, &climber(), std::slice::from_ref(&clip));
    let goal = goal_near(&graph, DVec3::new(0.0, 8.0, -1.5));
    for from in [0.0, 46.0] {
        let played = Played {
            from,
            // The body shakes at that time, for ten seconds more.
            away_until: 46.0,
            ..Played::from(&clip)
        };
        let start = (DVec3::new(0.3, 0.0, 2.0), 1.0);
        let went = climb((&body, played), &graph, &goal, start, (16.0, 90.0));
        let on = went.on.unwrap().0;
        assert!(on > 55.0 && went.falls == 0, "{from}: {went:?}");
        assert!(went.there.is_some(), "{from}: {went:?}");
    }
}
