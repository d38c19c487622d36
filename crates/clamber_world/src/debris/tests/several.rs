//! Several creatures: the state of debris belongs to an obstacle's id, not to an index in the list.

use clamber_surface::geometry::Similarity;
use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, Vec3};
use rapier3d::prelude::*;

use super::scene::{DT, add_rock, bits, lifted, slab, step};
use crate::ObstacleId;
use crate::debris::{Debris, DebrisConfig, DebrisError, DebrisReport};
use crate::testing::rest;

/// Radius of the rock, metres.
const RADIUS: f64 = 0.3;

/// One rock with a radius of 0.3 m, and rapier's world.
struct Rock {
    world: PhysicsWorld,
    debris: Debris,
    body: RigidBodyHandle,
}

impl Rock {
    fn new(place: Vector) -> Self {
        let mut world = PhysicsWorld::default();
        let mut debris = Debris::new(DebrisConfig::default());
        let body = RigidBodyBuilder::dynamic().translation(place);
        let ball = ColliderBuilder::ball(RADIUS as f32);
        let (body, _) = add_rock(&mut world, &mut debris, body, ball);
        Self {
            world,
            debris,
            body,
        }
    }

    fn tick(&mut self, surfaces: &[(ObstacleId, &SkinnedSurface)]) -> DebrisReport {
        step(&mut self.world, &mut self.debris, surfaces, DT)
    }

    fn place(&self) -> DVec3 {
        self.world.bodies[self.body].translation().as_dvec3()
    }

    fn bits(&self) -> Vec<u32> {
        bits(std::iter::once(&self.world.bodies[self.body]))
    }
}

fn stone(half: Vec3) -> SkinnedSurface {
    slab(half, 0.6, 1)
}

fn moved(surface: &mut SkinnedSurface, place: DVec3) {
    let root = Similarity::from_translation(place);
    surface.advance(&rest(), root).unwrap();
}

fn placed(surface: &mut SkinnedSurface, place: DVec3) {
    let root = Similarity::from_translation(place);
    surface.teleport(&rest(), root).unwrap();
}

/// Two hands clap at a speed on a rock in mid-air, and leave it less room than it needs. The hand with index `first` is
/// first in the list.
fn clap(speed: f64, first: usize) -> Vec<(Vec<u32>, DebrisReport)> {
    let mut hands = [0, 1].map(|_| stone(Vec3::new(0.5, 2.0, 2.0)));
    let mut rock = Rock::new(Vector::ZERO);
    rock.world.gravity = Vector::ZERO;
    let mut ticks = Vec::new();
    for tick in 0..300 {
        let closed = (2.0 - speed * DT * f64::from(tick)).max(0.5 + RADIUS * 0.5);
        let apart = closed + 2.0 * DT * f64::from((tick - 240).max(0));
        for (hand, side) in hands.iter_mut().zip([-apart, apart]) {
            let place = DVec3::X * side;
            if tick == 0 {
                placed(hand, place)
            } else {
                moved(hand, place)
            }
        }
        let list = [first, 1 - first].map(|hand| (ObstacleId(hand as u64), &hands[hand]));
        let report = rock.tick(&list);
        ticks.push((rock.bits(), report));
    }
    ticks
}

#[test]
fn the_order_of_the_list_changes_no_bit() {
    for speed in [1.0, 5.0, 20.0] {
        let [wanted, found] = [0, 1].map(|first| clap(speed, first));
        for (tick, (found, wanted)) in found.iter().zip(&wanted).enumerate() {
            assert_eq!(found, wanted, "{speed} m/s, tick {tick}");
        }
    }
}

#[test]
fn a_creature_that_leaves_the_list_does_not_change_the_state_against_the_others() {
    // A foot stands on a rock and is let through it. In the tick in which the foot leaves the list, an arm reaches
    // the rock.
    /// Tick in which the foot leaves the list.
    const GONE: i32 = 60;
    for speed in [2.0, 10.0, 20.0, 40.0, 60.0] {
        for listed_first in [false, true] {
            let mut foot = stone(Vec3::ONE);
            let mut arm = stone(Vec3::new(0.3, 0.5, 4.0));
            let mut rock = Rock::new(Vector::new(0.0, RADIUS as f32, 0.0));
            let ground = ColliderBuilder::cuboid(500.0, 1.0, 50.0).friction(0.6);
            let ground = ground.translation(Vector::new(0.0, -1.0, 0.0));
            rock.world.insert_collider(ground, None);
            let arm_at = |tick: i32| {
                let x = -0.61 + speed * DT * f64::from(tick - GONE + 1);
                DVec3::new(x, 0.55, 0.0)
            };
            placed(&mut foot, DVec3::Y * 2.0);
            placed(&mut arm, arm_at(0));
            for tick in 1..GONE + 60 {
                moved(&mut arm, arm_at(tick));
                let ids = if listed_first { [4, 7] } else { [7, 4] };
                let [of_foot, of_arm] = ids.map(ObstacleId);
                if tick < GONE {
                    let sole = (2.0 - 0.05 * f64::from(tick)).max(1.05);
                    moved(&mut foot, DVec3::Y * sole);
                    rock.tick(&[(of_foot, &foot), (of_arm, &arm)]);
                    continue;
                }
                if tick == GONE {
                    assert!(rock.debris.is_let_through(rock.body), "under the foot");
                }
                rock.tick(&[(of_arm, &arm)]);
                let (face, place) = (arm_at(tick).x + 0.3, rock.place());
                let case = format!("{speed} m/s, {ids:?}, tick {}", tick - GONE);
                let told = format!("{case}: rock at {place:.2}, arm's face at {face:.2}");
                assert!(place.x > face - 0.02, "{told}");
                assert!(!rock.debris.is_let_through(rock.body), "{case}");
            }
        }
    }
}

/// How a resting creature gets to another place.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    Palette,
    Root,
    /// Another surface takes over the creature's id.
    Successor,
    /// Another surface appears, under an id of its own.
    Other,
}

#[test]
fn a_creature_that_was_placed_elsewhere_holds_rocks_there() {
    for way in [Way::Palette, Way::Root, Way::Successor, Way::Other] {
        // After 400 ticks the rock is asleep.
        for calm in [20, 400] {
            for up in [-0.1f32, -0.03, -0.002, 0.005, 0.03, 0.1] {
                let mut one = stone(Vec3::new(4.0, 1.0, 4.0));
                let mut two = SkinnedSurface::new(one.mesh().clone());
                let root = Similarity::from_translation(DVec3::Y * f64::from(up));
                let (palette, root) = match way {
                    Way::Root => (rest(), root),
                    _ => (lifted(1, |_| f64::from(up)), Similarity::IDENTITY),
                };
                two.teleport(&palette, root).unwrap();
                let mut rock = Rock::new(Vector::new(0.2, 1.31, 0.3));
                for _ in 0..calm {
                    moved(&mut one, DVec3::ZERO);
                    rock.tick(&[(ObstacleId(3), &one)]);
                }
                assert_eq!(rock.world.bodies[rock.body].is_sleeping(), calm == 400);
                for tick in 0..200 {
                    if tick == 0 {
                        one.teleport(&palette, root)
                    } else {
                        one.advance(&palette, root)
                    }
                    .unwrap();
                    two.advance(&palette, root).unwrap();
                    let now = match way {
                        Way::Palette | Way::Root => (ObstacleId(3), &one),
                        Way::Successor => (ObstacleId(3), &two),
                        Way::Other => (ObstacleId(1), &two),
                    };
                    rock.tick(&[now]);
                }
                let gap = rock.place().y - RADIUS - 1.0 - f64::from(up);
                let case = format!("{way:?}, {calm} calm ticks, {up} m up");
                assert!(gap.abs() < 2e-3, "{case}: {gap} m over the skin");
            }
        }
    }
}

#[test]
fn a_rock_falls_when_its_creature_leaves_the_list_and_lies_on_one_that_comes() {
    let mut back = stone(Vec3::new(4.0, 1.0, 4.0));
    let mut rock = Rock::new(Vector::new(0.2, 1.31, 0.3));
    for _ in 0..400 {
        moved(&mut back, DVec3::ZERO);
        rock.tick(&[(ObstacleId(3), &back)]);
    }
    assert!(rock.world.bodies[rock.body].is_sleeping());
    let known = rock.world.bodies.len();
    for _ in 0..10 {
        rock.tick(&[]);
    }
    let fallen = rock.place().y;
    assert!(fallen < 1.25, "{fallen}");
    // The rock takes over the patch of the creature that is gone.
    placed(&mut back, DVec3::NEG_Y);
    for _ in 0..200 {
        moved(&mut back, DVec3::NEG_Y);
        rock.tick(&[(ObstacleId(9), &back)]);
    }
    let lies = rock.place().y;
    assert!((lies - RADIUS).abs() < 2e-3, "{lies}");
    assert_eq!(rock.world.bodies.len(), known);
}

#[test]
fn one_id_for_two_surfaces_is_refused_and_changes_nothing() {
    let back = stone(Vec3::new(4.0, 1.0, 4.0));
    let mut rock = Rock::new(Vector::new(0.2, 1.31, 0.3));
    rock.tick(&[(ObstacleId(3), &back)]);
    let before = (rock.bits(), rock.world.bodies.len());
    let twice = [3, 1, 3].map(|id| (ObstacleId(id), &back));
    let wanted = DebrisError::TwiceListed(ObstacleId(3));
    let world = &mut rock.world;
    let found = rock
        .debris
        .before_step(&twice, &mut world.bodies, &mut world.colliders, DT);
    assert_eq!(found.as_ref(), Err(&wanted));
    let text = "obstacle 3 is twice in the list of surfaces";
    assert_eq!(wanted.to_string(), text);
    let found = rock.debris.after_step(
        &twice,
        &mut world.bodies,
        &world.colliders,
        &world.broad_phase,
        &world.narrow_phase,
        DT,
    );
    assert_eq!(found, Err(wanted));
    assert_eq!((rock.bits(), rock.world.bodies.len()), before);
}

#[test]
fn a_reused_patch_belongs_to_its_new_rock() {
    let back = stone(Vec3::new(4.0, 1.0, 4.0));
    let list = [(ObstacleId(3), &back)];
    let mut rock = Rock::new(Vector::new(0.2, 1.31, 0.3));
    rock.tick(&list);
    let owned_by = |rock: &Rock, body: RigidBodyHandle| {
        let colliders = rock.world.colliders.iter().map(|(handle, _)| handle);
        let own = colliders.filter(|collider| rock.debris.owner_of(*collider) == Some(body));
        own.collect::<Vec<_>>()
    };
    let skin = owned_by(&rock, rock.body);
    assert_eq!(skin.len(), 1);
    assert!(rock.debris.remove(rock.body, &mut rock.world.colliders));
    assert_eq!(owned_by(&rock, rock.body), []);
    let (second, _) = rock.world.insert(
        RigidBodyBuilder::dynamic().translation(Vector::new(-1.0, 1.31, 0.3)),
        ColliderBuilder::ball(RADIUS as f32),
    );
    let world = &mut rock.world;
    rock.debris
        .add(second, &mut world.bodies, &world.colliders)
        .unwrap();
    rock.tick(&list);
    assert_eq!(owned_by(&rock, second), skin);
}
