//! Jumps from one part of a creature to another: a bot with a forecast lands each planned jump.

#![allow(clippy::unwrap_used, reason = "a test whose body does not fit fails")]

use std::sync::Arc;

use crate::support::{Body, climber, graph_of, two_joints};
use clamber_climber::{Climber, ClimberState, ContactQuery, StepRules};
use clamber_navigation::{
    Bot, BotConfig, ClimbGraph, Danger, Footing, Forecast, Goal, GraphConfig, Start, View,
};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::SurfaceKind::{self, Fur, Skin};
use clamber_surface::rig::{Channel, Clip, Interpolation, JointId, Keyframes, Playback};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{HalfSpace, Obstacle, ObstacleId};
use fastrand::Rng;
use glam::{DVec3, Vec3};

/// Ticks per second, for a climber of the usual size.
const RATE: f64 = 60.0;

/// A block of 4 m by 4 m between two heights, which begins at `x`.
fn block(x: f32, [top, bottom]: [f32; 2], kind: SurfaceKind) -> Body {
    let side = 4.0;
    let level = |u: f32, v: f32| Vec3::new(x + side * u, top, side * (0.5 - v));
    let mut block = Body::grid([8, 8], level, |_, _| kind);
    for (near, face) in [(true, 0), (false, 0), (true, 1), (false, 1)] {
        let wall = move |u: f32, v: f32| {
            let height = bottom + (top - bottom) * v;
            let (u, z) = if near { (1.0 - u, 0.0) } else { (u, 1.0) };
            if face == 0 {
                Vec3::new(x + side * (1.0 - u), height, side * (z - 0.5))
            } else {
                Vec3::new(x + side * z, height, side * (u - 0.5))
            }
        };
        let rows = (2.0 * (top - bottom)).ceil() as u32;
        block = block.and(&Body::grid([8, rows], wall, |_, _| kind));
    }
    block
}

/// Two blocks with a gap between them. The top of the second one is higher by `rise`. The second one cannot be reached
/// from the ground.
fn blocks(gap: f32, rise: f32, [first, second]: [SurfaceKind; 2]) -> Body {
    let other = [6.0 + rise, 5.0 + rise.min(0.0)];
    block(-4.0, [6.0, 0.0], first).and_on_its_own(&block(gap, other, second))
}

/// The transform of blocks and a climber that are `size` times as large as usual.
fn place(size: f64) -> Similarity {
    Similarity {
        scale: size,
        ..Similarity::IDENTITY
    }
}

/// The graph of blocks with clips, for a climber of their size.
fn graph(body: &Body, size: f64, clips: &[Clip]) -> Arc<ClimbGraph> {
    let config = GraphConfig::new(climber().climber.scaled(size));
    graph_of(body, &config, clips, place(size))
}

/// The goal on top of the second block.
fn goal(graph: &ClimbGraph, size: f64, gap: f32) -> Goal {
    let is_on_it = |patch: &usize| {
        let patch = &graph.patches()[*patch];
        patch.can_stand && patch.point.x > size * (f64::from(gap) + 1.0)
    };
    let patches: Vec<usize> = (0..graph.patches().len()).filter(is_on_it).collect();
    graph.goal(&patches)
}

/// A start in the middle of the first block.
fn start(graph: &ClimbGraph, size: f64) -> Start {
    let near = graph.patches_near(DVec3::new(-2.0, 6.0, 0.0) * size, 0.5 * size);
    Start {
        patch: near[0],
        footing: Footing::Stands,
        seconds: 0.0,
        stamina: 1.0,
    }
}

/// The result of a bot's try to cross.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Went {
    Across,
    Nowhere,
    /// The bot found no way, reported it, and got off.
    Back,
    Down,
}

/// The motion of the blocks: clips, each with its seconds, over and over; the time at which they begin; and whether the
/// bot gets a forecast of them.
#[derive(Clone, Copy)]
struct Moves<'a> {
    clips: &'a [(&'a Clip, f64)],
    begins: f64,
    told: bool,
}

impl Moves<'_> {
    /// The clip that plays at a time, the time in it, and the seconds for which it still plays.
    fn at(&self, seconds: f64) -> (usize, f64, f64) {
        let all: f64 = self.clips.iter().map(|(_, lasts)| lasts).sum();
        let mut time = (self.begins + seconds) % all;
        for (index, (_, lasts)) in self.clips.iter().enumerate() {
            if time < *lasts {
                return (index, time, lasts - time);
            }
            time -= lasts;
        }
        (0, 0.0, self.clips[0].1)
    }

    fn forecast(&self, graph: &ClimbGraph, seconds: f64) -> Forecast {
        let (index, time, left) = self.at(seconds);
        let now = self.clips[index];
        let mut forecast = Forecast::still().then(graph, &now.0.name, time, left);
        for after in 1..self.clips.len() {
            let (clip, lasts) = self.clips[(index + after) % self.clips.len()];
            forecast = forecast.then(graph, &clip.name, 0.0, lasts);
        }
        forecast
    }
}

/// Lets a bot try to cross to the second block.
fn crosses(
    (body, size): (&Body, f64),
    graph: &Arc<ClimbGraph>,
    goal: &Goal,
    moves: Option<Moves<'_>>,
    (from, stamina): (DVec3, f64),
) -> Went {
    let skeleton = two_joints();
    let mut surface = SkinnedSurface::new(body.mesh());
    let pose = |seconds: f64| {
        let mut pose = skeleton.rest_pose();
        if let Some(moves) = moves {
            let (index, time, _) = moves.at(seconds);
            let clip = moves.clips[index].0;
            clip.sample_into(time, Playback::Loop, &mut pose).unwrap();
        }
        skeleton.palette(&pose).unwrap()
    };
    surface.teleport(&pose(0.0), place(size)).unwrap();
    let config = graph.config().climber;
    let feet = DVec3::Y * 1.02 * config.body.radius;
    let mut who = Climber::new(config, from * size + feet).unwrap();
    let state = *who.state();
    who.restore(ClimberState { stamina, ..state }).unwrap();
    let mut bot = Bot::new(Arc::clone(graph), BotConfig::default());
    let mut was_lost = false;
    let floor = HalfSpace::below(0.0);
    let can_grip = |query: &ContactQuery<'_>| {
        query
            .usual()
            .with_grip(graph.config().can_grip(&query.tag()))
    };
    let dt = size.sqrt() / RATE;
    for tick in 0..(30.0 * RATE) as u32 {
        let seconds = f64::from(tick) * dt;
        surface.advance(&pose(seconds), place(size)).unwrap();
        let told = moves.filter(|moves| moves.told);
        let forecast = told.map_or_else(Forecast::still, |moves| moves.forecast(graph, seconds));
        let view = View {
            seconds,
            climber: &who,
            creature: ObstacleId(1),
            surface: &surface,
            goal,
            forecast: &forecast,
            danger: Danger::None,
            shake_ahead: 0.0,
        };
        if bot.is_there(&view) {
            return Went::Across;
        }
        let input = bot.input(&view);
        was_lost |= bot.is_lost(seconds);
        let obstacles: [(ObstacleId, &dyn Obstacle); 2] =
            [(ObstacleId(0), &floor), (ObstacleId(1), &surface)];
        let rules = StepRules::by(&can_grip);
        who.step_with(&input, &obstacles, &rules, dt).unwrap();
        if who.state().position.y < 2.0 * size {
            return if was_lost { Went::Back } else { Went::Down };
        }
    }
    Went::Nowhere
}

/// A bot crosses every gap for which the graph has a plan, from any place. Gaps within a standing jump have a plan, and
/// gaps out of reach have none.
#[test]
fn gaps_and_ledges_are_crossed_where_the_graph_says_so() {
    let mut rng = Rng::with_seed(19);
    let (mut crossed, mut not) = (0, 0);
    for case in 0..80 {
        let (gap, rise) = (0.9 + 3.6 * rng.f32(), -2.5 + 5.5 * rng.f32());
        let kind = [0; 2].map(|_| if rng.bool() { Skin } else { Fur });
        let size = [0.25, 1.0, 4.0][rng.usize(0..3)];
        let told = format!("case {case}: {gap} m, {rise} m up, {kind:?}, {size} times");
        let body = blocks(gap, rise, kind);
        let graph = graph(&body, size, &[]);
        let goal = goal(&graph, size, gap);
        let plan = graph.plan(&[start(&graph, size)], &goal, &Forecast::still());
        if gap < 1.8 && (-1.0..0.8).contains(&rise) {
            assert!(plan.is_some(), "{told}");
        }
        // A jump rises 1.3 m and goes 3.1 m far, and hands reach up to a ledge.
        if gap > 3.9 && rise > -0.5 || rise > 2.6 {
            assert!(plan.is_none(), "{told}");
            not += 1;
        }
        let Some(plan) = plan else {
            continue;
        };
        assert!(plan.steps.iter().any(|step| step.jumps), "{told}");
        assert!(graph.jumps() > 0);
        crossed += 1;
        for _ in 0..3 {
            let aside = 3.0 * (rng.f64() - 0.5);
            let from = DVec3::new(-3.0 + 2.5 * rng.f64(), 6.0, aside);
            let went = crosses((&body, size), &graph, &goal, None, (from, 1.0));
            assert_eq!(went, Went::Across, "{told}, from {from}");
        }
    }
    assert!(crossed > 25 && not > 5, "{crossed} {not}");
}

/// A jump that needs no hands is possible without stamina, also for a climber that never rests.
#[test]
fn who_has_no_strength_left_jumps() {
    let body = blocks(1.6, -1.0, [Skin, Skin]);
    for refill in [0.0, 0.1] {
        let mut config = climber();
        config.climber.stamina.as_mut().unwrap().refill = refill;
        let graph = graph_of(&body, &config, &[], place(1.0));
        let goal = goal(&graph, 1.0, 1.6);
        let from = DVec3::new(-2.0, 6.0, 0.0);
        let went = crosses((&body, 1.0), &graph, &goal, None, (from, 0.0));
        assert_eq!(went, Went::Across, "{refill}");
    }
}

/// A clip in which a joint moves to another place and back.
fn sways(name: &str, joint: u32, by: Vec3, seconds: f32) -> Clip {
    let times: Vec<f32> = (0..=60).map(|step| seconds * step as f32 / 60.0).collect();
    let share = |time: f32| 0.5 - 0.5 * libm::cosf(std::f32::consts::TAU * time / seconds);
    let places = times.iter().map(|time| by * share(*time)).collect();
    let channel = Channel::new(
        JointId(joint),
        Interpolation::Linear,
        times,
        Keyframes::Translation(places),
    );
    Clip::new(name, vec![channel.unwrap()])
}

/// No plan jumps to a block while it moves away. Blocks that sway have plans at all times, and the bot lands on them.
#[test]
fn jumps_are_planned_in_clips_in_which_they_always_land() {
    let gap = 1.6;
    let from = DVec3::new(-1.0, 6.0, 0.0);
    // A clip that ends with a joint in another place must not affect the next clip.
    let times = vec![0.0, 4.0];
    let places = Keyframes::Translation(vec![Vec3::ZERO, Vec3::Y * 6.0]);
    let channel = Channel::new(JointId(1), Interpolation::Linear, times, places);
    let leaves = Clip::new("leaves", vec![channel.unwrap()]);
    let clips = [
        sways("away", 1, Vec3::X * 8.0, 6.0),
        leaves,
        sways("nods", 0, Vec3::Y * 0.2, 3.0),
        sways("sways", 1, Vec3::new(0.3, 0.2, 0.4), 4.0),
        sways("rises", 1, Vec3::Y * 0.8, 5.0),
    ];
    let [away, _, nodding, swaying, rising] = &clips;
    for kind in [[Skin, Skin], [Skin, Fur], [Fur, Fur]] {
        let body = blocks(gap, 0.0, kind);
        let graph = graph(&body, 1.0, &clips);
        let goal = goal(&graph, 1.0, gap);
        let plan = |forecast: &Forecast| graph.plan(&[start(&graph, 1.0)], &goal, forecast);
        assert!(plan(&Forecast::still()).is_some());
        let forecast =
            |name: &str, seconds: f64| Forecast::still().then(&graph, name, 0.0, seconds);
        assert!(plan(&forecast("away", 6.0)).is_none(), "{kind:?}");
        // The plan waits until the clip `away` is over.
        let later = plan(&forecast("away", 6.0).then(&graph, "sways", 0.0, 4.0)).unwrap();
        let jump = later.steps.iter().position(|step| step.jumps).unwrap();
        assert!(later.steps[jump].seconds > 6.0, "{kind:?}");
        for clip in [swaying, rising, nodding] {
            let lasts = clip.duration();
            assert!(plan(&forecast(&clip.name, lasts)).is_some());
            for phase in 0..16 {
                let moves = Moves {
                    clips: &[(clip, lasts)],
                    begins: lasts * f64::from(phase) / 16.0,
                    told: true,
                };
                let went = crosses((&body, 1.0), &graph, &goal, Some(moves), (from, 1.0));
                assert_eq!(went, Went::Across, "{kind:?} {} {phase}", clip.name);
            }
        }
        for phase in 0..32 {
            let share = f64::from(phase) / 32.0;
            let both = Moves {
                clips: &[(away, 6.0), (swaying, 4.0)],
                begins: 10.0 * share,
                told: true,
            };
            let went = crosses((&body, 1.0), &graph, &goal, Some(both), (from, 1.0));
            assert_eq!(went, Went::Across, "{kind:?} {phase}, in turns");
            // A bot never jumps to the block that moves away, with a forecast or without.
            for told in [true, false] {
                let moves = Moves {
                    clips: &[(away, 6.0)],
                    begins: 6.0 * share,
                    told,
                };
                let went = crosses((&body, 1.0), &graph, &goal, Some(moves), (from, 1.0));
                assert_ne!(went, Went::Down, "{kind:?} {phase}, told: {told}");
                assert!(!told || went == Went::Back, "{kind:?} {phase}: {went:?}");
            }
        }
    }
}

/// Loops of any length: of a few ticks, of one pose, and of lengths that are no multiples of half a second.
#[test]
fn jumps_land_in_loops_of_any_length() {
    let gap = 1.6;
    let body = blocks(gap, 0.0, [Skin, Fur]);
    for seconds in [0.0, 0.01, 0.05, 0.3, 0.7, 1.2, 1.7, 2.2] {
        let clip = if seconds > 0.0 {
            sways("sways", 1, Vec3::new(0.02, 0.01, 0.02) * seconds, seconds)
        } else {
            let places = Keyframes::Translation(vec![Vec3::Z * 0.01]);
            let channel = Channel::new(JointId(1), Interpolation::Linear, vec![0.0], places);
            Clip::new("sways", vec![channel.unwrap()])
        };
        let lasts = clip.duration();
        let graph = graph(&body, 1.0, std::slice::from_ref(&clip));
        let goal = goal(&graph, 1.0, gap);
        for expected in [lasts.max(0.1), 2.0 * lasts + 0.1, 60.0] {
            let forecast = Forecast::still().then(&graph, "sways", 0.0, expected);
            let plan = graph.plan(&[start(&graph, 1.0)], &goal, &forecast);
            assert!(plan.is_some(), "{seconds} s, for {expected} s");
        }
        for phase in (0..8).filter(|_| lasts > 0.0) {
            let moves = Moves {
                clips: &[(&clip, lasts)],
                begins: lasts * f64::from(phase) / 8.0,
                told: true,
            };
            let from = (DVec3::new(-1.0, 6.0, 0.0), 1.0);
            let went = crosses((&body, 1.0), &graph, &goal, Some(moves), from);
            assert_eq!(went, Went::Across, "{seconds} s, {phase}");
        }
    }
    // What ends elsewhere, however short, is no loop.
    for seconds in [0.01, 0.04] {
        let places = Keyframes::Translation(vec![Vec3::ZERO, Vec3::X]);
        let channel = Channel::new(
            JointId(1),
            Interpolation::Linear,
            vec![0.0, seconds],
            places,
        );
        let clip = Clip::new("leaves", vec![channel.unwrap()]);
        let graph = graph(&body, 1.0, &[clip]);
        let forecast = Forecast::still().then(&graph, "leaves", 0.0, 10.0);
        let plan = graph.plan(&[start(&graph, 1.0)], &goal(&graph, 1.0, gap), &forecast);
        assert!(plan.is_none(), "{seconds} s");
    }
}
