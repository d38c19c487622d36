//! Steps, cliffs and gullies in the ground, slopes that are too steep, and other creatures in the way.

use std::sync::Arc;

use clamber_colossus::{Creature, CreatureConfig, CreatureKind, Sense, Surroundings};
use clamber_world::{Obstacle, TriangleTerrain};
use glam::{DVec3, Vec3};

use crate::support::{TICK, level_ground, noise, with_noises};
use crate::walls::{config, creatures, reach};

/// Ground of strips across the path. Each pair is a distance along +Z and the height of the ground there, metres.
/// Between two distances there is a slope. Two heights at the same distance make a vertical face.
fn strips(profile: &[[f64; 2]]) -> TriangleTerrain {
    let wide = 4000.0;
    let mut corners = Vec::new();
    let mut triangles = Vec::new();
    for (index, [at, level]) in profile.iter().enumerate() {
        let (y, z) = (*level as f32, *at as f32);
        corners.extend([Vec3::new(-wide, y, z), Vec3::new(wide, y, z)]);
        if let Some(before) = index.checked_sub(1) {
            let [a, b] = [before, index].map(|row| 2 * row as u32);
            triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        }
    }
    TriangleTerrain::new(&corners, &triangles, &[], DVec3::ZERO).unwrap()
}

/// The result of a walk across such ground.
#[derive(Clone, Copy, Debug, Default)]
struct Walk {
    /// Largest distance along +Z, metres.
    far: f64,
    /// Largest height of the creature's origin, metres.
    high: f64,
    /// Largest height of a settled sole above the ground, as a share of the tolerance: the larger of 1 % of the foot's
    /// length and 0.1 % of the creature's height.
    gap: f64,
    /// Largest depth of a settled sole in the ground, as a share of the same tolerance.
    depth: f64,
    blocked: bool,
    arrived: bool,
}

fn walk(kind: &Arc<CreatureKind>, height: f64, terrain: &[&dyn Obstacle], goal: f64) -> Walk {
    let mut creature = Creature::new(Arc::clone(kind), config()).unwrap();
    let pace = height.sqrt();
    let legs = kind.brain().file().body.legs.len();
    let mut since = vec![0u32; legs];
    let settled = (0.6 * pace / TICK) as u32;
    let mut walk = Walk::default();
    for _ in 0..((10.0 + 3.0 * goal / height) * pace / TICK) as u32 {
        let noises = [noise(DVec3::Z * goal)];
        creature
            .step(&with_noises(terrain, &noises[..usize::from(!walk.arrived)]))
            .unwrap();
        let state = creature.state();
        let is_blocked = state.senses().get(Sense::Blocked) > 0.0;
        walk.blocked |= is_blocked;
        let walks = kind.brain().path(state.current()) == "walks";
        walk.arrived |= walks && !is_blocked && state.senses().get(Sense::Done) > 0.0;
        walk.far = walk.far.max(state.position().z);
        walk.high = walk.high.max(state.position().y);
        for (leg, since) in since.iter_mut().enumerate() {
            *since = if state.is_planted(leg) { *since + 1 } else { 0 };
            if *since > settled {
                let most = (0.01 * kind.foot_length(leg) * creature.scale()).max(0.001 * height);
                let gap = creature.foot_clearance(leg, terrain).unwrap_or(f64::MAX) / most;
                walk.gap = walk.gap.max(gap);
                walk.depth = walk.depth.max(-gap);
            }
        }
    }
    walk
}

/// A profile of ground. Its lengths are shares of the creature's height.
#[derive(Clone, Copy)]
enum Profile {
    /// A vertical face that rises by this share.
    Step(f64),
    /// A gully of this width and depth.
    Gully(f64, f64),
    /// A slope that rises by this share, at an angle in degrees.
    Slope(f64, f64),
}

use Profile::{Gully, Slope, Step};

/// A kind of ground: its name, its profile, and true if a creature walks on over its edge.
type Ground = (&'static str, Profile, bool);

/// The kinds of ground.
const GROUNDS: [Ground; 12] = [
    ("step of 0.02", Step(0.02), true),
    ("drop of 0.02", Step(-0.02), true),
    ("step of 0.12", Step(0.12), false),
    ("step of 0.29", Step(0.29), false),
    ("cliff of 0.12", Step(-0.12), false),
    ("cliff of 0.4", Step(-0.4), false),
    ("cliff of 3", Step(-3.0), false),
    ("gully, 0.5 wide and 0.3 deep", Gully(0.5, 0.3), false),
    ("gully, 0.1 wide and 1 deep", Gully(0.1, 1.0), false),
    ("slope of 20 degrees", Slope(1.0, 20.0), true),
    ("slope of 45 degrees", Slope(1.0, 45.0), false),
    ("slope down of 20 degrees", Slope(-1.0, -20.0), true),
];

/// Distance along +Z at which the ground begins, metres.
const NEAR: f64 = -2000.0;
/// Distance along +Z at which the ground ends, metres.
const FAR: f64 = 4000.0;

impl Profile {
    /// The profile with its edge at the distance `away`, for a creature of the height `tall`, metres.
    fn strips(self, away: f64, tall: f64) -> TriangleTerrain {
        let beyond = match self {
            Step(rise) => vec![[away, rise * tall], [FAR, rise * tall]],
            Gully(wide, deep) => {
                let (end, low) = (away + wide * tall, -deep * tall);
                vec![[away, low], [end, low], [end, 0.0], [FAR, 0.0]]
            }
            Slope(rise, degrees) => {
                let end = away + rise * tall / libm::tan(degrees.to_radians());
                vec![[end, rise * tall], [FAR, rise * tall]]
            }
        };
        strips(&[vec![[NEAR, 0.0], [away, 0.0]], beyond].concat())
    }
}

fn to_edge(
    (name, kind, height): &(&'static str, Arc<CreatureKind>, f64),
    (what, profile, passes): Ground,
    failed: &mut Vec<String>,
) {
    let away = reach(kind, *height) + height;
    let goal = 2.0 * away + 2.0 * height;
    let ground = profile.strips(away, *height);
    let terrain: [&dyn Obstacle; 1] = [&ground];
    let walk = walk(kind, *height, &terrain, goal);
    let told = format!("{name}, {what} at {away:.1}: {walk:.2?}");
    println!("{told}");
    let is_right = if passes {
        walk.arrived
    } else {
        walk.blocked && walk.far < away
    };
    // Bodies do not pitch. Where a creature walks over an edge and its front legs are far from its hind legs, some legs
    // are too short.
    let pitches = passes && ["Apatosaurus.glb", "Triceratops.glb"].contains(name);
    let stands = walk.gap <= 1.0 && walk.depth <= 1.0;
    if !is_right || !(stands || pitches) {
        failed.push(told);
    }
}

/// An edge that is too high, too deep or too steep stops a creature before its feet leave the ground. Each creature
/// walks to one kind of ground.
#[test]
fn edges_stop_it() {
    let mut failed = Vec::new();
    for (index, one) in creatures().iter().enumerate() {
        to_edge(one, GROUNDS[2 * index % GROUNDS.len()], &mut failed);
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
#[ignore = "takes minutes: 72 walks"]
fn all_edges_stop_it() {
    let mut failed = Vec::new();
    for one in &creatures() {
        for ground in GROUNDS {
            to_edge(one, ground, &mut failed);
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

/// Two creatures that walk towards each other, or to places behind each other, stop before their skins touch.
#[test]
fn two_creatures_do_not_walk_into_each_other() {
    let mut failed = Vec::new();
    let all = creatures();
    let beyond = all.iter().take(3).map(|one| (one, 4.0));
    for ((name, kind, height), beyond) in all.iter().map(|one| (one, 0.0)).chain(beyond) {
        let height = *height;
        let away = 2.0 * reach(kind, height) + 2.0 * height;
        let mut both = [(0.0, 0.0), (away, core::f64::consts::PI)].map(|(z, yaw)| {
            let config = CreatureConfig {
                position: DVec3::Z * z,
                yaw,
                ..config()
            };
            Creature::new(Arc::clone(kind), config).unwrap()
        });
        let terrain = level_ground();
        let mut deepest = 0f64;
        let mut near = f64::INFINITY;
        let mut skin: Vec<Vec3> = Vec::new();
        for tick in 0..(30.0 * height.sqrt() / TICK) as u32 {
            for one in 0..2 {
                let [a, b] = &mut both;
                let (own, other) = if one == 0 { (a, b) } else { (b, a) };
                let goes = if one == 0 { 1.0 } else { -1.0 };
                let noises = [noise(
                    other.state().position() + DVec3::Z * (goes * beyond * height),
                )];
                let skins: [&dyn Obstacle; 1] = [other.surface()];
                let around = Surroundings {
                    terrain: &terrain,
                    creatures: &skins,
                    noises: &noises,
                    ..Surroundings::default()
                };
                own.step(&around).unwrap();
            }
            let [a, b] = &both;
            near = near.min(a.state().position().distance(b.state().position()));
            if tick % 30 == 0 {
                a.surface().clone().skin_all(&mut skin);
                let world = a.surface().world_from_model();
                for place in skin.iter().step_by(3) {
                    let place = world.transform_point(place.as_dvec3());
                    // A ray that starts inside a closed skin hits a back face.
                    let up = b.surface().cast_ray(place, DVec3::Y, 4.0 * height);
                    let inside = up.filter(|hit| hit.normal.y > 0.0);
                    let out = b.surface().closest_point(place, height);
                    if let (Some(_), Some(out)) = (inside, out) {
                        deepest = deepest.max(out.distance.abs() / height);
                    }
                }
            }
        }
        let told = format!(
            "{name}: {deepest:.3} deep, {:.2} heights away",
            near / height
        );
        println!("{told}");
        if deepest > 0.02 || near > away - 0.5 * height {
            failed.push(told);
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

/// A small and fast creature looks far enough ahead, in small enough steps, to stop as well as a large and slow one.
#[test]
fn edges_stop_who_runs() {
    let mut failed = Vec::new();
    for (height, speed, tick) in [
        (1.0, 40.0, TICK),
        (1.0, 8.0, TICK),
        (1.0, 3.0, TICK),
        (2.0, 12.0, TICK),
        (1.5, 6.0, 2.0 * TICK),
    ] {
        let mut file: serde_json::Value =
            serde_json::from_str(&crate::support::brain_with("stands", crate::walls::HUNTS))
                .unwrap();
        file["body"]["height"] = height.into();
        file["body"]["made_for"] = height.into();
        file["body"]["gait"]["speed"] = (speed / height).into();
        let kind = crate::support::kind_at(&file.to_string(), tick);
        for (what, profile, passes) in GROUNDS {
            let away = 60.0 + 20.0 * height;
            let ground = profile.strips(away, height);
            let terrain: [&dyn Obstacle; 1] = [&ground];
            let walk = run(&kind, &terrain, 2.0 * away, away + 2.0 * height);
            let told = format!("{height} m at {speed} m/s, {what}: {walk:.2?}");
            println!("{told}");
            let is_right = if passes {
                walk.far > away + height && !walk.blocked
            } else {
                walk.blocked && walk.far < away
            };
            if !is_right || walk.fastest < 0.8 * speed.min(7.0) {
                failed.push(told);
            }
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

/// A walk to a noise of at most a minute, which ends when the creature is blocked or far enough. `far` is its largest
/// distance, metres, and `fastest` its highest speed, m/s.
#[derive(Debug, Default)]
struct Run {
    far: f64,
    blocked: bool,
    fastest: f64,
}

fn run(kind: &Arc<CreatureKind>, terrain: &[&dyn Obstacle], goal: f64, enough: f64) -> Run {
    let mut creature = Creature::new(Arc::clone(kind), config()).unwrap();
    let mut run = Run::default();
    for _ in 0..(60.0 / kind.brain().tick()) as u32 {
        let noises = [noise(DVec3::Z * goal)];
        creature.step(&with_noises(terrain, &noises)).unwrap();
        let state = creature.state();
        run.blocked |= state.senses().get(Sense::Blocked) > 0.0;
        run.far = run.far.max(state.position().z);
        run.fastest = run.fastest.max(state.speed());
        if run.blocked || run.far > enough {
            break;
        }
    }
    run
}
