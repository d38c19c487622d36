//! Skin that changes around rocks, and rocks that are moved into skin.

use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::{SurfaceTag, TriangleId, VertexId};
use glam::{DVec3, Vec3};
use rapier3d::prelude::*;

use super::super::scene::{Scene, lifted, slab};
use super::{Does, Stage, shapes};

#[test]
fn skin_that_shows_again_leaves_no_rock_below_it() {
    for by_edit in [false, true] {
        for rate in [30, 240] {
            let case = format!("by an edit {by_edit}, {rate} Hz");
            let mut stage = Stage::new(rate, DVec3::ZERO);
            stage.creature(3, DVec3::new(4.0, 2.0, 4.0), 1.0);
            stage.ground(-1.9);
            stage.pose(&[Does::IsPlaced(DVec3::ZERO)]);
            let calm = [Does::Moves(DVec3::ZERO)];
            // The top is missing.
            let surface = &mut stage.creatures[0].surface;
            let mesh = surface.mesh().clone();
            let is_top = |corners: &[VertexId; 3]| {
                corners.iter().all(|v| mesh.positions()[v.index()].y > 1.99)
            };
            let all = (0..).map(TriangleId).zip(mesh.triangles());
            let top: Vec<_> = all.filter(|(_, corners)| is_top(corners)).collect();
            for (triangle, _) in &top {
                if by_edit {
                    surface.edit(|edit| edit.remove_triangle(*triangle).unwrap());
                } else {
                    surface.disable_triangle(*triangle).unwrap();
                }
            }
            let (shape, _) = shapes(0.3).remove(0);
            let rock = stage.rock(&shape, DVec3::new(0.3, 3.0, 0.2));
            let rocks = std::mem::take(&mut stage.rocks);
            for _ in 0..2 * rate {
                stage.tick(&case, &calm);
            }
            // It has fallen into the creature, which encloses it not.
            assert!(stage.place(rock).y < -1.5, "{case}");
            assert!(!stage.debris.is_let_through(rock), "{case}");
            stage.rocks = rocks;
            let surface = &mut stage.creatures[0].surface;
            for (triangle, corners) in top {
                if by_edit {
                    let tag = SurfaceTag::default();
                    surface.edit(|edit| edit.add_triangle(*corners, tag).unwrap());
                } else {
                    surface.enable_triangle(triangle).unwrap();
                }
            }
            let report = stage.tick(&case, &calm);
            assert_eq!((report.enclosed, report.caught), (1, 1), "{case}");
        }
    }
}

#[test]
fn a_limb_that_is_posed_around_a_rock_does_not_keep_it() {
    let palette = |up: f64| lifted(8, |joint| if joint >= 6 { up } else { 0.0 });
    for moved_after in [false, true] {
        for (low, through) in [(1.0, false), (0.2, true)] {
            let mut scene = Scene::new(slab(Vec3::new(8.0, 1.0, 2.0), 0.5, 8));
            scene.ground(-1.0);
            let (rock, _) = scene.drop(ColliderBuilder::ball(0.3), Vector::new(6.8, 1.31, 0.2));
            scene
                .surface
                .place(&palette(0.0), Similarity::IDENTITY)
                .unwrap();
            for _ in 0..60 {
                scene.tick(&palette(0.0), Similarity::IDENTITY);
            }
            // The last quarter jumps up around it.
            let up = 1.5 - low;
            scene
                .surface
                .place(&palette(up), Similarity::IDENTITY)
                .unwrap();
            let case = format!("up by {up} m, moved {moved_after}");
            let mut found = 0;
            for tick in 0..120 {
                if moved_after || tick > 0 {
                    found += scene.tick(&palette(up), Similarity::IDENTITY).enclosed;
                } else {
                    found += scene.step().enclosed;
                }
            }
            assert_eq!(found, 1, "{case}");
            let place = scene.in_model(rock);
            assert_eq!(place.y < 1.0, through, "{case}: at {place}");
            assert!(through || place.y > 1.28 + up, "{case}: at {place}");
        }
    }
}

#[test]
fn a_rock_that_the_game_moves_into_a_creature_does_not_stay_there() {
    for rate in [30, 60, 240] {
        for (deep, through) in [(0.2, false), (1.0, true)] {
            let case = format!("{deep} m deep, {rate} Hz");
            let mut stage = Stage::new(rate, DVec3::ZERO);
            stage.creature(3, DVec3::new(6.0, 2.0, 6.0), 1.0);
            stage.pose(&[Does::IsPlaced(DVec3::ZERO)]);
            let (shape, _) = shapes(0.3).remove(0);
            let rock = stage.rock(&shape, DVec3::Y * 2.3);
            for tick in 0..3 * rate {
                if tick == rate {
                    let body = &mut stage.world.bodies[rock];
                    body.set_translation(Vector::new(1.0, 2.0 - deep, 0.5), true);
                }
                stage.tick(&case, &[Does::Moves(DVec3::ZERO)]);
            }
            let place = stage.place(rock);
            assert_eq!(place.y < -2.0, through, "{case}: {place}");
            assert!(place.y.abs() > 2.25, "{case}: {place}");
        }
    }
}

#[test]
fn a_rock_that_was_disabled_while_skin_came_does_not_stay_in_it() {
    let mut stage = Stage::new(60, DVec3::ZERO);
    stage.creature(3, DVec3::new(6.0, 2.0, 6.0), 1.0);
    let far = DVec3::X * 20.0;
    stage.pose(&[Does::IsPlaced(far)]);
    let (shape, _) = shapes(0.3).remove(0);
    let rock = stage.rock(&shape, DVec3::ZERO);
    stage.world.gravity = Vector::ZERO;
    for tick in 0..300 {
        let back = (f64::from(tick) * 0.2).min(20.0);
        stage.world.bodies[rock].set_enabled(!(10..150).contains(&tick));
        if tick < 150 {
            // A rock that does not collide with anything may be inside.
            stage.rocks.clear();
        } else {
            stage.rocks = vec![rock];
        }
        stage.tick("disabled", &[Does::Moves(far - DVec3::X * back)]);
    }
    assert!(stage.debris.is_let_through(rock));
}
