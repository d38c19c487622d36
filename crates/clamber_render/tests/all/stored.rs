//! Tests that pictures of a battle look like the pictures in `tests/stored`.
//!
//! Two pictures look alike if two measures of `image-compare` are above their bounds: the structure (SSIM) at a quarter
//! of their size, and the colours (root mean square) at a sixteenth. The bounds allow the differences of another
//! driver: edges moved by a pixel, and noise of two levels. They do not allow mistakes: no shadow, another pose, fur or
//! stone drawn plain, another light, no overlay. The test asserts this for each stored picture: such differences pass,
//! and such mistakes fail.
//!
//! After a failure, the new picture and a picture of the differences are in `tmp` in cargo's target folder. Look at the
//! new pictures first. If they are right, `CLAMBER_BLESS=1 cargo test -p clamber_render --test all stored` stores them.

use crate::common;

use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::{Path, PathBuf};

use clamber_render::{Camera, Frame, Image, Overlay, Renderer};
use clamber_scenes::battle::{Battle, BattleOptions, TICK};
use clamber_scenes::giant::{self, giant};
use clamber_scenes::picture::{Stage, add_visual, beside, light, orbit};
use clamber_surface::geometry::{Affine, rotation_from_axis_angle};
use clamber_surface::mesh::SurfaceKind;
use clamber_surface::rig::{JointId, Palette};
use glam::{DAffine3, DVec3};
use image_compare::prelude::RgbImage;
use image_compare::{Algorithm, rgb_similarity_structure};

/// Width of a picture, pixels.
const WIDTH: u32 = 320;
/// Height of a picture, pixels.
const ROWS: u32 = 180;

/// The lowest allowed likeness in structure; 1 means equal. Simulated drivers have 0.942 at worst.
const STRUCTURE: f64 = 0.92;

/// The lowest allowed likeness in colours; 1 means equal. Simulated drivers have 0.995 at worst. Two mistakes have
/// 0.991: stone drawn plain, and a sun with a tenth less blue.
const COLOR: f64 = 0.993;

/// A picture at a tick.
struct Shot {
    name: &'static str,
    tick: u64,
    camera: fn(&Battle<'_>, f64) -> Camera,
    /// A joint whose motion is visible.
    joint: &'static str,
    /// Surface kinds so near the camera that drawing them plain is visible.
    near: &'static [SurfaceKind],
    overlay: bool,
}

/// The stored pictures, by ascending tick.
const SHOTS: [Shot; 4] = [
    Shot {
        name: "rider",
        tick: 300,
        camera: |battle, _| beside(battle, DVec3::new(2.4, 2.2, -3.0)),
        joint: "chest",
        near: &[SurfaceKind::Fur, SurfaceKind::Stone],
        overlay: false,
    },
    Shot {
        name: "walk",
        tick: 700,
        camera: |battle, height| orbit(battle, height, 0.6),
        joint: "upper_arm.L",
        near: &[],
        overlay: false,
    },
    Shot {
        name: "chase",
        tick: 1200,
        camera: |battle, _| {
            let behind = battle.surface().world_from_model().rotation * DVec3::NEG_Z;
            beside(battle, behind * 9.0 + DVec3::Y * 5.0)
        },
        joint: "chest",
        near: &[SurfaceKind::Fur],
        overlay: true,
    },
    Shot {
        name: "shake",
        tick: 1440,
        camera: |battle, height| orbit(battle, 0.9 * height, 2.2),
        joint: "upper_arm.R",
        near: &[],
        overlay: false,
    },
];

#[test]
fn a_battle_looks_as_stored_and_pictures_with_mistakes_do_not() {
    let Some(gpu) = common::gpu("stored") else {
        return;
    };
    let mut renderer = Renderer::new(gpu, WIDTH, ROWS).unwrap();
    let creature = giant().unwrap();
    let rig = giant::model().unwrap();
    let mut stage = |plain: &[SurfaceKind]| {
        let mut rig = rig.clone();
        for primitive in rig.visual.iter_mut().flat_map(|mesh| &mut mesh.primitives) {
            if plain.contains(&primitive.tag.kind) {
                primitive.tag.kind = SurfaceKind::Skin;
            }
        }
        let seen = add_visual(&mut renderer, &rig).unwrap();
        Stage::new(&mut renderer, seen).unwrap()
    };
    let mut plain = [SurfaceKind::Fur, SurfaceKind::Stone].map(|kind| (kind, stage(&[kind])));
    let mut stage = stage(&[]);
    let options = BattleOptions::ride(0, 1);
    let height = options.height();
    let mut battle = Battle::new(&creature, &options).unwrap();
    let mut wrong = Vec::new();
    for shot in SHOTS {
        while battle.tick() < shot.tick {
            battle.step(options.input_at(battle.tick())).unwrap();
            let all = plain.iter_mut().map(|(_, stage)| stage);
            for stage in all.chain(core::iter::once(&mut stage)) {
                stage.watch(&battle, TICK).unwrap();
            }
        }
        let right = Frame {
            camera: (shot.camera)(&battle, height),
            light: light(&battle, height),
            drawn: stage.drawn(&battle, battle.palette()),
            overlay: overlay(&battle, shot.overlay),
        };
        let image = renderer.draw(&right).unwrap();
        if let Some(difference) = compare_with_stored(&image, shot.name) {
            wrong.push(difference);
            continue;
        }
        let driver = another_driver(&image);
        check(&shot, "another driver", &image, &driver, true);

        let mut unshadowed = right.clone();
        unshadowed.light.shadow_center.y += 1e4;
        let bent = bent(&battle, shot.joint);
        let drawn = |drawn| Frame {
            drawn,
            ..right.clone()
        };
        let mut frames = vec![
            ("no shadow", unshadowed),
            ("another pose", drawn(stage.drawn(&battle, &bent))),
        ];
        for (kind, plain) in &plain {
            if shot.near.contains(kind) {
                let plain = plain.drawn(&battle, battle.palette());
                frames.push(("fur or stone drawn plain", drawn(plain)));
            }
        }
        if shot.overlay {
            let bare = Frame {
                overlay: Overlay::default(),
                ..right.clone()
            };
            frames.push(("no overlay", bare));
        }
        for (what, frame) in frames {
            let mistaken = renderer.draw(&frame).unwrap();
            check(&shot, what, &image, &mistaken, false);
        }
        for (channel, what) in ["less red", "less green", "less blue"].iter().enumerate() {
            check(&shot, what, &image, &dimmed(&image, channel), false);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Asserts that two pictures look alike, or that they do not.
fn check(shot: &Shot, what: &str, image: &Image, other: &Image, alike: bool) {
    let likeness = Likeness::of(image, other);
    println!("{}, {what}: {likeness:?}", shot.name);
    assert_eq!(
        likeness.holds(),
        alike,
        "{}, {what}: {likeness:?}",
        shot.name
    );
}

#[derive(Clone, Copy, Debug)]
struct Likeness {
    structure: f64,
    color: f64,
}

impl Likeness {
    fn of(a: &Image, b: &Image) -> Self {
        let score = |algorithm, a: &Image, b: &Image| {
            let compared = rgb_similarity_structure(&algorithm, &rgb(a), &rgb(b));
            compared.unwrap().score
        };
        let (a, b) = (a.halved().halved(), b.halved().halved());
        Self {
            structure: score(Algorithm::MSSIMSimple, &a, &b),
            color: score(
                Algorithm::RootMeanSquared,
                &a.halved().halved(),
                &b.halved().halved(),
            ),
        }
    }

    fn holds(self) -> bool {
        self.structure >= STRUCTURE && self.color >= COLOR
    }
}

fn rgb(image: &Image) -> RgbImage {
    let pixels = image.pixels.chunks_exact(4);
    let pixels = pixels.flat_map(|pixel| &pixel[..3]).copied().collect();
    RgbImage::from_raw(image.width, image.height, pixels).unwrap()
}

/// Compares a picture with the stored one, or stores it. Describes the difference; `None` if they look alike.
fn compare_with_stored(image: &Image, name: &str) -> Option<String> {
    let stored = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/stored/{name}.png"));
    if std::env::var_os("CLAMBER_BLESS").is_some() {
        write(&rgb(image), &stored);
        eprintln!("stored {}", stored.display());
        return None;
    }
    let before = load(&stored);
    let likeness = Likeness::of(&before, image);
    println!("{name}, stored: {likeness:?}");
    if likeness.holds() {
        return None;
    }
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let (now, difference) = (
        folder.join(format!("{name}.png")),
        folder.join(format!("{name}-difference.png")),
    );
    write(&rgb(image), &now);
    let compared =
        rgb_similarity_structure(&Algorithm::RootMeanSquared, &rgb(&before), &rgb(image));
    write(
        &compared.unwrap().image.to_color_map().to_rgb8(),
        &difference,
    );
    Some(format!(
        "{name} does not look as stored: {likeness:?}; see {} and, dark where it differs, {}",
        now.display(),
        difference.display()
    ))
}

fn write(image: &RgbImage, path: &Path) {
    let file = BufWriter::new(File::create(path).unwrap());
    let mut encoder = png::Encoder::new(file, image.width(), image.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(image.as_raw()).unwrap();
}

fn load(path: &Path) -> Image {
    let file = File::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    let pixels = pixels.chunks_exact(3);
    Image {
        width: info.width,
        height: info.height,
        pixels: pixels.flat_map(|p| [p[0], p[1], p[2], 255]).collect(),
    }
}

/// The overlay of a shot: the skeleton, and shapes around the climber; empty if it is not wanted.
fn overlay(battle: &Battle<'_>, wanted: bool) -> Overlay {
    let mut over = Overlay::default();
    if !wanted {
        return over;
    }
    let root = battle.surface().world_from_model();
    let frames = |joint: JointId| battle.palette().model_from_joint(joint).unwrap();
    let place = |joint| root.transform_point(frames(joint).translation);
    for (index, joint) in (0..).zip(battle.creature.rig.skeleton.joints()) {
        if let Some(parent) = joint.parent {
            let ends = [place(parent), place(JointId(index))];
            over.line(ends[0], ends[1], 3.0, [1.0, 0.75, 0.1, 0.9]);
        }
    }
    let at = battle.climber().state().position;
    over.sphere(at, 1.5, 2.0, [1.0, 0.1, 0.1, 1.0]);
    over.arrow(at, DVec3::Y * 3.0, 3.0, [1.0, 0.2, 0.8, 1.0]);
    let corner = |x: f64, z: f64| at + DVec3::new(x, 0.5, z);
    let corners = [corner(-3.0, 0.0), corner(0.0, 3.0), corner(3.0, 0.0)];
    over.triangle(corners, [0.1, 1.0, 0.3, 0.55]);
    over
}

/// The creature's palette with one joint and all joints below it turned by 30 degrees.
fn bent(battle: &Battle<'_>, name: &str) -> Palette {
    let joints = battle.creature.rig.skeleton.joints();
    let bent = joints.iter().position(|joint| joint.name == name).unwrap();
    let bent = JointId(bent as u32);
    let from = battle.palette().model_from_joint(bent).unwrap().translation;
    let turn = rotation_from_axis_angle(DVec3::X, 30f64.to_radians());
    let turn = DAffine3::from_rotation_translation(turn, from) * DAffine3::from_translation(-from);
    let hangs_on = |mut joint: JointId| {
        while joint != bent {
            match joints[joint.0 as usize].parent {
                Some(parent) => joint = parent,
                None => return false,
            }
        }
        true
    };
    let matrices = (0..).zip(battle.palette().matrices());
    Palette::from_matrices(matrices.map(|(index, matrix)| {
        if hangs_on(JointId(index)) {
            Affine::from_f64(&(turn * matrix.to_f64()))
        } else {
            *matrix
        }
    }))
}

/// Simulates more than the difference of another driver: each pixel stays or becomes one of its neighbours, with at
/// most two levels of noise.
fn another_driver(image: &Image) -> Image {
    let mut rng = fastrand::Rng::with_seed(3);
    let mut other = image.clone();
    for (index, pixel) in (0..).zip(other.pixels.chunks_exact_mut(4)) {
        let mut near = |place: u32, size: u32| {
            let place = place as i32 + rng.i32(-1..=1);
            place.clamp(0, size as i32 - 1) as u32
        };
        let (x, y) = (
            near(index % image.width, image.width),
            near(index / image.width, image.height),
        );
        let from = (y * image.width + x) as usize * 4;
        for (to, from) in pixel[..3].iter_mut().zip(&image.pixels[from..]) {
            *to = (i32::from(*from) + rng.i32(-2..=2)).clamp(0, 255) as u8;
        }
    }
    other
}

/// Simulates a sun with about a tenth less red, green or blue: sky and tone mapping halve the change.
fn dimmed(image: &Image, channel: usize) -> Image {
    /// Share of the channel's light that is left.
    const LEFT: f64 = 0.95;
    let mut dimmed = image.clone();
    for pixel in dimmed.pixels.chunks_exact_mut(4) {
        let encoded = f64::from(pixel[channel]) / 255.0;
        // sRGB: a power, except for the darkest colours.
        let encoded = if encoded <= 0.04045 {
            encoded * LEFT
        } else {
            (encoded + 0.055) * libm::pow(LEFT, 1.0 / 2.4) - 0.055
        };
        pixel[channel] = (encoded.max(0.0) * 255.0).round() as u8;
    }
    dimmed
}
