//! Skin that changes around rocks, and rocks that are moved into skin.

use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::{PartId, SurfaceTag, TriangleId, VertexId};
use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, Vec3};
use rapier3d::prelude::*;

use super::super::scene::{Scene, lifted, slab};
use super::{BONE, Does, Stage, extent, settings, shapes};

/// How skin is taken away from a creature and comes back.
#[derive(Clone, Copy, Debug)]
enum Change {
    Triangles,
    /// All of the creature.
    Part,
    /// Other triangles on the same vertices.
    Removed,
    /// Other triangles on other vertices.
    RemovedWithVertices,
}

/// All ways in which skin changes.
const CHANGES: [Change; 4] = [
    Change::Triangles,
    Change::Part,
    Change::Removed,
    Change::RemovedWithVertices,
];

/// The skin of a creature's top.
struct Top(Vec<(TriangleId, [VertexId; 3])>);

impl Top {
    fn of(surface: &SkinnedSurface) -> Self {
        let mesh = surface.mesh();
        let top = extent(surface).y * 0.999;
        let is_top =
            |corners: &[VertexId; 3]| corners.iter().all(|v| mesh.positions()[v.index()].y > top);
        let all = (0..).map(TriangleId).zip(mesh.triangles().iter().copied());
        Self(all.filter(|(_, corners)| is_top(corners)).collect())
    }

    fn take(&self, change: Change, surface: &mut SkinnedSurface) {
        if matches!(change, Change::Part) {
            surface.disable_part(PartId(0)).unwrap();
            return;
        }
        let triangles = self.0.iter().map(|(triangle, _)| *triangle);
        if matches!(change, Change::Triangles) {
            triangles.for_each(|one| surface.disable_triangle(one).unwrap());
        } else {
            surface.edit(|edit| triangles.for_each(|one| edit.remove_triangle(one).unwrap()));
        }
    }

    fn bring(&self, change: Change, surface: &mut SkinnedSurface) {
        let mesh = surface.mesh().clone();
        let tag = SurfaceTag::default();
        match change {
            Change::Triangles => {
                for (triangle, _) in &self.0 {
                    surface.enable_triangle(*triangle).unwrap();
                }
            }
            Change::Part => surface.enable_part(PartId(0)).unwrap(),
            Change::Removed => surface.edit(|edit| {
                for (_, corners) in &self.0 {
                    edit.add_triangle(*corners, tag).unwrap();
                }
            }),
            Change::RemovedWithVertices => surface.edit(|edit| {
                for (_, corners) in &self.0 {
                    let new = corners.map(|corner| {
                        let place = mesh.positions()[corner.index()];
                        edit.add_vertex(place, &[BONE]).unwrap()
                    });
                    edit.add_triangle(new, tag).unwrap();
                }
            }),
        }
    }
}

#[test]
fn skin_that_comes_back_leaves_no_rock_below_it() {
    let mut settings = settings();
    for (change, size) in CHANGES
        .into_iter()
        .flat_map(|change| [0.02f32, 0.3, 5.0, 100.0].map(|size| (change, size)))
    {
        // Shapes with their heights over the ground.
        for (shape, low) in [(0, 1.0), (1, 0.8)] {
            for (deep, late) in [(false, false), (false, true), (true, false), (true, true)] {
                let (rate, frame, scale) = settings.next().unwrap();
                let case = format!(
                    "{change:?}, shape {shape}, {size} m, deep {deep}, after the pose {late}, {rate} Hz, {frame} m/s"
                );
                let unit = f64::from(size);
                let half = DVec3::new(13.0, 6.0, 13.0) * unit;
                let mut stage = Stage::with_creature(rate, frame, half, scale);
                stage.allow_any_speed();
                let (shape, radius) = shapes(size).swap_remove(shape);
                let low = low * unit;
                let middle = if deep { 0.0 } else { half.y - 0.6 * radius };
                stage.ground((middle - low) as f32);
                let calm = [Does::Moves(DVec3::ZERO)];
                let top = Top::of(&stage.creatures[0].surface);
                top.take(change, &mut stage.creatures[0].surface);
                let rock = stage.rock(&shape, DVec3::new(0.3 * unit, middle, 0.2 * unit));
                // A rock that is not enclosed may be inside the creature.
                let rocks = std::mem::take(&mut stage.rocks);
                for _ in 0..rate / 4 {
                    assert_eq!(stage.tick(&case, &calm).enclosed, 0, "{case}");
                }
                assert!(!stage.debris.is_let_through(rock), "{case}");
                stage.rocks = rocks;
                let before = stage.place(rock);
                // The skin comes back before the creature is posed, or after.
                if late {
                    stage.start_tick(&calm);
                    top.bring(change, &mut stage.creatures[0].surface);
                } else {
                    top.bring(change, &mut stage.creatures[0].surface);
                    stage.start_tick(&calm);
                }
                let report = stage.step(&case, &calm);
                let wanted = if deep { (1, 1, 0) } else { (1, 0, 1) };
                let found = (report.enclosed, report.caught, report.put_out);
                assert_eq!(found, wanted, "{case}");
                for _ in 0..rate / 2 {
                    assert_eq!(stage.tick(&case, &calm).enclosed, 0, "{case}");
                }
                let place = stage.place(rock);
                if !deep {
                    let over = place.y - half.y;
                    assert!((over - low).abs() < 0.1 * unit, "{case}: {over} m over it");
                    assert!(!stage.debris.is_put_out(rock), "{case}");
                    assert!(!stage.debris.is_let_through(rock), "{case}");
                    continue;
                }
                // The creature walks on without it.
                for tick in 0..rate / 2 {
                    let along = DVec3::X * (60.0 * unit * stage.dt * f64::from(tick));
                    stage.tick(&case, &[Does::Moves(along)]);
                }
                let off = stage.place(rock) - before;
                assert!(off.length() < 0.1 * unit, "{case}: carried by {off}");
                assert!(!stage.debris.is_let_through(rock), "{case}");
            }
        }
    }
}

#[test]
fn a_rock_comes_out_of_a_creature_that_is_edited_in_every_tick() {
    for (rate, frame, scale) in settings().take(20) {
        for by_edit in [false, true] {
            let case = format!("by an edit {by_edit}, {rate} Hz, {frame} m/s, scale {scale}");
            let half = DVec3::new(4.0, 2.0, 4.0);
            let mut stage = Stage::with_creature(rate, frame, half, scale);
            let (shape, radius) = shapes(0.3).swap_remove(0);
            let rock = stage.rock(&shape, DVec3::new(0.3, half.y - 0.8 * radius, 0.2));
            let mut out = None;
            for tick in 0..rate {
                let surface = &mut stage.creatures[0].surface;
                if by_edit {
                    surface.edit(|edit| edit.add_vertex(Vec3::ZERO, &[BONE]).unwrap());
                } else if tick % 2 == 0 {
                    surface.disable_triangle(TriangleId(0)).unwrap();
                } else {
                    surface.enable_triangle(TriangleId(0)).unwrap();
                }
                stage.tick(&case, &[Does::Moves(DVec3::ZERO)]);
                assert!(!stage.debris.is_let_through(rock), "{case}, tick {tick}");
                if !stage.debris.is_put_out(rock) {
                    out = out.or(Some(f64::from(tick) * stage.dt));
                }
            }
            assert!(out.is_some_and(|out| out < 0.45), "{case}: {out:?} s");
            let over = stage.place(rock).y - half.y;
            assert!((over - 0.3).abs() < 0.03, "{case}: {over} m over the skin");
        }
    }
}

#[test]
fn a_rock_whose_way_out_is_edited_away_is_let_through() {
    for (rate, frame, scale) in settings().take(20) {
        let case = format!("{rate} Hz, {frame} m/s, scale {scale}");
        let half = DVec3::new(4.0, 2.0, 4.0);
        let mut stage = Stage::with_creature(rate, frame, half, scale);
        let calm = [Does::Moves(DVec3::ZERO)];
        let (shape, radius) = shapes(0.3).swap_remove(0);
        let rock = stage.rock(&shape, DVec3::new(0.3, half.y - 0.9 * radius, 0.2));
        assert_eq!(stage.tick(&case, &calm).put_out, 1, "{case}");
        let top = Top::of(&stage.creatures[0].surface);
        top.take(Change::Removed, &mut stage.creatures[0].surface);
        // The open box does not enclose a rock near its rim.
        let rocks = std::mem::take(&mut stage.rocks);
        stage.tick(&case, &calm);
        assert!(!stage.debris.is_put_out(rock), "{case}");
        for _ in 0..rate * 3 / 5 {
            stage.tick(&case, &calm);
        }
        stage.rocks = rocks;
        // The rock has fallen farther in.
        let depth = half.y - stage.place(rock).y;
        assert!(depth > 1.2 * radius, "{case}: {depth} m deep");
        top.bring(Change::Removed, &mut stage.creatures[0].surface);
        for _ in 0..2 * rate {
            stage.tick(&case, &calm);
        }
        let place = stage.place(rock);
        assert!(place.y < -half.y - radius, "{case}: {place}");
        assert!(!stage.debris.is_let_through(rock), "{case}");
    }
}

#[test]
fn a_limb_that_is_posed_around_a_rock_does_not_keep_it() {
    let palette = |up: f64| lifted(8, |joint| if joint >= 6 { up } else { 0.0 });
    let root = Similarity::IDENTITY;
    for moved_after in [false, true] {
        for (low, through) in [(1.0, false), (0.2, true)] {
            let mut scene = Scene::new(slab(Vec3::new(8.0, 1.0, 2.0), 0.5, 8));
            scene.ground(-1.0);
            let (rock, _) = scene.drop(ColliderBuilder::ball(0.3), Vector::new(6.8, 1.31, 0.2));
            scene.surface.teleport(&palette(0.0), root).unwrap();
            for _ in 0..60 {
                scene.tick(&palette(0.0), root);
            }
            // The last quarter jumps up around it.
            let up = 1.5 - low;
            scene.surface.teleport(&palette(up), root).unwrap();
            let case = format!("up by {up} m, moved {moved_after}");
            let mut found = 0;
            for tick in 0..120 {
                if moved_after || tick > 0 {
                    found += scene.tick(&palette(up), root).enclosed;
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
            let half = DVec3::new(6.0, 2.0, 6.0);
            let mut stage = Stage::with_creature(rate, DVec3::ZERO, half, 1.0);
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
