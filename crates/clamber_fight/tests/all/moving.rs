//! Weapons among moving obstacles: a fighter's ground, its target, and obstacles in between.

use std::sync::Arc;

use clamber_climber::{ClimberInput, ClimberMode};
use clamber_colossus::CreatureConfig;
use clamber_fight::actions::{CUT, STAB};
use clamber_fight::{Arena, ArenaConfig, FighterConfig};
use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, MeshSource};
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{Obstacle, ObstacleId, TriangleTerrain};
use glam::{DVec3, Vec3};

use crate::behind::{block, box_of};
use crate::support::{GIANT, GROUND, HERO, Slab, Wall, hits, mode, pressing, weak_point};

/// A box of skin that moves without turning.
struct Car(SkinnedSurface);

impl Car {
    fn new(low: Vec3, high: Vec3) -> Self {
        let (positions, mut triangles) = box_of(low, high);
        let middle = 0.5 * (low + high);
        for [a, b, c] in &mut triangles {
            let [x, y, z] = [*a, *b, *c].map(|corner| positions[corner as usize]);
            // Triangles of skin have to face outwards.
            if (y - x).cross(z - x).dot(x - middle) < 0.0 {
                std::mem::swap(b, c);
            }
        }
        let source = MeshSource::rigid(&positions, &triangles);
        let mesh = ColliderMesh::build(&source, &ColliderBuildOptions::default());
        let mut surface = SkinnedSurface::new(Arc::new(mesh.unwrap().0));
        surface.teleport(&palette(), Similarity::IDENTITY).unwrap();
        Self(surface)
    }

    fn go(&mut self, to: DVec3) {
        let there = Similarity {
            translation: to,
            ..Similarity::IDENTITY
        };
        self.0.advance(&palette(), there).unwrap();
    }
}

fn palette() -> Palette {
    Palette::from_matrices(vec![Affine::IDENTITY])
}

/// Displacement, metres, of a body that accelerates evenly to `velocity` in six seconds and then keeps it.
fn way(velocity: DVec3, time: f64) -> DVec3 {
    let start = time.min(6.0);
    velocity * (start * start / 12.0 + (time - 6.0).max(0.0))
}

/// Makes two cuts at a creature; fighter and creature stand on a moving box. Returns the number of hits.
fn cuts(velocity: DVec3, rate: f64, rock: Option<[f32; 2]>) -> usize {
    let mut cars = vec![Car::new(
        Vec3::new(-20.0, -5.0, -20.0),
        Vec3::new(20.0, -1.6, 20.0),
    )];
    cars.extend(
        rock.map(|[from, to]| Car::new(Vec3::new(-20.0, -5.0, from), Vec3::new(20.0, 20.0, to))),
    );
    let tick = 1.0 / rate;
    let on_floor = CreatureConfig {
        position: DVec3::NEG_Y * 1.6,
        ..CreatureConfig::default()
    };
    let creature = Wall {
        rate,
        ..Wall::of(4)
    };
    let mut arena = Arena::new(ArenaConfig {
        tick,
        ..ArenaConfig::default()
    })
    .unwrap();
    arena.add_creature(creature.kind(), on_floor).unwrap();
    let place = DVec3::new(0.0, -1.0, 1.25);
    let mut hero = FighterConfig::hero();
    hero.hit_stop = 0.0;
    arena.add_fighter(hero, place).unwrap();
    let mut found = 0;
    for index in 1..(11.0 * rate) as u32 {
        let time = f64::from(index) * tick;
        cars.iter_mut().for_each(|car| car.go(way(velocity, time)));
        let terrain = cars.iter().enumerate();
        let terrain = terrain.map(|(id, car)| (ObstacleId(id as u64), &car.0 as &dyn Obstacle));
        let terrain: Vec<(ObstacleId, &dyn Obstacle)> = terrain.collect();
        // The fighter turns to the creature, and then stands still.
        let input = ClimberInput {
            walk: DVec3::NEG_Z * f64::from(u8::from(time < 0.1)) * 0.1,
            aim: DVec3::NEG_Z,
            ..pressing(if [8 * rate as u32, 10 * rate as u32].contains(&index) {
                CUT
            } else {
                0
            })
        };
        found += hits(arena.step(&[input], &terrain).unwrap()).len();
    }
    assert_eq!(mode(&arena), ClimberMode::Standing);
    let place = arena.fighter(HERO).unwrap().climber().state().position;
    let drift = (place - way(velocity, 11.0 - tick)).z;
    assert!((1.0..1.4).contains(&drift), "{drift}");
    let creature = arena.creature(GIANT).unwrap().state().position();
    let carried = way(velocity, 11.0 - tick) - DVec3::Y * 1.6;
    assert!(
        creature.distance(carried) < 0.3,
        "{rate} Hz, {velocity}, {rock:?}: {creature}"
    );
    found
}

/// On a box that moves at 30 m/s, cuts hit as often as at rest. A wall close behind the fighter does not matter, and a
/// wall in front of it stops the cuts.
#[test]
fn cuts_in_a_car_are_as_at_rest() {
    for rate in [30.0, 60.0, 120.0] {
        for (what, rock) in [
            ("nothing", None),
            ("a wall behind", Some([1.75, 3.0])),
            ("a wall before", Some([0.5, 0.6])),
            ("a sheet before", Some([0.5, 0.5])),
        ] {
            let at_rest = cuts(DVec3::ZERO, rate, rock);
            assert_eq!(at_rest > 0, !what.ends_with("before"), "{what}: {at_rest}");
            for velocity in [DVec3::Z, DVec3::NEG_Z, DVec3::X, DVec3::Y] {
                let found = cuts(velocity * 30.0, rate, rock);
                assert_eq!(
                    found, at_rest,
                    "{what}, {rate} Hz, along {velocity}: {found}"
                );
            }
        }
    }
}

/// A slow stab does not hit skin that has moved out of reach since it began, or that an obstacle has covered.
#[test]
fn a_stab_does_not_follow_what_leaves() {
    let edge: TriangleTerrain = block(Vec3::new(-9.0, -9.0, 0.0), Vec3::new(9.0, 0.5, 9.0));
    let lid: TriangleTerrain = block(Vec3::new(-9.0, 0.1, -9.0), Vec3::new(9.0, 0.2, -0.05));
    let ways = [
        (0.0, 0.0, false),
        (0.0, -6.0, false),
        (0.0, -20.0, false),
        (0.0, 0.0, true),
        // Skin that comes into reach only after the strike began is not hit.
        (-2.0, 8.0, false),
    ];
    for (from, rises, closes) in ways {
        // The slab lies still for six seconds. Then it stays, sinks, or rises from below to the height of the others.
        let up = |y: f32| Vec3::Y * y;
        let until = if rises > 0.0 { -from / rises } else { 3.0 };
        let keys = vec![
            (0.0, up(from), Vec3::ONE),
            (6.0, up(from), Vec3::ONE),
            (6.0 + until, up(from + until * rises), Vec3::ONE),
            (30.0, up(from + until * rises), Vec3::ONE),
        ];
        let slab = Slab {
            keys,
            weak_points: vec![weak_point("heart", Vec3::ZERO, 9.0, 0)],
            ..Slab::default()
        };
        let mut hero = FighterConfig::hero();
        hero.sword.as_mut().unwrap().strike = 0.8;
        let mut arena = slab.arena(hero, &[DVec3::new(0.0, 1.5, 0.12)]);
        let mut found = Vec::new();
        for tick in 0..480 {
            let mut terrain: Vec<(ObstacleId, &dyn Obstacle)> = vec![(GROUND, &edge)];
            if closes && tick > 375 {
                terrain.push((ObstacleId(1), &lid));
            }
            // The strike begins before the six seconds are over, and lands after them.
            let input = ClimberInput {
                aim: DVec3::NEG_Z,
                ..pressing(if [120, 355].contains(&tick) { STAB } else { 0 })
            };
            found.extend(hits(arena.step(&[input], &terrain).unwrap()));
        }
        let stays = rises == 0.0 && !closes;
        assert_eq!(found.len(), usize::from(stays), "{rises} m/s, {closes}");
    }
}
