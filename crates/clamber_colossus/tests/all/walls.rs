//! What stands in a creature's way: walls, steps, cliffs and gullies, other creatures, and ground that moves.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::sync::Arc;

use clamber_colossus::{Creature, CreatureConfig, CreatureKind, Noise, Sense, Surroundings};
use clamber_surface::geometry::rotation_from_axis_angle;
use clamber_world::{HalfSpace, Obstacle, TriangleTerrain};
use glam::{DQuat, DVec3, Vec3};

use crate::animals::{animals, kind as animal};
use crate::support::{TICK, brain_with, kind as giant};

/// It hears something, turns there and walks there.
const HUNTS: &str = r#"{
    "stands": { "transitions": [{ "to": "turns", "when": ["noise > 0"], "after": 1 }] },
    "turns": { "act": { "turn": { "to": "noise", "within_deg": 5 } }, "transitions": [
        { "to": "walks", "when": ["done"] }] },
    "walks": { "act": { "walk": { "to": "noise", "within": 20 } }, "transitions": [
        { "to": "stands", "when": ["done"] }] }
}"#;

/// The giant and five animals, with their heights.
pub(crate) fn creatures() -> Vec<(&'static str, Arc<CreatureKind>, f64)> {
    let mut all = vec![("giant", giant(&brain_with("stands", HUNTS)), 41.0)];
    for one in animals() {
        let is_one = ["Trex", "Apatosaurus", "Triceratops", "Bull", "Fox"]
            .iter()
            .any(|name| one.file.starts_with(name));
        if let Some(kind) = is_one.then(|| animal(&one, 20.0)).flatten() {
            all.push((one.file, kind, 20.0));
        }
    }
    all
}

/// How far its skin is from its origin at rest, on the ground, metres.
pub(crate) fn reach(kind: &Arc<CreatureKind>, height: f64) -> f64 {
    let creature = Creature::new(Arc::clone(kind), config()).unwrap();
    let mut skin: Vec<Vec3> = Vec::new();
    creature.surface().clone().skin_all(&mut skin);
    let far = skin.iter().map(|place| f64::from(place.x.hypot(place.z)));
    far.fold(0.0, f64::max) * height / kind.height()
}

/// A wall on level ground.
#[derive(Clone, Copy, Debug)]
struct Wall {
    /// The middle of its foot, on the near side; where it looks, radians from -Z; half its width; height and thickness, metres.
    at: DVec3,
    turned: f64,
    half: f64,
    height: f64,
    thick: f64,
}

impl Wall {
    fn rotation(&self) -> DQuat {
        rotation_from_axis_angle(DVec3::Y, self.turned)
    }

    /// A box of triangles, or a sheet if it has no thickness.
    fn terrain(&self) -> TriangleTerrain {
        let corner = |x: f64, y: f64, z: f64| {
            let place = DVec3::new(x * self.half, y * self.height, z * self.thick);
            (self.at + self.rotation() * place).as_vec3()
        };
        let mut corners = vec![
            corner(-1.0, -0.1, 0.0),
            corner(1.0, -0.1, 0.0),
            corner(1.0, 1.0, 0.0),
            corner(-1.0, 1.0, 0.0),
        ];
        let mut triangles = vec![[0, 2, 1], [0, 3, 2]];
        if self.thick > 0.0 {
            corners.extend([
                corner(-1.0, -0.1, 1.0),
                corner(1.0, -0.1, 1.0),
                corner(1.0, 1.0, 1.0),
                corner(-1.0, 1.0, 1.0),
            ]);
            triangles.extend([
                [4, 5, 6],
                [4, 6, 7],
                [0, 1, 5],
                [0, 5, 4],
                [3, 6, 2],
                [3, 7, 6],
                [0, 4, 7],
                [0, 7, 3],
                [1, 2, 6],
                [1, 6, 5],
            ]);
        }
        TriangleTerrain::new(&corners, &triangles, &[], DVec3::ZERO).unwrap()
    }

    /// How deep a place of the skin is in the wall: in one that is thick as far as it is to its next face, and beyond
    /// a sheet as far as it is from it, seen from the creature's origin.
    fn depth(&self, origin: DVec3, place: DVec3) -> f64 {
        let local = |place: DVec3| self.rotation().conjugate() * (place - self.at);
        let [from, at] = [origin, place].map(local);
        let inside = |at: DVec3| (self.height - at.y).min(self.half - at.x.abs());
        if self.thick > 0.0 {
            return inside(at).min(at.z).min(self.thick - at.z);
        }
        if from.z * at.z >= 0.0 {
            return 0.0;
        }
        let crosses = from.with_y(at.y).lerp(at, from.z / (from.z - at.z));
        inside(crosses).min(at.z.abs())
    }
}

/// What became of a walk.
#[derive(Clone, Copy, Debug, Default)]
struct Walk {
    /// The deepest that any skin was in rock, as a share of the height.
    deepest: f64,
    /// Seconds over the square root of the height until it was told that it is blocked, or had arrived.
    blocked: Option<f64>,
    arrived: Option<f64>,
    moved: f64,
    high: f64,
}

/// Lets a creature walk to a noise among obstacles, and looks how deep its skin comes.
fn walk(
    kind: &Arc<CreatureKind>,
    config: CreatureConfig,
    goal: DVec3,
    terrain: &[&dyn Obstacle],
    seconds: f64,
    depth: &dyn Fn(DVec3, DVec3) -> f64,
) -> Walk {
    let mut creature = Creature::new(Arc::clone(kind), config).unwrap();
    let height = creature.height();
    let mut walk = Walk::default();
    let mut skin: Vec<Vec3> = Vec::new();
    let pace = height.sqrt();
    for tick in 0..(seconds * pace / TICK) as u32 {
        let time = f64::from(tick) * TICK / pace;
        let noises = [Noise {
            place: goal,
            loudness: 5.0,
        }];
        let around = Surroundings {
            terrain,
            noises: &noises[..usize::from(walk.arrived.is_none())],
            ..Surroundings::default()
        };
        creature.step(&around).unwrap();
        let state = creature.state();
        walk.high = (state.position().y / height).max(walk.high);
        if state.senses().get(Sense::Blocked) > 0.0 {
            walk.blocked.get_or_insert(time);
        } else if kind.brain().path(state.current()) == "walks"
            && state.senses().get(Sense::Done) > 0.0
        {
            walk.arrived.get_or_insert(time);
        }
        if tick % 8 == 0 {
            creature.surface().clone().skin_all(&mut skin);
            let world = creature.surface().world_from_model();
            let places = skin.iter().map(|p| world.transform_point(p.as_dvec3()));
            let deepest = places.map(|place| depth(world.translation, place));
            let deepest = deepest.fold(f64::NEG_INFINITY, f64::max) / height;
            walk.deepest = walk.deepest.max(deepest);
        }
    }
    walk.moved = creature.state().position().distance(config.position) / height;
    walk
}

pub(crate) fn config() -> CreatureConfig {
    CreatureConfig {
        arena: 1e4,
        hearing: 1e4,
        ..CreatureConfig::default()
    }
}

/// Walks to a wall that is too wide to go round.
fn to_wall(
    (name, kind, height): &(&'static str, Arc<CreatureKind>, f64),
    [tall, thick, turned]: [f64; 3],
    failed: &mut Vec<String>,
) {
    let ground = HalfSpace::below(0.0);
    let away = (reach(kind, *height) + 0.7 * height) / libm::cos(turned);
    let wall = Wall {
        at: DVec3::Z * away,
        turned,
        half: 40.0 * height,
        height: tall * height,
        thick: thick * height,
    };
    let rock = wall.terrain();
    let terrain: [&dyn Obstacle; 2] = [&ground, &rock];
    let goal = DVec3::Z * (2.0 * away + 2.0 * height);
    let seconds = 8.0 + 2.5 * away / height;
    let walk = walk(kind, config(), goal, &terrain, seconds, &|from, at| {
        wall.depth(from, at)
    });
    let told = format!("{name} {tall} {thick} {turned:.1}: {walk:.3?}");
    println!("{told}");
    if walk.deepest > 0.02 || walk.blocked.is_none() {
        failed.push(told);
    }
}

/// Walls of 0.2 to 2 heights, thin and thick, to which it walks at 0 to 80 degrees: one after the other for each creature.
#[test]
fn walls_stop_it() {
    let mut failed = Vec::new();
    let walls = [
        [2.0, 0.0, 0.0],
        [0.2, 0.02, 30.0f64],
        [0.5, 2.0, 60.0],
        [0.2, 0.0, 0.0],
        [2.0, 2.0, 30.0],
        [1.0, 0.02, 0.0],
    ];
    for (one, [tall, thick, turned]) in creatures().iter().zip(walls) {
        to_wall(one, [tall, thick, turned.to_radians()], &mut failed);
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
#[ignore = "takes minutes: 216 walks"]
fn all_walls_stop_it() {
    let mut failed = Vec::new();
    for one in &creatures() {
        for tall in [0.2, 0.5, 2.0] {
            for thick in [0.0, 0.02, 2.0] {
                for turned in [0.0, 30.0, 60.0, 80.0f64] {
                    to_wall(one, [tall, thick, turned.to_radians()], &mut failed);
                }
            }
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

/// A wall that ends is gone round.
#[test]
fn walls_that_end_are_gone_round() {
    let ground = HalfSpace::below(0.0);
    let mut failed = Vec::new();
    for (name, kind, height) in &creatures() {
        let away = reach(kind, *height) + height;
        let wall = Wall {
            at: DVec3::Z * away,
            turned: 0.2,
            half: 1.5 * height,
            height: 0.7 * height,
            thick: 0.0,
        };
        let rock = wall.terrain();
        let terrain: [&dyn Obstacle; 2] = [&ground, &rock];
        let goal = DVec3::Z * (2.0 * away + 2.0 * height);
        let walk = walk(kind, config(), goal, &terrain, 60.0, &|from, at| {
            wall.depth(from, at)
        });
        let told = format!("{name}: {walk:.3?}");
        println!("{told}");
        if walk.deepest > 0.02 || walk.arrived.is_none() {
            failed.push(told);
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
