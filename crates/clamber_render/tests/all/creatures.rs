//! The rendered skin agrees with the surface that queries use: on the giant, and on models from files.

use crate::common;

use clamber_render::{Camera, Drawn, Frame, Image, Light, Look, Overlay, RenderMesh, Renderer};
use clamber_scenes::giant::giant;
use clamber_scenes::picture::add_collider;
use clamber_scenes::{Creature, test_data};
use clamber_surface::geometry::Similarity;
use clamber_surface::rig::{Palette, Playback};
use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, Vec3};

fn palettes(creature: &Creature) -> Vec<Palette> {
    let rest = creature.rig.skeleton.rest_pose();
    let mut palettes = vec![creature.rig.skeleton.palette(&rest).unwrap()];
    for clip in &creature.rig.clips {
        let pose = clip
            .sample(&rest, 0.37 * clip.duration(), Playback::Loop)
            .unwrap();
        palettes.push(creature.rig.skeleton.palette(&pose).unwrap());
    }
    palettes
}

#[test]
fn the_device_poses_the_skin_as_the_collider_does() {
    let Some(gpu) = common::gpu("posing") else {
        return;
    };
    let mut renderer = Renderer::new(gpu, 16, 16).unwrap();
    let mut creatures = vec![giant().unwrap()];
    creatures.extend(test_data::five_creatures("posing").unwrap());
    for creature in &creatures {
        let mesh = add_collider(&mut renderer, &creature.rig.collider, [1.0; 3]).unwrap();
        let (mut worst, mut poses) = (0.0f64, 0);
        for palette in palettes(creature) {
            let posed = renderer.posed_positions(mesh, &palette).unwrap();
            let skinned =
                clamber_surface::skin::skin(&creature.rig.collider, palette.matrices()).unwrap();
            let far = |bound: Vec3, p: &Vec3| bound.max(p.abs());
            let extent = f64::from(skinned.iter().fold(Vec3::ZERO, far).max_element());
            for (seen, touched) in posed.iter().zip(&skinned) {
                let off = (seen.as_dvec3() - touched.as_dvec3()).length();
                worst = worst.max(off / extent);
            }
            poses += 1;
        }
        println!(
            "{}: {poses} poses, off by {worst:.1e} of the extent",
            creature.name
        );
        assert!(worst <= 1e-5, "{}: {worst}", creature.name);
    }
}

/// Columns and rows of the pixels for which `wanted` returns true.
fn find(image: &Image, wanted: impl Fn([u8; 3]) -> bool) -> Vec<[f64; 2]> {
    let pixels = image.pixels.chunks_exact(4).enumerate();
    let found = pixels.filter(|(_, pixel)| wanted([pixel[0], pixel[1], pixel[2]]));
    let place = |index: usize| {
        let (column, row) = (index as u32 % image.width, index as u32 / image.width);
        [f64::from(column) + 0.5, f64::from(row) + 0.5]
    };
    found.map(|(index, _)| place(index)).collect()
}

fn mean(places: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|axis| places.iter().map(|p| p[axis]).sum::<f64>() / places.len() as f64)
}

#[test]
fn the_climber_stands_on_the_creature_and_its_triangle_lies_under_its_foot() {
    /// Width of the picture, pixels.
    const WIDTH: u32 = 480;
    /// Height of the picture, pixels.
    const ROWS: u32 = 360;
    let Some(gpu) = common::gpu("contact") else {
        return;
    };
    let giant = giant().unwrap();
    let mut renderer = Renderer::new(gpu, WIDTH, ROWS).unwrap();
    let skin = add_collider(&mut renderer, &giant.rig.collider, [0.0, 0.0, 1.0]).unwrap();
    // The climber is drawn as a pillar on its contact.
    let corners: Vec<Vec3> = (0..8)
        .map(|i| {
            let side = |bit: u32| if i >> bit & 1 == 1 { 0.2 } else { -0.2 };
            Vec3::new(side(0), if i >> 2 == 1 { 3.0 } else { 0.0 }, side(1))
        })
        .collect();
    let sides = [
        [0, 1, 5, 4],
        [1, 3, 7, 5],
        [3, 2, 6, 7],
        [2, 0, 4, 6],
        [4, 5, 7, 6],
    ];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, c, b], [a, d, c]];
    let triangles: Vec<[u32; 3]> = sides.into_iter().flat_map(halves).collect();
    let figure = renderer.add_mesh(&RenderMesh {
        positions: &corners,
        colors: &[[1.0, 0.0, 0.0]; 8],
        triangles: &triangles,
        ..RenderMesh::default()
    });
    let figure = figure.unwrap();
    let mut surface = SkinnedSurface::new(giant.rig.collider.clone());
    let root = Similarity::from_translation(DVec3::new(3e4, 0.0, -7e3));
    for palette in palettes(&giant) {
        surface.teleport(&palette, root).unwrap();
        let above = root.translation + DVec3::new(0.4, 60.0, 0.4);
        let hit = surface.in_world().cast_ray(above, -DVec3::Y, 100.0);
        let Some(hit) = hit.filter(|hit| hit.normal.y > 0.4) else {
            continue;
        };
        let drawn = |mesh, place: Similarity, palette| Drawn {
            mesh,
            world_from_model: place,
            palette,
        };
        let mut frame = Frame {
            // From the side and above.
            camera: Camera::new(hit.point + DVec3::new(6.0, 8.0, 3.0), hit.point),
            light: Light {
                fog: 0.0,
                ..Light::over(hit.point, 10.0)
            },
            drawn: vec![drawn(skin, root, Some(&palette))],
            overlay: Overlay::default(),
        };
        let corners = surface.mesh().triangles()[hit.triangle.index()];
        let corners =
            corners.map(|v| root.transform_point_f32(surface.in_model().position(v).unwrap()));
        frame.overlay.triangle(corners, [0.0, 1.0, 0.0, 1.0]);
        let is_green = |[r, g, b]: [u8; 3]| g > 120 && r < 80 && b < 80;
        let green = find(&renderer.draw(&frame).unwrap(), is_green);
        assert!(green.len() > 20, "{} pixels of the triangle", green.len());
        // The contact, which is in the middle of the picture, lies among the triangle's pixels.
        let middle = [f64::from(WIDTH) / 2.0, f64::from(ROWS) / 2.0];
        let apart = |p: &[f64; 2]| {
            let [x, y] = [p[0] - middle[0], p[1] - middle[1]];
            (x * x + y * y).sqrt()
        };
        let nearest = green.iter().map(apart).fold(f64::INFINITY, f64::min);
        assert!(
            nearest <= 1.5,
            "the triangle is {nearest} pixels from the contact"
        );

        frame.overlay = Overlay::default();
        let stands = Similarity::from_translation(hit.point);
        frame.drawn.push(drawn(figure, stands, None));
        let image = renderer.draw(&frame).unwrap();
        let red = find(&image, |[r, g, b]| r > 60 && g < r / 2 && b < r / 2);
        assert!(red.len() > 100, "{} pixels of the climber", red.len());
        let foot = red.iter().map(|p| p[1]).fold(0.0, f64::max);
        assert!((foot - middle[1]).abs() <= 8.0, "its foot is in row {foot}");
        assert!(mean(&red)[1] < middle[1], "it stands on its head");
        // Below its foot there is skin.
        let blue = find(&image, |[r, g, b]| b > 50 && r < b / 2 && g < b);
        let below = blue
            .iter()
            .filter(|p| (p[0] - middle[0]).abs() < 3.0 && p[1] > foot);
        assert!(below.count() > 3, "no skin under it");
    }
}

#[test]
fn a_rigs_meshes_are_ready_for_the_renderer() {
    let mut model = clamber_gltf::load(clamber_scenes::giant::path()).unwrap();
    let tinted = model.visual[0].positions.len();
    model.visual[0].colors = vec![[0.5, 1.0, 0.0, 1.0]; tinted];
    let sources: Vec<_> = clamber_render::visual_meshes(&model).collect();
    assert_eq!(sources.len(), model.visual.len());
    for (source, mesh) in sources.iter().zip(&model.visual) {
        let source = source.source();
        assert_eq!(source.positions, mesh.positions);
        assert_eq!(source.skin.unwrap().ends, mesh.influence_ends);
        let mut triangles = source.triangles.iter();
        for primitive in &mesh.primitives {
            let base = model.materials[primitive.material.unwrap()].base_color;
            for corners in &primitive.triangles {
                assert_eq!(triangles.next(), Some(corners));
                let vertex = corners[0] as usize;
                let own = mesh.colors.get(vertex).unwrap_or(&[1.0; 4]);
                let expected = [base[0] * own[0], base[1] * own[1], base[2] * own[2]];
                assert_eq!(source.colors[vertex], expected);
                let look = Look::from(primitive.tag.kind);
                assert_eq!(source.looks[vertex], look);
            }
        }
        assert_eq!(triangles.next(), None);
    }
    assert!(sources[0].source().looks.contains(&Look::Fur));
}
