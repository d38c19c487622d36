//! Rocks beside open skin, which has no inside, and rocks that no skin has appeared around.

use clamber_surface::geometry::Similarity;
use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, Vec3};
use rapier3d::prelude::*;

use super::super::scene::{CREATURE, DT, Scene, at, lifted, slab};
use super::shapes;
use crate::testing::{rest, rigid};

/// A sheet of skin over a grid of `cells` by `cells`, 8 m wide, bent by `bend`; turned over if `over` is true.
fn sheet(cells: u32, over: bool, bend: impl Fn(f32, f32) -> Vec3) -> SkinnedSurface {
    let along = |step: u32| 8.0 * (step as f32 / cells as f32 - 0.5);
    let rows = (0..=cells).flat_map(|i| (0..=cells).map(move |j| (i, j)));
    let positions: Vec<Vec3> = rows.map(|(i, j)| bend(along(i), along(j))).collect();
    let mut triangles = Vec::new();
    for i in 0..cells {
        for j in 0..cells {
            let [a, b] = [i * (cells + 1) + j, (i + 1) * (cells + 1) + j];
            let both = [[a, a + 1, b + 1], [a, b + 1, b]];
            triangles.extend(both.map(|[p, q, r]| if over { [p, r, q] } else { [p, q, r] }));
        }
    }
    rigid(&positions, &triangles)
}

/// Forgets what debris knows, so that it looks at every rock again.
fn forget(scene: &mut Scene) {
    scene.debris.seen.clear();
}

/// A point of a sheet from its flat coordinates.
type Bend = fn(f32, f32) -> Vec3;

/// Open skin: flat, as a bowl, a trough and a hat.
fn open_skin() -> [(&'static str, Bend); 4] {
    [
        ("flat", |x, z| Vec3::new(x, 0.0, z)),
        ("bowl", |x, z| Vec3::new(x, 0.12 * (x * x + z * z), z)),
        ("trough", |x, z| {
            Vec3::new(x, 0.6 * x.abs() + 0.02 * z * z, z)
        }),
        ("hat", |x, z| Vec3::new(x, -0.1 * (x * x + z * z), z)),
    ]
}

#[test]
fn a_rock_on_open_skin_stays_on_it_whatever_side_that_is() {
    for (name, bend) in open_skin() {
        if name == "hat" {
            continue;
        }
        for over in [false, true] {
            for (shape, radius) in shapes(0.3) {
                let case = format!("{name}, over {over}, {:?}", shape.shape.shape_type());
                let mut scene = Scene::new(sheet(16, over, bend));
                let (rock, _) = scene.drop(shape, Vector::new(0.2, 0.7, 0.1));
                for tick in 0..400 {
                    forget(&mut scene);
                    if tick % 5 == 0 {
                        scene
                            .surface
                            .teleport(&rest(), Similarity::IDENTITY)
                            .unwrap();
                    }
                    let report = scene.tick(&rest(), Similarity::IDENTITY);
                    assert_eq!(report.enclosed, 0, "{case}, tick {tick}");
                    let place = scene.in_model(rock);
                    let under = f64::from(bend(place.x as f32, place.z as f32).y);
                    assert!(
                        place.y > under + 0.5 * radius,
                        "{case}, tick {tick}: at {place}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_rock_below_open_skin_stays_below_it() {
    for (name, bend) in open_skin() {
        for over in [false, true] {
            for (shape, _) in shapes(0.3) {
                let case = format!("{name}, over {over}, {:?}", shape.shape.shape_type());
                let mut scenes = [0, 1].map(|_| {
                    let mut scene = Scene::new(sheet(16, over, bend));
                    // The skin hangs low over the ground on which the rock lies.
                    scene.ground(-1.2);
                    let (rock, _) = scene.drop(shape.clone(), Vector::new(0.1, -0.8, 0.2));
                    (scene, rock)
                });
                for tick in 0..200 {
                    let [bits, wanted] = [0, 1].map(|index| {
                        let (scene, rock) = &mut scenes[index];
                        if index == 0 {
                            forget(scene);
                        }
                        let report = scene.tick(&rest(), Similarity::IDENTITY);
                        assert_eq!(report.enclosed, 0, "{case}, tick {tick}");
                        let body = &scene.world.bodies[*rock];
                        (*body.position(), body.linvel())
                    });
                    assert_eq!(bits, wanted, "{case}, tick {tick}");
                }
            }
        }
    }
}

#[test]
fn rocks_that_are_looked_at_again_in_every_tick_move_with_the_same_bits() {
    for half in [Vec3::new(4.0, 0.5, 4.0), Vec3::new(3.0, 3.0, 1.0)] {
        let mut scenes = [0, 1].map(|_| {
            let mut scene = Scene::new(slab(half, 0.6, 3));
            for index in 0..12 {
                let x = index as f32 * 0.3 - 2.0;
                let place = Vector::new(x, half.y + 0.7 + index as f32 * 0.4, 0.1);
                scene.drop(shapes(0.3).swap_remove(index % 4).0, place);
            }
            scene
        });
        for tick in 0..300 {
            let t = f64::from(tick) * DT;
            let palette = lifted(3, |joint| 0.2 * libm::sin(3.0 * t + joint as f64));
            let shake = DVec3::new(0.3 * libm::sin(9.0 * t), 0.0, 0.0);
            let bits = [0, 1].map(|index| {
                let scene = &mut scenes[index];
                if index == 0 {
                    forget(scene);
                }
                let report = scene.tick(&palette, at(shake, DVec3::Y, 0.1 * t));
                assert_eq!(report.enclosed, 0, "tick {tick}");
                let bodies = scene.debris.bodies().map(|body| &scene.world.bodies[body]);
                let all = bodies.map(|body| (*body.position(), body.linvel(), body.angvel()));
                all.collect::<Vec<_>>()
            });
            assert_eq!(bits[0], bits[1], "tick {tick}");
        }
    }
}

#[test]
fn rocks_are_looked_at_only_when_skin_may_have_appeared_around_them() {
    let mut scene = Scene::new(slab(Vec3::new(4.0, 0.5, 4.0), 0.6, 3));
    for index in 0..6 {
        let place = Vector::new(index as f32 - 2.5, 1.0, 0.1);
        scene.drop(ColliderBuilder::ball(0.3), place);
    }
    for tick in 0..300 {
        let t = f64::from(tick) * DT;
        let palette = lifted(3, |joint| 0.2 * libm::sin(3.0 * t + joint as f64));
        // A creature far from where it was modelled, and fast.
        let root = at(DVec3::new(3e4 + 30.0 * t, 0.0, -2e5), DVec3::Y, t);
        let origin = DVec3::new(3e4, 0.0, -2e5);
        if tick == 0 {
            scene.debris = scene.debris.clone().with_origin(origin);
            scene.surface.teleport(&palette, root).unwrap();
        }
        if tick == 120 {
            // Placed and advanced before debris sees it: it moved within the tick, but not from where it was.
            scene.surface.teleport(&palette, root).unwrap();
        }
        scene.tick(&palette, root);
        let jumped = scene.debris.seen.iter().any(|(_, seen)| seen.jumped);
        assert_eq!(jumped, tick == 0 || tick == 120, "tick {tick}");
        let known = scene
            .debris
            .seen
            .binary_search_by_key(&CREATURE, |one| one.0);
        assert_eq!(known, Ok(0));
    }
}
