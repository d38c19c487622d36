//! Tests that meshes, shadows and overlays are drawn at their right places, and that bad input is an error.

use crate::common;

use clamber_render::{
    Camera, Drawn, Frame, Image, Light, Overlay, RenderError, RenderMesh, RenderMeshId, Renderer,
    SkinSource,
};
use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::Influence;
use clamber_surface::rig::{JointId, Palette};
use glam::{DVec3, Vec3};

/// Width of the picture, pixels.
const WIDTH: u32 = 200;
/// Height of the picture, pixels.
const ROWS: u32 = 120;

/// Corners of a square of 2 m around the origin, perpendicular to Z.
const SQUARE: [Vec3; 4] = [
    Vec3::new(-1.0, -1.0, 0.0),
    Vec3::new(1.0, -1.0, 0.0),
    Vec3::new(1.0, 1.0, 0.0),
    Vec3::new(-1.0, 1.0, 0.0),
];

/// Adds a red square of 2 m around the origin, perpendicular to Z, on one joint.
fn square(renderer: &mut Renderer) -> RenderMeshId {
    let influence = Influence {
        joint: JointId(0),
        weight: 1.0,
    };
    let mesh = renderer.add_mesh(&RenderMesh {
        positions: &SQUARE,
        colors: &[[1.0, 0.0, 0.0]; 4],
        triangles: &[[0, 1, 2], [0, 2, 3]],
        skin: Some(SkinSource {
            influences: &[influence; 4],
            ends: &[1, 2, 3, 4],
            joint_count: 1,
        }),
        ..RenderMesh::default()
    });
    mesh.unwrap()
}

fn frame<'a>(origin: DVec3, drawn: Vec<Drawn<'a>>) -> Frame<'a> {
    Frame {
        camera: Camera::new(origin + DVec3::Z * 6.0, origin),
        light: Light {
            to_sun: Vec3::new(0.3, 0.5, 1.0),
            fog: 0.0,
            ..Light::over(origin, 8.0)
        },
        drawn,
        overlay: Overlay::default(),
    }
}

fn at(mesh: RenderMeshId, place: DVec3) -> Drawn<'static> {
    Drawn {
        mesh,
        world_from_model: Similarity::from_translation(place),
        palette: None,
    }
}

/// The mean column and row, and the number, of the pixels for which `wanted` is true.
fn find(image: &Image, wanted: impl Fn([u8; 4]) -> bool) -> (f64, f64, u32) {
    let (mut x, mut y, mut count) = (0.0, 0.0, 0u32);
    for (index, pixel) in image.pixels.chunks_exact(4).enumerate() {
        if wanted([pixel[0], pixel[1], pixel[2], pixel[3]]) {
            x += f64::from(index as u32 % image.width) + 0.5;
            y += f64::from(index as u32 / image.width) + 0.5;
            count += 1;
        }
    }
    let number = f64::from(count.max(1));
    (x / number, y / number, count)
}

fn is_red([red, green, blue, _]: [u8; 4]) -> bool {
    red > 60 && u32::from(red) > 2 * (u32::from(green) + u32::from(blue)) / 2 + 30
}

fn is_green([red, green, blue, _]: [u8; 4]) -> bool {
    green > 100 && red < 90 && blue < 90
}

fn renderer(what: &str) -> Option<Renderer> {
    Some(Renderer::new(common::gpu(what)?, WIDTH, ROWS).unwrap())
}

#[test]
fn a_square_is_drawn_at_its_place_near_the_origin_and_far_from_it() {
    let Some(mut renderer) = renderer("places") else {
        return;
    };
    let mesh = square(&mut renderer);
    // Half of the picture's height shows 6 m times the tangent of half the field of view.
    let metre = f64::from(ROWS) / 2.0 / (6.0 * libm::tan(25f64.to_radians()));
    for origin in [DVec3::ZERO, DVec3::new(1e5, 3e3, -2e5)] {
        for aside in [DVec3::ZERO, DVec3::new(1.5, -0.5, 0.0)] {
            let image = renderer.draw(&frame(origin, vec![at(mesh, origin + aside)]));
            let (x, y, count) = find(&image.unwrap(), is_red);
            let expected = DVec3::new(
                f64::from(WIDTH) / 2.0 + aside.x * metre,
                f64::from(ROWS) / 2.0 - aside.y * metre,
                4.0 * metre * metre,
            );
            assert!(
                (x - expected.x).abs() < 0.5,
                "{origin} {aside}: {x} {expected}"
            );
            assert!(
                (y - expected.y).abs() < 0.5,
                "{origin} {aside}: {y} {expected}"
            );
            let share = f64::from(count) / expected.z;
            assert!((0.93..1.07).contains(&share), "{origin} {aside}: {share}");
        }
    }
}

#[test]
fn palettes_move_two_instances_of_a_mesh_independently() {
    let Some(mut renderer) = renderer("poses") else {
        return;
    };
    let mesh = square(&mut renderer);
    let moved = |by: f32| {
        let mut matrix = Affine::IDENTITY;
        matrix.rows[0][3] = by;
        Palette::from_matrices([matrix])
    };
    let (left, right) = (moved(-2.5), moved(2.5));
    let posed = |palette| Drawn {
        palette: Some(palette),
        ..at(mesh, DVec3::ZERO)
    };
    let alone = renderer
        .draw(&frame(DVec3::ZERO, vec![posed(&left)]))
        .unwrap();
    let (x, _, one) = find(&alone, is_red);
    assert!(x < f64::from(WIDTH) * 0.35, "{x}");
    let both = vec![posed(&left), posed(&right)];
    let both = renderer.draw(&frame(DVec3::ZERO, both)).unwrap();
    let (x, _, two) = find(&both, is_red);
    assert!((x - f64::from(WIDTH) / 2.0).abs() < 1.0, "{x}");
    assert!((two as f64 / one as f64 - 2.0).abs() < 0.05, "{two} {one}");
}

#[test]
fn a_nearer_mesh_hides_the_one_behind_it_and_casts_a_shadow_on_it() {
    let Some(mut renderer) = renderer("shadows") else {
        return;
    };
    let mesh = square(&mut renderer);
    let wall = renderer.add_mesh(&RenderMesh {
        positions: &SQUARE.map(|p| p * 6.0),
        triangles: &[[0, 1, 2], [0, 2, 3]],
        ..RenderMesh::default()
    });
    let wall = at(wall.unwrap(), DVec3::new(0.0, 0.0, -1.5));
    let draw = |renderer: &mut Renderer, drawn| renderer.draw(&frame(DVec3::ZERO, drawn)).unwrap();
    let bare = draw(&mut renderer, vec![wall]);
    // The order of the meshes does not matter.
    for drawn in [
        vec![wall, at(mesh, DVec3::ZERO)],
        vec![at(mesh, DVec3::ZERO), wall],
    ] {
        let image = draw(&mut renderer, drawn);
        assert!(find(&image, is_red).2 > 500);
        let pairs = image
            .pixels
            .chunks_exact(4)
            .zip(bare.pixels.chunks_exact(4));
        let darker = pairs.filter(|(now, before)| {
            let sum = |pixel: &[u8]| pixel[..3].iter().map(|c| u32::from(*c)).sum::<u32>();
            !is_red([now[0], now[1], now[2], now[3]]) && sum(now) + 60 < sum(before)
        });
        let darker = darker.count();
        assert!(darker > 100, "{darker} pixels in shadow");
    }
}

#[test]
fn overlays_are_at_their_place_in_the_world_and_faint_behind_meshes() {
    let Some(mut renderer) = renderer("overlays") else {
        return;
    };
    let mesh = square(&mut renderer);
    let overlay = |z: f64| {
        let mut overlay = Overlay::default();
        let corner = |x: f64, y: f64| DVec3::new(x, y, z);
        let corners = [corner(-0.4, -0.4), corner(0.4, -0.4), corner(0.0, 0.5)];
        overlay.triangle(corners, [0.0, 1.0, 0.0, 1.0]);
        overlay
    };
    let with = |overlay| Frame {
        overlay,
        ..frame(DVec3::ZERO, vec![at(mesh, DVec3::ZERO)])
    };
    let before = renderer.draw(&with(overlay(0.1))).unwrap();
    let (x, y, count) = find(&before, is_green);
    assert!(
        (x - f64::from(WIDTH) / 2.0).abs() < 1.0 && count > 100,
        "{x} {count}"
    );
    assert!((y - f64::from(ROWS) / 2.0).abs() < 4.0, "{y}");
    let behind = renderer.draw(&with(overlay(-0.5))).unwrap();
    assert_eq!(find(&behind, is_green).2, 0);
    let bare = renderer.draw(&with(Overlay::default())).unwrap();
    assert_ne!(behind.pixels, bare.pixels);
    // A line has its width in pixels, near and far.
    for (z, width) in [(0.1, 3.0), (0.1, 8.0), (3.0, 8.0)] {
        let mut line = Overlay::default();
        let end = |y: f64| DVec3::new(0.02, y, z);
        line.line(end(-9.0), end(9.0), width, [0.0, 1.0, 0.0, 1.0]);
        let image = renderer.draw(&with(line)).unwrap();
        let found = f64::from(find(&image, is_green).2) / f64::from(ROWS);
        assert!(
            (found - f64::from(width)).abs() <= 1.0,
            "{width} at {z}: {found}"
        );
    }
}

#[test]
fn an_empty_frame_is_sky_and_an_empty_mesh_is_nothing() {
    let Some(mut renderer) = renderer("nothing") else {
        return;
    };
    let sky = renderer.draw(&frame(DVec3::ZERO, Vec::new())).unwrap();
    assert!(sky.pixels.chunks_exact(4).all(|pixel| pixel[2] > 20));
    let nothing = RenderMesh {
        skin: Some(SkinSource {
            joint_count: 1,
            ..SkinSource::default()
        }),
        ..RenderMesh::default()
    };
    let mesh = renderer.add_mesh(&nothing).unwrap();
    let palette = Palette::from_matrices([Affine::IDENTITY]);
    let drawn = Drawn {
        palette: Some(&palette),
        ..at(mesh, DVec3::ZERO)
    };
    let seen = renderer.draw(&frame(DVec3::ZERO, vec![drawn])).unwrap();
    assert_eq!(seen, sky);
    assert_eq!(renderer.posed_positions(mesh, &palette).unwrap(), []);
}

#[test]
fn the_same_frame_gives_the_same_picture() {
    let Some(mut renderer) = renderer("repeats") else {
        return;
    };
    let mesh = square(&mut renderer);
    let frame = frame(DVec3::ZERO, vec![at(mesh, DVec3::new(0.3, 0.2, 0.1))]);
    let first = renderer.draw(&frame).unwrap();
    let uploaded = renderer.uploaded();
    assert_eq!(renderer.draw(&frame).unwrap(), first);
    assert_eq!(renderer.uploaded(), uploaded);
    assert!(uploaded < 1000, "{uploaded} bytes");
}

#[test]
fn frames_and_meshes_that_cannot_be_drawn_are_errors() {
    let Some(mut renderer) = renderer("errors") else {
        return;
    };
    let mesh = square(&mut renderer);
    let good = || frame(DVec3::ZERO, vec![at(mesh, DVec3::ZERO)]);
    let mut frames = Vec::new();
    for camera in [
        Camera::new(DVec3::ZERO, DVec3::ZERO),
        Camera::new(DVec3::ZERO, DVec3::Y),
        Camera::new(DVec3::NAN, DVec3::X),
        Camera {
            field_of_view: 0.0,
            ..Camera::new(DVec3::ZERO, DVec3::X)
        },
    ] {
        frames.push(Frame { camera, ..good() });
    }
    let dark = Light {
        to_sun: Vec3::ZERO,
        ..good().light
    };
    frames.push(Frame {
        light: dark,
        ..good()
    });
    let flat = Light {
        shadow_radius: 0.0,
        ..good().light
    };
    frames.push(Frame {
        light: flat,
        ..good()
    });
    let lost = at(mesh, DVec3::splat(f64::INFINITY));
    frames.push(frame(DVec3::ZERO, vec![lost]));
    for frame in &frames {
        let result = renderer.draw(frame).map(|_| ());
        assert!(
            matches!(result, Err(RenderError::Frame(_))),
            "{frame:?}: {result:?}"
        );
    }
    for source in [
        RenderMesh {
            positions: &SQUARE,
            triangles: &[[0, 1, 4]],
            ..RenderMesh::default()
        },
        RenderMesh {
            positions: &[Vec3::NAN],
            ..RenderMesh::default()
        },
        RenderMesh {
            positions: &SQUARE,
            colors: &[[1.0; 3]; 3],
            ..RenderMesh::default()
        },
        RenderMesh {
            positions: &SQUARE,
            skin: Some(SkinSource {
                influences: &[Influence {
                    joint: JointId(3),
                    weight: 1.0,
                }],
                ends: &[1, 1, 1, 1],
                joint_count: 3,
            }),
            ..RenderMesh::default()
        },
    ] {
        let result = renderer.add_mesh(&source);
        assert!(
            matches!(result, Err(RenderError::Mesh(_))),
            "{source:?}: {result:?}"
        );
    }
    // The renderer can still draw.
    assert!(find(&renderer.draw(&good()).unwrap(), is_red).2 > 500);
}

#[test]
fn sizes_that_no_device_has_are_errors() {
    for (width, rows) in [(0, 10), (10, 0), (1 << 20, 10)] {
        let Some(gpu) = common::gpu("sizes") else {
            return;
        };
        let result = Renderer::new(gpu, width, rows).map(|_| ());
        assert!(matches!(result, Err(RenderError::Frame(_))), "{result:?}");
    }
}
