//! Draws contact sheets of a climber's body in every mode, from two sides.
//!
//! ```text
//! cargo run --release --example bodies --features render
//! ```

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clamber::body::{Body, BodyInput, Figure, Humanoid, Retarget};
use clamber::geometry::Similarity;
use clamber::glam::DVec3;
use clamber::gltf::Model;

use clamber::render::{
    Camera, Drawn, Frame, Gpu, Image, Light, Overlay, RenderMeshId, Renderer, TextSize,
};
use clamber_scenes::battle::within;
use clamber_scenes::bodies::{self, Mount, Scene, Stage};
use clamber_scenes::measure::exit_code;
use clamber_scenes::{giant, picture};
use clap::Parser;

/// Draws contact sheets of a climber's body.
#[derive(Parser)]
struct Options {
    /// Draws only the scenes whose names contain this.
    #[arg(long)]
    scene: Option<String>,
    /// A humanoid with or without clips of its own; the project's hero otherwise.
    #[arg(long)]
    figure: Option<PathBuf>,
    /// Folder for the sheets.
    #[arg(long, default_value = "target/sheets")]
    out: PathBuf,
    /// Number of columns of pictures on a sheet.
    #[arg(long, default_value_t = 8)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=100))]
    columns: u32,
    /// Shows this part of a scene, from one second to a later one.
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"])]
    #[arg(value_parser = |text: &str| within(text, 0.0, 3600.0), allow_negative_numbers = true)]
    between: Option<Vec<f64>>,
}

/// Length of a tick, seconds.
const TICK: f64 = 1.0 / 60.0;
/// Width and height of a picture on a sheet, pixels.
const SIZE: [u32; 2] = [360, 440];

fn hero() -> Result<Model, Box<dyn Error>> {
    Ok(clamber::gltf::load(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/assets/hero.glb"
    ))?)
}

/// A figure from a file, with the hero's clips.
fn figure(file: Option<&Path>) -> Result<(Figure, Model), Box<dyn Error>> {
    let hero = hero()?;
    let own = Humanoid::find(&hero.rig.skeleton)?;
    let Some(file) = file else {
        return Ok((
            Figure::new(hero.rig.skeleton.clone(), own, hero.rig.clips.clone())?,
            hero,
        ));
    };
    let model = clamber::gltf::load(file)?;
    let other = Humanoid::find(&model.rig.skeleton)?;
    let retarget = Retarget::new((&hero.rig.skeleton, &own), (&model.rig.skeleton, &other))?;
    let clips = hero
        .rig
        .clips
        .iter()
        .map(|clip| retarget.clip(clip))
        .collect::<Result<Vec<_>, _>>()?;
    let leg = |body: &Humanoid| body.legs[0].length();
    let scale = leg(&own) / leg(&other);
    Ok((
        Figure::with_scale(model.rig.skeleton.clone(), other, clips, scale)?,
        model,
    ))
}

fn scenes() -> Result<Vec<Scene>, Box<dyn Error>> {
    let giant = giant::giant()?;
    let on = |height: f64, from: DVec3| Mount {
        clip: "walk",
        height,
        from,
    };
    Ok(vec![
        bodies::flat(0.0)?,
        bodies::flat(1.4)?,
        bodies::flat(4.0)?,
        bodies::ramp(0.5, 1.4)?,
        bodies::ramp(-0.61, 1.4)?,
        bodies::stairs(true, 1.0)?,
        bodies::stairs(false, 1.0)?,
        bodies::block()?,
        bodies::step_off()?,
        bodies::fall()?,
        bodies::knock()?,
        bodies::wall(DVec3::Y * 0.5)?,
        bodies::wall(DVec3::NEG_X)?,
        bodies::hang(2.0, 0.3)?,
        bodies::all_holds()?,
        bodies::ledge()?,
        bodies::drop_off()?,
        bodies::mantle()?,
        bodies::crouch()?,
        bodies::squeeze()?,
        bodies::climb(&giant, &on(0.35, DVec3::Z), 1.0)?,
        bodies::climb(&giant, &on(0.7, DVec3::NEG_Z), 1.0)?,
    ])
}

fn main() -> ExitCode {
    exit_code(run(&Options::parse()))
}

fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let between = options.between.as_deref();
    if between.is_some_and(|part| part[0] >= part[1]) {
        return Err("--between has to end after it begins".into());
    }
    let (figure, rig) = figure(options.figure.as_deref())?;
    std::fs::create_dir_all(&options.out)?;
    for (index, scene) in scenes()?.iter().enumerate() {
        let wanted = options.scene.as_ref();
        if wanted.is_some_and(|wanted| !scene.name.contains(wanted.as_str())) {
            continue;
        }
        let name = scene.name.replace([' ', '/', '.'], "_");
        let file = options.out.join(format!("{index:02}_{name}.png"));
        sheet(scene, &figure, &rig, options)?.write_png(&file)?;
        println!("{}", file.display());
    }
    Ok(())
}

fn sheet(
    scene: &Scene,
    figure: &Figure,
    model: &Model,
    options: &Options,
) -> Result<Image, Box<dyn Error>> {
    let [width, height] = SIZE;
    let mut renderer = Renderer::new(Gpu::new()?, width, height)?;
    let person = picture::add_visual(&mut renderer, model)?;
    let mut stage = Stage::new(scene)?;
    let mut things = Vec::new();
    for surface in &stage.surfaces {
        let color = [0.34, 0.33, 0.30];
        things.push(picture::add_collider(&mut renderer, surface.mesh(), color)?);
    }
    let mut body = Body::new(figure);
    let columns = options.columns;
    let mut all = Image {
        width: columns * width,
        height: 2 * height,
        pixels: vec![0; (columns * width * 2 * height * 4) as usize],
    };
    let [from, to] = match options.between.as_deref() {
        Some([from, to]) => [*from, *to],
        _ => [0.0, scene.seconds.min(8.0)],
    };
    let mut drawn = 0;
    while stage.time < to && drawn < columns {
        stage.tick(TICK)?;
        let obstacles = stage.obstacles();
        body.update(figure, &BodyInput::new(&stage.climber, &obstacles), TICK)?;
        let due = from + (to - from) * (f64::from(drawn) + 0.999) / f64::from(columns);
        if stage.time + 1e-9 < due {
            continue;
        }
        for side in 0..2 {
            let image = draw(&mut renderer, &stage, &body, figure, &person, &things, side)?;
            paste(&mut all, &image, [drawn * width, side * height]);
        }
        drawn += 1;
    }
    Ok(all)
}

fn draw(
    renderer: &mut Renderer,
    stage: &Stage<'_>,
    body: &Body,
    figure: &Figure,
    person: &[RenderMeshId],
    things: &[RenderMeshId],
    side: u32,
) -> Result<Image, Box<dyn Error>> {
    let palette = figure.skeleton().palette(body.pose())?;
    let world: Similarity = body.world_from_model();
    let middle = world.transform_point(DVec3::Y * (0.95 / figure.scale()));
    let state = stage.climber.state();
    let up = DVec3::Y;
    let (ahead, left) = (state.heading, up.cross(state.heading));
    let away = if side == 0 {
        left * 1.0 - ahead * 0.25 + up * 0.1
    } else {
        -ahead * 0.8 + left * 0.45 + up * 0.25
    };
    let palettes = (0..things.len()).map(|index| stage.palette(index));
    let palettes = palettes.collect::<Result<Vec<_>, _>>()?;
    let places = stage.surfaces.iter().map(|one| *one.world_from_model());
    let things = things.iter().zip(places).zip(&palettes);
    let things = things.map(|((mesh, place), palette)| (mesh, place, palette));
    let person = person.iter().map(|mesh| (mesh, world, &palette));
    let drawn = things
        .chain(person)
        .map(|(mesh, world_from_model, palette)| Drawn {
            mesh: *mesh,
            world_from_model,
            palette: Some(palette),
        });
    let time = format!("{:.2} {:?}", stage.time, state.mode);
    let mut image = renderer.draw(&Frame {
        camera: Camera::new(middle + away.normalize() * 2.9, middle),
        light: Light {
            shadow_radius: 4.0,
            ..Light::over(middle, 4.0)
        },
        drawn: drawn.collect(),
        overlay: Overlay::default(),
    })?;
    image.text([4, 2], TextSize::Small, &time);
    Ok(image)
}

fn paste(all: &mut Image, image: &Image, [x, y]: [u32; 2]) {
    for row in 0..image.height {
        let from = (row * image.width * 4) as usize;
        let to = (((y + row) * all.width + x) * 4) as usize;
        let bytes = (image.width * 4) as usize;
        all.pixels[to..to + bytes].copy_from_slice(&image.pixels[from..from + bytes]);
    }
}
