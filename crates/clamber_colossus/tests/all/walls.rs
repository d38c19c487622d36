//! Walls in a creature's way: it stops at them, goes round them, and neither turns nor strikes into them.

use std::sync::Arc;

use clamber_colossus::{Creature, CreatureConfig, CreatureKind, Sense};
use clamber_surface::geometry::rotation_from_axis_angle;
use clamber_world::rapier3d::prelude::PhysicsWorld;
use clamber_world::{HalfSpace, Obstacle, TriangleTerrain};
use glam::{DQuat, DVec3, Vec3};

use crate::animals::{animals, kind as animal};
use crate::attacks::attacks;
use crate::support::{
    TICK, add_block, brain_with, kind as giant, noise, on_terrain, terrain_of, with_noises,
};

/// States in which a creature turns to a noise and walks there, as JSON.
pub(crate) const HUNTS: &str = r#"{
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

/// Largest level distance of the skin from the creature's origin at rest, for a creature of this height, metres.
pub(crate) fn reach(kind: &Arc<CreatureKind>, height: f64) -> f64 {
    let creature = Creature::new(Arc::clone(kind), config()).unwrap();
    let mut skin: Vec<Vec3> = Vec::new();
    creature.surface().clone().skin_all(&mut skin);
    let far = skin
        .iter()
        .map(|place| f64::from(place.with_y(0.0).length()));
    far.fold(0.0, f64::max) * height / kind.height()
}

/// A wall on level ground.
#[derive(Clone, Copy, Debug)]
struct Wall {
    /// Middle of the near side at ground level, in the world.
    at: DVec3,
    /// Angle about Y from -Z to the normal of the near side, radians.
    turned: f64,
    /// Half the width, metres.
    half: f64,
    /// Height, metres.
    height: f64,
    /// Thickness, metres; 0 for a sheet.
    thick: f64,
}

impl Wall {
    fn rotation(&self) -> DQuat {
        rotation_from_axis_angle(DVec3::Y, self.turned)
    }

    /// A box of triangles, or a sheet of two triangles if the wall has no thickness.
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

    /// Depth of a point of the skin in the wall, metres. In a thick wall it is the distance to the nearest face. Behind
    /// a sheet, seen from the creature's origin, it is the distance to the sheet.
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

/// The result of a walk.
#[derive(Clone, Copy, Debug, Default)]
struct Walk {
    /// Largest depth of the skin in rock, as a share of the height.
    deepest: f64,
    /// Time until the creature was blocked, in seconds divided by the square root of its height in metres.
    blocked: Option<f64>,
    /// Time until the creature arrived, in the same unit.
    arrived: Option<f64>,
    moved: f64,
    high: f64,
}

/// Lets a creature walk to a noise among obstacles, and measures how deep its skin gets into them.
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
        let noises = [noise(goal)];
        creature
            .step(&with_noises(
                terrain,
                &noises[..usize::from(walk.arrived.is_none())],
            ))
            .unwrap();
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

/// Lets a creature walk to a wall that is too wide to go round.
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

/// Walls of 0.2 to 2 heights, thin and thick, stop creatures that walk to them at 0 to 60 degrees. Each creature walks
/// to one wall.
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
    for (one, height) in animals().iter().zip([1.0, 300.0, 4.0]) {
        if let Some(kind) = animal(one, height) {
            to_wall(&(one.file, kind, height), [1.0, 0.0, 0.3], &mut failed);
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

/// The same wall stops the giant as a half-space and as a rapier box.
#[test]
fn walls_of_other_makes_stop_it() {
    let (_, kind, height) = creatures().remove(0);
    let ground = HalfSpace::below(0.0);
    let away = reach(&kind, height) + 0.7 * height;
    let solid = HalfSpace::behind(DVec3::Z * away, DVec3::NEG_Z).unwrap();
    let mut world = PhysicsWorld::default();
    let half = DVec3::new(300.0, height, 5.0);
    add_block(&mut world, DVec3::Z * (away + half.z), half);
    let rock = terrain_of(&world);
    for wall in [&solid as &dyn Obstacle, &rock] {
        let depth = |_, place: DVec3| place.z - away;
        let goal = DVec3::Z * (2.0 * away + 2.0 * height);
        let walk = walk(&kind, config(), goal, &[&ground, wall], 12.0, &depth);
        println!("{walk:.3?}");
        assert!(walk.deepest <= 0.02 && walk.blocked.is_some(), "{walk:?}");
    }
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

/// A creature goes round a wall that ends.
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

/// Close beside a wall and close in front of one, a creature turns to a noise behind it: to either side, the long way
/// round, or not at all, but never into the wall.
#[test]
fn it_does_not_turn_into_walls() {
    let ground = HalfSpace::below(0.0);
    let mut failed = Vec::new();
    for (name, kind, height) in &creatures() {
        let far = reach(kind, *height);
        for (at, turned) in [
            (DVec3::X * (0.7 * far), core::f64::consts::FRAC_PI_2),
            (DVec3::NEG_X * (0.9 * far), -core::f64::consts::FRAC_PI_2),
            (DVec3::Z * (1.05 * far), 0.0),
            (DVec3::NEG_Z * (1.0 * far), core::f64::consts::PI),
        ] {
            let wall = Wall {
                at,
                turned,
                half: 10.0 * height,
                height: height * 1.2,
                thick: 0.0,
            };
            let rock = wall.terrain();
            let terrain: [&dyn Obstacle; 2] = [&ground, &rock];
            // Skips a wall into which the creature's skin already reaches while it stands.
            let still = walk(
                kind,
                config(),
                DVec3::Z * height,
                &[&ground],
                1.0,
                &|from, at| wall.depth(from, at),
            );
            if still.deepest > 0.0 {
                continue;
            }
            for goal in [DVec3::new(0.3, 0.0, -1.0), DVec3::new(-1.0, 0.0, -0.3)] {
                let goal = goal * (4.0 * far);
                let walk = walk(kind, config(), goal, &terrain, 20.0, &|from, at| {
                    wall.depth(from, at)
                });
                let told = format!("{name} {at:.1} {goal:.1}: {walk:.3?}");
                println!("{told}");
                let ends = walk.blocked.is_some() || walk.moved > 0.3;
                if walk.deepest > 0.02 || !ends {
                    failed.push(told);
                }
            }
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

/// An attack does not begin if its limb would go through a wall, and the brain is told. Without the wall it begins.
#[test]
fn blows_do_not_go_through_walls() {
    let attacks = attacks();
    let (mut walled, mut deepest) = (0, 0f64);
    for (_, attack) in &attacks {
        let states = format!(
            r#"{{ "strikes": {{ "act": {attack}, "transitions": [{{ "to": "stands", "when": ["blocked"] }}] }}, "stands": {{ }} }}"#
        );
        let kind = giant(&brain_with("strikes", &states));
        for (away, is_wall) in [
            (4.5, true),
            (7.0, true),
            (12.0, true),
            (60.0, true),
            (0.0, false),
        ] {
            let ground = HalfSpace::below(0.0);
            let wall = Wall {
                at: DVec3::Z * away,
                turned: 0.0,
                half: 200.0,
                height: 80.0,
                thick: 0.0,
            };
            let rock = wall.terrain();
            let all: [&dyn Obstacle; 2] = [&ground, &rock];
            let terrain = if is_wall { &all[..] } else { &all[..1] };
            let mut giant = Creature::new(Arc::clone(&kind), config()).unwrap();
            let mut skin = Vec::new();
            let (mut began, mut blocked, mut own) = (false, false, 0f64);
            let mut heard = false;
            for tick in 0..400 {
                giant.step(&on_terrain(terrain)).unwrap();
                blocked |= giant.state().senses().get(Sense::Blocked) > 0.0;
                began |= giant.attack().is_some();
                let brain = giant.kind().brain();
                heard |= brain.path(giant.state().current()) == "stands";
                if is_wall && began && tick % 4 == 0 {
                    giant.surface().clone().skin_all(&mut skin);
                    let world = giant.surface().world_from_model();
                    let places = skin.iter().map(|p| world.transform_point(p.as_dvec3()));
                    let depths = places.map(|place| wall.depth(world.translation, place));
                    own = depths.fold(own, f64::max);
                }
            }
            deepest = deepest.max(own);
            assert_ne!(began, blocked, "{attack} {away}");
            assert_eq!(
                heard, blocked,
                "{attack} {away}: its brain did not hear of it"
            );
            assert!(began || is_wall && away < 60.0, "{attack} {away}");
            walled += u32::from(blocked);
        }
    }
    println!(
        "{walled} of {} not begun; {deepest:.2} m deep",
        3 * attacks.len()
    );
    assert!(walled >= 8 && deepest < 0.02 * 41.0, "{walled}, {deepest}");
}
