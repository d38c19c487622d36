//! Skin that an edit adds above a creature's back, where rocks lie.

use clamber_surface::mesh::{SurfaceTag, TriangleId, VertexId};
use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, Vec3};

use super::{BONE, Does, Stage, extent, settings, shapes};

/// The skin below the added skin.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Below {
    Stays,
    /// The creature is one closed box then.
    IsRemoved,
}

/// Adds a box without a bottom on the top of a box-shaped creature: `wide` as a fraction of the creature's width, and
/// `high` in model space.
fn grow(surface: &mut SkinnedSurface, wide: f32, high: f32, below: Below) {
    let half = extent(surface);
    let mesh = surface.mesh().clone();
    surface.edit(|edit| {
        if below == Below::IsRemoved {
            for (triangle, corners) in (0..).map(TriangleId).zip(mesh.triangles()) {
                let is_top = |v: &VertexId| mesh.positions()[v.index()].y > half.y * 0.999;
                if corners.iter().all(is_top) {
                    edit.remove_triangle(triangle).unwrap();
                }
            }
        }
        let around = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]];
        let places = [half.y, half.y + high]
            .map(|y| around.map(|[x, z]| Vec3::new(x * half.x * wide, y, z * half.z * wide)));
        let [low, up] =
            places.map(|ring| ring.map(|place| edit.add_vertex(place, &[BONE]).unwrap()));
        let mut add = |corners| edit.add_triangle(corners, SurfaceTag::default()).unwrap();
        add([up[0], up[1], up[2]]);
        add([up[0], up[2], up[3]]);
        for side in 0..4 {
            let next = (side + 1) % 4;
            add([low[side], low[next], up[next]]);
            add([low[side], up[next], up[side]]);
        }
    });
}

#[test]
fn skin_that_is_added_over_a_rock_on_a_creature_does_not_keep_it() {
    let mut settings = settings();
    for below in [Below::IsRemoved, Below::Stays] {
        for size in [0.02f32, 0.3, 5.0, 100.0] {
            for shape in 0..4 {
                // Depths of the rock below the new skin, in radii. With the first two, a part of the rock shows.
                for deep in [0.5, 0.9, 1.5, 3.0] {
                    let (rate, frame, scale) = settings.next().unwrap();
                    let case = format!(
                        "below {below:?}, shape {shape}, {size} m, {deep} deep, {rate} Hz, {frame} m/s"
                    );
                    let unit = f64::from(size);
                    let half = DVec3::new(8.0, 4.0, 8.0) * unit;
                    let mut stage = Stage::with_creature(rate, frame, half, scale);
                    stage.allow_any_speed();
                    let calm = [Does::Moves(DVec3::ZERO)];
                    let (shape, radius) = shapes(size).swap_remove(shape);
                    let start = DVec3::new(0.3 * unit, half.y + 1.1 * unit, -0.4 * unit);
                    let rock = stage.rock(&shape, start);
                    for _ in 0..rate / 2 {
                        assert_eq!(stage.tick(&case, &calm).enclosed, 0, "{case}");
                    }
                    let high = stage.place(rock).y + deep * radius - half.y;
                    let surface = &mut stage.creatures[0].surface;
                    grow(surface, 1.0, (high / scale) as f32, below);
                    let mut report = stage.tick(&case, &calm);
                    assert_eq!(report.enclosed, 1, "{case}");
                    assert_eq!(report.put_out, u32::from(deep < 1.0), "{case}");
                    // As long as a fall through the whole creature takes.
                    let seconds = (2.0 * 20.0 * unit / 9.81).sqrt().max(1.0);
                    for tick in 0..(seconds / stage.dt) as u32 {
                        let within = stage.place(rock) - DVec3::Y * high * 0.5;
                        let within = within.abs() - half - DVec3::Y * high * 0.5;
                        let passes = report.caught + report.put_out;
                        assert!(
                            within.max_element() > 0.0 || passes == 1,
                            "{case}: {within} in, in tick {tick}"
                        );
                        report = stage.tick(&case, &calm);
                        assert_eq!(report.enclosed, 0, "{case}, tick {tick}");
                    }
                    let place = stage.place(rock);
                    assert_eq!(report.caught + report.put_out, 0, "{case}: {place}");
                    if deep < 1.0 {
                        let over = place.y - half.y - high;
                        assert!(over > 0.5 * radius, "{case}: {over} m over the skin");
                        assert!(over < 1.2 * unit, "{case}: {over} m over the skin");
                    } else {
                        assert!(place.y < -half.y - radius, "{case}: {place}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_rock_in_a_closed_hollow_is_let_through_for_as_long_as_it_is_there() {
    for (rate, frame, scale) in settings().take(20) {
        let case = format!("{rate} Hz, {frame} m/s, scale {scale}");
        let half = DVec3::new(4.0, 1.0, 4.0);
        let mut stage = Stage::with_creature(rate, frame, half, scale);
        stage.world.gravity = Vec3::ZERO;
        let (shape, _) = shapes(0.3).swap_remove(0);
        let place = DVec3::Y * 1.33;
        let rock = stage.rock(&shape, place);
        stage.tick(&case, &[Does::Moves(DVec3::ZERO)]);
        let surface = &mut stage.creatures[0].surface;
        grow(surface, 0.9, (2.0 / scale) as f32, Below::Stays);
        for _ in 0..rate {
            stage.tick(&case, &[Does::Moves(DVec3::ZERO)]);
            assert!(stage.debris.is_let_through(rock), "{case}");
        }
        // The hollow moves away from the rock.
        for tick in 0..rate {
            let along = DVec3::X * (9.0 * stage.dt * f64::from(tick));
            stage.tick(&case, &[Does::Moves(along)]);
        }
        assert!(!stage.debris.is_let_through(rock), "{case}");
        let off = stage.place(rock) - place;
        assert!(off.length() < 0.01, "{case}: carried by {off}");
    }
}

#[test]
fn skin_that_is_added_beside_a_rock_does_not_touch_it() {
    for (rate, frame, scale) in settings().take(20) {
        for below in [Below::Stays, Below::IsRemoved] {
            let case = format!("below {below:?}, {rate} Hz, {frame} m/s, scale {scale}");
            let [(mut stage, rock), (mut control, same)] = [0, 1].map(|_| {
                let half = DVec3::new(4.0, 1.0, 4.0);
                let mut stage = Stage::with_creature(rate, frame, half, scale);
                let (shape, _) = shapes(0.3).swap_remove(1);
                let rock = stage.rock(&shape, DVec3::new(5.0, 1.0, 0.2));
                (stage, rock)
            });
            for tick in 0..rate {
                if tick == 3 {
                    let surface = &mut stage.creatures[0].surface;
                    grow(surface, 1.0, (2.0 / scale) as f32, below);
                }
                let [report, wanted] = [&mut stage, &mut control]
                    .map(|stage| stage.tick(&case, &[Does::Moves(DVec3::ZERO)]));
                assert_eq!((report, stage.bits()), (wanted, control.bits()), "{case}");
            }
            assert_eq!(stage.place(rock), control.place(same), "{case}");
        }
    }
}

#[test]
fn a_rock_that_cannot_come_out_of_a_creature_that_is_placed_again_and_again_is_let_through() {
    // Skin that is placed counts as standing still for rocks: in a faster frame, they would come in from the side in
    // every tick.
    let slow = settings().filter(|(_, frame, _)| frame.length() < 100.0);
    for (rate, frame, scale) in slow.take(16) {
        let case = format!("{rate} Hz, {frame} m/s, scale {scale}");
        let half = DVec3::new(4.0, 2.0, 4.0);
        let mut stage = Stage::with_creature(rate, frame, half, scale);
        stage.world.gravity = Vec3::ZERO;
        let (shape, radius) = shapes(0.3).swap_remove(0);
        let rock = stage.rock(&shape, DVec3::Y * (2.0 - 0.5 * radius));
        let mut waits = 0.0;
        for tick in 0..2 * rate {
            // The creature is placed in every tick, so its motion is unknown.
            let aside = DVec3::X * (0.1 * f64::from(tick % 2));
            let report = stage.tick(&case, &[Does::IsPlaced(aside)]);
            waits += f64::from(report.put_out) * stage.dt;
        }
        assert!(stage.debris.is_let_through(rock), "{case}");
        // The time limit of a rock on its way: twice the time for 1.5 radii.
        assert!(waits > 0.5 && waits < 0.65, "{case}: {waits} s");
    }
}
