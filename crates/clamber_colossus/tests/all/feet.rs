//! Feet on rough ground: scenes B44 and B45.

use crate::support;

use std::sync::Arc;

use crate::support::{
    Feel, Sole, TICK, add_block, ground, joint_place as place, on_terrain, sole, strew_boulders,
    terrain_of,
};
use clamber_animation::{PoseBuffers, joint_in_model};
use clamber_colossus::{Creature, CreatureConfig, CreatureKind};
use clamber_surface::mesh::VertexId;
use clamber_world::rapier3d::prelude::PhysicsWorld;
use clamber_world::{Obstacle, RapierTerrain};
use glam::DVec3;

/// States in which the giant rests and walks about, as JSON.
const WALKS: &str = r#"{
    "rests": { "act": { "play": "idle" }, "transitions": [{ "to": "roams", "after": 3 }] },
    "roams": { "act": { "walk": { "to": "patrol", "within": 10 } }, "transitions": [
      { "to": "rests", "when": ["done"] }, { "to": "rests", "after": 25 }
    ] }
}"#;

/// Number of ticks after which a foot that came down counts as settled.
const SETTLED: usize = 30;

#[derive(Debug, Default)]
struct Figures {
    walked: f64,
    plants: usize,
    /// Largest height of a settled sole's lowest skin above the ground, metres.
    gap: f64,
    /// Largest depth of a settled sole's lowest skin in the ground, metres.
    depth: f64,
    /// Largest distance that the ball of a settled foot moves, metres.
    drift: f64,
    /// Largest felt acceleration that the feet add to the clip at the hips, m/s^2.
    hips: f64,
    /// Largest felt acceleration that the feet add to the clip at the head, m/s^2.
    head: f64,
    /// Largest felt acceleration that the feet add at swinging toes, m/s^2.
    toes: f64,
    /// Share of the ticks of swinging toes in which that is above 6 m/s^2.
    jerks: f64,
    /// Length of the foot, metres.
    foot: f64,
}

fn walk(world: &PhysicsWorld, config: CreatureConfig, seconds: f64) -> Figures {
    let file = support::brain_with("rests", WALKS);
    let kind = support::kind(&file);
    let mut giant = support::creature(&kind, config);
    let (mut clip_pose, mut buffers) = (kind.skeleton().rest_pose(), PoseBuffers::default());
    let terrain = terrain_of(world);
    let all: [&dyn Obstacle; 1] = [&terrain];
    let around = on_terrain(&all);
    let find = |name| kind.skeleton().find(name).unwrap();
    let soles = ["foot.L", "foot.R"].map(|name| sole(&kind, name));
    let watched = ["pelvis", "head", "toe.L", "toe.R"].map(find);
    let mut figures = Figures {
        foot: soles[0].length,
        ..Figures::default()
    };
    let mut feels = [Feel::default(); 6];
    let mut stands: [Option<(usize, DVec3)>; 2] = [None; 2];
    let mut skin = Vec::new();
    let mut swings = 0.0;
    for tick in 0..(seconds / TICK) as usize {
        let from = giant.state().position();
        giant.step(&around).unwrap();
        figures.walked += (giant.state().position() - from).with_y(0.0).length();
        let animator = giant.state().animator();
        animator
            .pose_into(kind.clips(), &mut clip_pose, &mut buffers)
            .unwrap();
        let height = DVec3::Y * giant.state().position().y;
        let added = watched.map(|joint| {
            let frame = joint_in_model(kind.skeleton(), &clip_pose, joint).unwrap();
            let world = giant.surface().world_from_model();
            place(&giant, joint) - world.transform_point(frame.translation) + height
        });
        let mut felt: Vec<f64> = (0..2).map(|at| feels[at].step(added[at])).collect();
        // A foot need not follow its clip, so the smaller one counts: the added acceleration or the foot's own.
        for foot in 2..4 {
            let over_clip = feels[foot].raw(added[foot]);
            let all = feels[2 + foot].raw(place(&giant, watched[foot]));
            let less = if all.length() < over_clip.length() {
                all
            } else {
                over_clip
            };
            felt.push(feels[foot].filter(less));
        }
        if tick > 120 {
            figures.hips = figures.hips.max(felt[0]);
            figures.head = figures.head.max(felt[1]);
        }
        giant.surface().clone().skin_all(&mut skin);
        for foot in 0..2 {
            if !giant.state().is_planted(foot) {
                if tick > 120 {
                    figures.toes = figures.toes.max(felt[2 + foot]);
                    swings += 1.0;
                    figures.jerks += f64::from(u8::from(felt[2 + foot] > 6.0));
                }
                stands[foot] = None;
                continue;
            }
            let ball = place(&giant, watched[2 + foot]);
            let (since, at) = *stands[foot].get_or_insert((tick, ball));
            figures.plants += usize::from(tick == since);
            let low = lowest(&giant, &skin, &soles[foot], &terrain);
            if tick == since + SETTLED {
                stands[foot] = Some((since, ball));
            }
            if tick > since + SETTLED {
                figures.gap = figures.gap.max(low);
                figures.depth = figures.depth.max(-low);
                figures.drift = figures.drift.max((ball - at).length());
            }
        }
    }
    figures.jerks /= swings;
    println!("{figures:#.3?}");
    figures
}

/// The least height of a sole's skin above the ground, at sampled points of its triangles.
fn lowest(giant: &Creature, skin: &[glam::Vec3], sole: &Sole, terrain: &RapierTerrain<'_>) -> f64 {
    /// Intervals between the sampled points along each side of a triangle.
    const CUTS: u32 = 4;
    let world = giant.surface().world_from_model();
    let mut lowest = f64::INFINITY;
    for triangle in &sole.triangles {
        let [a, b, c] = triangle.map(|VertexId(index)| skin[index as usize].as_dvec3());
        for i in 0..=CUTS {
            for j in 0..=CUTS - i {
                let [u, v] = [i, j].map(|cut| f64::from(cut) / f64::from(CUTS));
                let place = world.transform_point(a + (b - a) * u + (c - a) * v);
                let hit = terrain.cast_ray(place + DVec3::Y * 20.0, -DVec3::Y, 60.0);
                let height = hit.map_or(f64::INFINITY, |hit| place.y - hit.point.y);
                lowest = lowest.min(height);
            }
        }
    }
    lowest
}

/// The limits for every ground.
fn check(figures: &Figures) {
    assert!(figures.walked > 100.0 && figures.plants > 25, "{figures:?}");
    let most = 0.01 * figures.foot;
    assert!(figures.gap <= most && figures.depth <= most, "{figures:?}");
    assert!(figures.drift <= 0.01, "{figures:?}");
    assert!(figures.hips <= 1.0 && figures.head <= 1.0, "{figures:?}");
}

fn config() -> CreatureConfig {
    CreatureConfig {
        seed: 3,
        most_slope: 0.6,
        ..CreatureConfig::default()
    }
}

#[test]
fn on_level_ground() {
    let figures = walk(&ground(|_, _| 0.0), config(), 120.0);
    check(&figures);
    assert!(figures.toes <= 6.0, "{figures:?}");
}

#[test]
fn on_a_slope_of_25_degrees() {
    let slope = libm::tan(25f64.to_radians());
    let figures = walk(&ground(|_, z| slope * z), config(), 120.0);
    check(&figures);
    // The goal is 6 m/s^2 in all ticks. Uphill, a leg may be too short for its step, and then pulls the foot off the
    // ground.
    assert!(figures.jerks <= 0.01, "{figures:?}");
}

#[test]
fn on_boulders_of_2_m() {
    let mut world = ground(|_, _| 0.0);
    strew_boulders(&mut world, 3);
    let figures = walk(&world, config(), 120.0);
    check(&figures);
    // As uphill, a leg may be too short when the giant comes down from a boulder.
    assert!(figures.jerks <= 0.015, "{figures:?}");
}

#[test]
fn at_other_sizes() {
    // Several similar sizes, as the phase at which a walk begins decides how far the feet have to go.
    for scale in [0.1, 0.11, 1.9, 1.99, 2.0, 2.001] {
        let config = CreatureConfig { scale, ..config() };
        let figures = walk(&ground(|_, _| 0.0), config, 60.0);
        let most = 0.01 * figures.foot * scale;
        assert!(figures.plants > 10, "{scale}: {figures:?}");
        assert!(
            figures.gap.max(figures.depth) <= most,
            "{scale}: {figures:?}"
        );
        assert!(
            figures.drift <= 0.01 * scale.max(1.0),
            "{scale}: {figures:?}"
        );
        let felt = figures.hips.max(figures.head);
        assert!(felt <= 1.0 && figures.jerks <= 0.01, "{scale}: {figures:?}");
    }
}

/// The giant with a brain in which it only rests.
fn resting() -> Arc<CreatureKind> {
    let states = r#"{ "rests": { "act": { "play": "idle" } } }"#;
    support::kind(&support::brain_with("rests", states))
}

/// The block below a foot is removed, and the foot comes down to the ground.
#[test]
fn a_foot_comes_down_where_its_ground_is_gone() {
    let mut world = ground(|_, _| 0.0);
    let kind = resting();
    let mut giant = support::creature(&kind, config());
    let ball = place(&giant, kind.skeleton().find("toe.L").unwrap());
    let half = DVec3::new(4.0, 1.0, 8.0);
    let block = add_block(&mut world, ball.with_y(0.5), half);
    let soles = [sole(&kind, "foot.L"), sole(&kind, "foot.R")];
    let mut skin = Vec::new();
    let mut heights = Vec::new();
    for tick in 0..600 {
        if tick == 240 {
            world.colliders[block].set_enabled(false);
        }
        let terrain = terrain_of(&world);
        let all: [&dyn Obstacle; 1] = [&terrain];
        giant.step(&on_terrain(&all)).unwrap();
        giant.surface().clone().skin_all(&mut skin);
        heights.push([0, 1].map(|foot| lowest(&giant, &skin, &soles[foot], &terrain)));
    }
    let most = 0.01 * soles[0].length;
    let stands = |tick: usize| heights[tick].iter().all(|height| height.abs() <= most);
    assert!(stands(239), "{:?}", heights[239]);
    assert!(heights[241][0] > 1.0, "{:?}", heights[241]);
    let down = (241..600).find(|tick| stands(*tick)).unwrap();
    println!("down after {:.2} s", (down - 240) as f64 * TICK);
    assert!((down..600).all(stands));
    assert!(down < 240 + 240 && giant.state().is_planted(0));
}

/// A foot beside a wall is not put onto the wall, even if its sole reaches into it.
#[test]
fn a_wall_is_not_stepped_on() {
    let kind = resting();
    let left = kind.skeleton().find("toe.L").unwrap();
    let mut world = ground(|_, _| 0.0);
    let alone = support::creature(&kind, config());
    let ball = place(&alone, left);
    // The wall begins 1 m beside the ball of the left foot, below the outer half of that foot.
    let middle = ball.with_y(10.0) + DVec3::X * 11.0;
    add_block(&mut world, middle, DVec3::new(10.0, 10.0, 40.0));
    let terrain = terrain_of(&world);
    let all: [&dyn Obstacle; 1] = [&terrain];
    let mut giant = support::creature(&kind, config());
    let reaches = |giant: &Creature| {
        let sole = giant.sole(0).unwrap();
        sole.iter()
            .any(|corner| corner.x > f64::from((ball.x + 1.0) as f32))
    };
    for _ in 0..120 {
        giant.step(&on_terrain(&all)).unwrap();
    }
    assert!(reaches(&giant), "the foot does not reach into the wall");
    let rise = place(&giant, left).y - ball.y;
    assert!(rise.abs() < 0.3, "{rise}");
    assert!(giant.foot_clearance(0, &all).unwrap().abs() < 0.1);
}
