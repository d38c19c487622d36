//! Clips at several rates, and bots on skin that moves or is removed.

#![allow(clippy::unwrap_used, reason = "a test whose body does not fit fails")]

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::support::{Body, ball, climber, skeleton};
use clamber_climber::{Climber, ClimberInput, Knockback, StepRules};
use clamber_navigation::{
    Airborne, Bot, BotConfig, ClimbGraph, ClimbReport, Danger, Forecast, FutureSkin, Goal,
    GraphConfig, NavigationError, View,
};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::SurfaceKind::{Fur, Stone};
use clamber_surface::mesh::TriangleId;
use clamber_surface::rig::{Channel, Clip, Interpolation, JointId, Keyframes, Palette};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{HalfSpace, Obstacle, ObstacleId};
use glam::{DVec3, Vec3};

/// A wall of fur with a ledge on top.
fn wall(height: f32) -> Body {
    let front = Body::grid(
        [10, 20],
        |u, v| Vec3::new(4.0 * (u - 0.5), height * v, 0.0),
        |_, _| Fur,
    );
    let top = Body::grid(
        [10, 10],
        |u, v| Vec3::new(4.0 * (u - 0.5), height, -4.0 * v),
        |_, _| Fur,
    );
    front.and(&top)
}

/// A clip that moves everything along x by a function of time.
fn sways(seconds: f32, x: impl Fn(f32) -> f32) -> Clip {
    let times: Vec<f32> = (0..=600).map(|k| seconds * k as f32 / 600.0).collect();
    let places = times.iter().map(|time| Vec3::X * x(*time)).collect();
    let channel = Channel::new(
        JointId(0),
        Interpolation::Linear,
        times,
        Keyframes::Translation(places),
    );
    Clip::new("sways", vec![channel.unwrap()])
}

/// The hardest shake of a clip at a rate.
fn shake(clip: &Clip, rate: f64) -> Result<f64, NavigationError> {
    let mut rig = wall(4.0).rig();
    rig.clips = vec![clip.clone()];
    let config = GraphConfig {
        clip_rate: rate,
        ..climber()
    };
    let (report, _) = ClimbReport::new(&rig, &config, |_| ControlFlow::Continue(()))?;
    Ok(report.clips[0].hardest_shake)
}

#[test]
fn shakes_go_with_the_square_of_the_rate() {
    let clip = sways(2.0, |t| libm::sinf(std::f32::consts::PI * t));
    for rate in [0.25, 0.5, 1.0, 2.0] {
        let found = shake(&clip, rate).unwrap();
        // A climber feels shakes through a first-order low-pass filter. They are stored in steps of 0.25, rounded up.
        let turns = std::f64::consts::PI * rate;
        let smooth = turns * climber().climber.shake_time;
        let wanted = turns * turns / (1.0 + smooth * smooth).sqrt();
        assert!(
            (-0.02 * wanted..0.3).contains(&(found - wanted)),
            "{rate}: {found} for {wanted}"
        );
    }
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-9, 1e9] {
        let found = shake(&clip, wrong);
        let is_rate = matches!(
            found,
            Err(NavigationError::OutOfRange {
                name: "clip_rate",
                ..
            })
        );
        assert!(is_rate, "{wrong}: {found:?}");
    }
}

#[test]
fn the_seam_of_a_loop_is_felt_and_that_of_another_clip_is_not() {
    // This motion reverses abruptly at the seam, and nowhere else.
    let turns_back = sways(2.0, |t| (t - 1.0) * (t - 1.0));
    let found = shake(&turns_back, 1.0).unwrap();
    assert!(found > 15.0, "{found}");
    // This motion has a steady speed, and would jump at a seam.
    let goes_on = sways(2.0, |t| 3.0 * t);
    let found = shake(&goes_on, 1.0).unwrap();
    assert!(found <= 0.25, "{found}");
}

#[test]
fn clips_of_years_are_refused_at_once() {
    for (seconds, rate) in [(1e9, 1.0), (1e5, 1e-3), (1e30, 1.0)] {
        let found = shake(&sways(seconds, |_| 0.0), rate);
        let is_long = matches!(found, Err(NavigationError::TooLong { .. }));
        assert!(is_long, "{seconds} s at {rate}: {found:?}");
    }
}

/// A ball of many times as many triangles has about as many pieces.
#[test]
fn what_is_looked_at_grows_with_the_skin_and_not_with_its_triangles() {
    let round = |cells: [u32; 2]| {
        let place = |u: f32, v: f32| {
            let (a, b) = (u * std::f32::consts::TAU, v * std::f32::consts::PI);
            let out = 6.0 * libm::sinf(b);
            let up = 6.5 - 6.0 * libm::cosf(b);
            Vec3::new(out * libm::cosf(a), up, -out * libm::sinf(a))
        };
        Body::grid(cells, place, |_, _| Fur)
    };
    let built = |cells: [u32; 2]| {
        let mut looked = 0;
        let graph = ClimbGraph::build(&round(cells).rig(), &climber(), |progress| {
            looked = looked.max(progress.of);
            ControlFlow::Continue(())
        });
        let graph = graph.unwrap();
        (looked, graph.patches().len(), graph.ways())
    };
    let coarse = built([60, 30]);
    let fine = built([270, 134]);
    let grows = |fine: usize, coarse: usize| fine as f64 / coarse as f64;
    assert!(grows(fine.0, coarse.0) <= 1.5, "{coarse:?} {fine:?}");
    assert!(grows(fine.1, coarse.1) <= 1.5, "{coarse:?} {fine:?}");
    assert!(grows(fine.2, coarse.2) <= 2.0, "{coarse:?} {fine:?}");
}

/// A bot climbs on a surface above level ground at height 0, at 60 ticks a second. `look` sees each tick after the bot
/// has chosen its input, and ends the run by returning true.
fn climbs(
    (bot, who): (&mut Bot, &mut Climber),
    surface: &SkinnedSurface,
    goal: &Goal,
    ticks: u32,
    mut look: impl FnMut(&Bot, &View<'_>) -> bool,
) {
    let floor = HalfSpace::below(0.0);
    let obstacles: [(ObstacleId, &dyn Obstacle); 2] =
        [(ObstacleId(0), &floor), (ObstacleId(1), surface)];
    for tick in 0..ticks {
        let view = View {
            seconds: f64::from(tick) / 60.0,
            climber: who,
            creature: ObstacleId(1),
            surface,
            goal,
            forecast: &Forecast::still(),
            danger: Danger::None,
            shake_ahead: 0.0,
        };
        let input = bot.input(&view);
        if look(bot, &view) {
            return;
        }
        who.step(&input, &obstacles, 1.0 / 60.0).unwrap();
    }
}

/// Two walls that no way joins: a bot that holds on to one of them and wants to get to the other reports that it is
/// lost, lets go, and goes there.
#[test]
fn who_finds_no_way_says_so_and_tries_another_one() {
    let mut other = wall(8.0);
    other
        .positions
        .iter_mut()
        .for_each(|place| *place += Vec3::X * 12.0);
    let body = wall(8.0).and(&other);
    let (graph, _) = body.report(&climber());
    let surface = body.surface();
    let goal = graph.goal(&graph.patches_near(DVec3::new(12.0, 8.0, -1.0), 1.0));
    let mut bot = Bot::new(Arc::new(graph), BotConfig::default());
    let radius = climber().climber.body.radius;
    let mut who = Climber::new(climber().climber, DVec3::new(0.0, 3.0, 1.02 * radius)).unwrap();
    let (mut lost, mut there) = (None, None);
    climbs((&mut bot, &mut who), &surface, &goal, 2400, |bot, view| {
        if bot.is_lost(view.seconds) {
            lost.get_or_insert(view.seconds);
        }
        there = bot.is_there(view).then_some(view.seconds);
        there.is_some()
    });
    let lost = lost.expect("it never says so");
    assert!((3.0..4.5).contains(&lost), "{lost}");
    assert!(there.is_some(), "{:?}", who.state());
}

/// Removed skin, such as a plate that was shot off, is no way: a bot without another way reports that it is lost.
#[test]
fn a_way_over_skin_that_is_gone_is_none() {
    for gone in [false, true] {
        let body = wall(8.0);
        let (graph, _) = body.report(&climber());
        let mut surface = body.surface();
        let goal = graph.goal(&graph.patches_near(DVec3::new(0.0, 7.0, 0.0), 1.0));
        if gone {
            for (index, corners) in body.triangles.iter().enumerate() {
                let mut heights = corners.iter().map(|c| body.positions[*c as usize].y);
                if heights.all(|y| (4.0..6.5).contains(&y)) {
                    surface.disable_triangle(TriangleId(index as u32)).unwrap();
                }
            }
        }
        let mut bot = Bot::new(Arc::new(graph), BotConfig::default());
        let radius = climber().climber.body.radius;
        let mut who = Climber::new(climber().climber, DVec3::new(0.0, 2.0, 1.02 * radius)).unwrap();
        let (mut lost, mut there) = (None, None);
        climbs((&mut bot, &mut who), &surface, &goal, 1200, |bot, view| {
            if bot.is_there(view) {
                there.get_or_insert(view.seconds);
            }
            if bot.is_lost(view.seconds) {
                lost.get_or_insert(view.seconds);
            }
            false
        });
        assert_eq!(
            [lost.is_some(), there.is_some()],
            [gone, !gone],
            "{lost:?} {there:?}"
        );
    }
}

/// The graph has no patch on a ball of stone. A bot whose climber is put there says that it is lost, and gets off.
#[test]
fn who_is_where_the_graph_knows_no_place_says_so_and_gets_off() {
    let stone = ball(Vec3::new(0.0, 30.0, 0.0), 12.0, |_, _| Stone);
    let body = wall(8.0).and(&stone);
    let mut config = climber();
    config.climber.ground.max_slope = 0.02;
    let go_on = |_| ControlFlow::Continue(());
    let graph = ClimbGraph::build(&body.rig(), &config, go_on);
    let graph = graph.unwrap();
    let surface = body.surface();
    let goal = graph.goal(&graph.patches_near(DVec3::new(0.0, 7.0, 0.0), 1.0));
    assert!(!goal.patches().is_empty());
    let mut bot = Bot::new(Arc::new(graph), BotConfig::default());
    let radius = climber().climber.body.radius;
    let mut who = Climber::new(climber().climber, DVec3::new(8.0, 39.3 + radius, 0.0)).unwrap();
    let (mut strays, mut lost, mut off) = (None, None, None);
    climbs((&mut bot, &mut who), &surface, &goal, 1800, |bot, view| {
        if view.is_on_creature() {
            if strays.is_none() {
                // A bot that is asked again after a long pause has not been lost all the time.
                let seconds = view.seconds + 20.0;
                let mut later = bot.clone();
                later.input(&View { seconds, ..*view });
                assert!(!later.is_lost(seconds));
            }
            strays.get_or_insert(view.seconds);
        } else if lost.is_some() {
            off.get_or_insert(view.seconds);
        }
        if bot.is_lost(view.seconds) {
            lost.get_or_insert(view.seconds);
        }
        false
    });
    let strays = strays.expect("it is never on the ball");
    let lost: f64 = lost.expect("it never says so");
    assert!((2.9..4.5).contains(&(lost - strays)), "{strays} {lost}");
    assert!(off.is_some(), "{:?}", who.state());
    assert!(!bot.is_lost(30.0));
}

/// No landing is predicted on triangles that were disabled.
#[test]
fn a_landing_is_foreseen_on_the_skin_that_is_left() {
    let body = wall(8.0);
    let radius = climber().climber.body.radius;
    let who = Climber::new(climber().climber, DVec3::new(0.0, 9.0 + radius, -2.0)).unwrap();
    let floor = HalfSpace::below(0.0);
    let others: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &floor)];
    let flight = Airborne {
        climber: &who,
        input: &ClimberInput::IDLE,
        rules: &StepRules::default(),
        creature: ObstacleId(1),
        others: &others,
    };
    let skeleton = skeleton();
    let palette = skeleton.palette(&skeleton.rest_pose()).unwrap();
    let mut rests = |_: f64, out: &mut Palette| {
        out.clone_from(&palette);
        Some(Similarity::IDENTITY)
    };
    let mut skin = FutureSkin::new(body.mesh());
    let mut lands = |skin: &mut FutureSkin| {
        let landing = skin.landing(&flight, &mut rests, 1.0 / 60.0, 3.0).unwrap();
        landing.unwrap().state.position.y - radius
    };
    assert!((lands(&mut skin) - 8.0).abs() < 0.1);
    let mut gone = skin.clone();
    for triangle in 0..body.triangles.len() as u32 {
        gone.disable_triangle(TriangleId(triangle)).unwrap();
    }
    assert!(lands(&mut gone).abs() < 0.1);
    for triangle in 0..body.triangles.len() as u32 {
        gone.enable_triangle(TriangleId(triangle)).unwrap();
    }
    assert!((lands(&mut gone) - 8.0).abs() < 0.1);

    // A blow of this tick has thrown the climber already: the prediction does not throw it again.
    let blow = Knockback {
        velocity: DVec3::new(60.0, 20.0, 0.0),
        ..Knockback::default()
    };
    let struck = StepRules {
        knockback: Some(blow),
        ..StepRules::default()
    };
    let flight = Airborne {
        rules: &struck,
        ..flight
    };
    let landing = skin.landing(&flight, &mut rests, 1.0 / 60.0, 3.0).unwrap();
    assert!((landing.unwrap().state.position.y - radius - 8.0).abs() < 0.1);
}
