//! Tests that faces in the sun are lit evenly, and that faces behind a wall are not lit.

use crate::common;

use clamber_render::{Camera, Drawn, Frame, Light, Overlay, RenderMesh, Renderer};
use clamber_surface::geometry::Similarity;
use glam::{DVec3, Vec3};

/// Width and height of the picture, pixels.
const SIDE: u32 = 120;

/// Whether a wall stands between the ground and the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sun {
    Free,
    BehindAWall,
}

/// The darkest and the lightest pixel in the middle of a picture of a square of 40 m, seen from +Z. `height` is the
/// sine of the sun's angle above the square, and `lean` is how far the square's normals lean towards the sun.
fn lit(renderer: &mut Renderer, height: f32, lean: f32, sun: Sun) -> [u8; 2] {
    let to_sun = Vec3::new((1.0 - height * height).sqrt(), 0.0, height);
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let corners = corners.map(|[x, y]: [f32; 2]| Vec3::new(20.0 * x, 20.0 * y, 0.0));
    let normal = (Vec3::Z + to_sun * lean).normalize();
    let ground = renderer.add_mesh(&RenderMesh {
        positions: &corners,
        normals: &[normal; 4],
        colors: &[[0.2; 3]; 4],
        triangles: &[[0, 1, 2], [0, 2, 3]],
        ..RenderMesh::default()
    });
    // A wall between the sun and a part of the square.
    let wall = [
        [3.0, -20.0, 0.0],
        [3.0, 20.0, 0.0],
        [3.0, 20.0, 9.0],
        [3.0, -20.0, 9.0],
    ];
    let wall = renderer.add_mesh(&RenderMesh {
        positions: &wall.map(Vec3::from_array),
        triangles: &[[0, 1, 2], [0, 2, 3]],
        ..RenderMesh::default()
    });
    let drawn = |mesh| Drawn {
        mesh,
        world_from_model: Similarity::IDENTITY,
        palette: None,
    };
    let mut frame = Frame {
        camera: Camera::new(DVec3::Z * 20.0, DVec3::ZERO),
        light: Light {
            to_sun,
            fog: 0.0,
            // Texels of at least 10 cm are half a pixel wide, so bands of them would show.
            ..Light::over(DVec3::ZERO, 100.0)
        },
        drawn: vec![drawn(ground.unwrap())],
        overlay: Overlay::default(),
    };
    if sun == Sun::BehindAWall {
        frame.drawn.push(drawn(wall.unwrap()));
    }
    let image = renderer.draw(&frame).unwrap();
    let mut found = [u8::MAX, 0];
    for row in SIDE / 4..SIDE * 3 / 4 {
        for column in SIDE / 4..SIDE / 2 {
            let green = image.pixels[((row * SIDE + column) * 4 + 1) as usize];
            found = [found[0].min(green), found[1].max(green)];
        }
    }
    found
}

#[test]
fn a_face_shows_no_bands_of_its_own_shadow_but_the_shadow_of_a_wall() {
    let Some(gpu) = common::gpu("bands") else {
        return;
    };
    let mut renderer = Renderer::new(gpu, SIDE, SIDE).unwrap();
    for height in [0.12, 0.2, 0.4, 0.7, 0.95] {
        for lean in [0.0, 0.5, 2.0] {
            let [darkest, lightest] = lit(&mut renderer, height, lean, Sun::Free);
            println!("{height} {lean}: {darkest} to {lightest}");
            assert!(
                lightest - darkest <= 2,
                "{height} {lean}: {darkest} to {lightest}"
            );
            if height < 0.7 {
                let [shadow, to] = lit(&mut renderer, height, lean, Sun::BehindAWall);
                assert!(
                    to - shadow <= 2,
                    "{height} {lean}: shadow from {shadow} to {to}"
                );
                assert!(
                    shadow + 8 < darkest,
                    "{height} {lean}: {shadow} in the shadow of {darkest}"
                );
            }
        }
    }
}
