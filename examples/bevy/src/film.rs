//! Runs the game without a window: a script plays it, and what the camera sees is written to files. A frame is a tick,
//! however long it takes to draw.

use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use bevy::app::{PluginGroupBuilder, ScheduleRunnerPlugin};
use bevy::camera::RenderTarget;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::render_resource::TextureFormat;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::time::TimeUpdateStrategy;
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use image::codecs::gif::{GifEncoder, Repeat};
use image::{Delay, Frame, RgbImage, RgbaImage};

use crate::creature::Creature;
use crate::proof::Proof;
use crate::script::Script;
use crate::trouble::Trouble;

/// Size of a picture, and of a film, pixels.
const PICTURE: UVec2 = UVec2::new(1280, 720);
const FILM: UVec2 = UVec2::new(640, 360);

/// Every fifth frame is filmed: 12.8 a second.
const EACH: u32 = 5;

/// How long each of them is shown, milliseconds; GIF counts hundredths of a second.
const SHOWN: u32 = 80;

/// Number of frames that are drawn before the picture is taken, so that late uploads are in it.
const WARM: u32 = 6;

/// Seconds to wait for the renderer, which is a few frames behind.
const PATIENCE: u64 = 60;

pub fn no_window(defaults: impl PluginGroup) -> PluginGroupBuilder {
    defaults
        .set(WindowPlugin {
            // It is never opened, but without it Bevy's picking has no rays.
            primary_window: Some(Window::default()),
            exit_condition: ExitCondition::DontExit,
            ..default()
        })
        .set(RenderPlugin {
            // Otherwise a pipeline that still compiles would leave a gap in the picture.
            synchronous_pipeline_compilation: true,
            ..default()
        })
        .disable::<WinitPlugin>()
        .add(ScheduleRunnerPlugin::run_loop(Duration::ZERO))
}

/// What is written, and how far it is.
#[derive(Resource)]
struct Film {
    picture: Option<PathBuf>,
    gif: Option<PathBuf>,
    target: Handle<Image>,
    /// Frames since the game began, and since the script has ended.
    frame: u32,
    after: u32,
    /// Frames that the camera has drawn.
    drawn: u32,
    began: Option<Instant>,
    ended: Option<Instant>,
    /// Pictures that the renderer owes.
    owed: u32,
    /// Frames of the film by their numbers.
    film: BTreeMap<u32, RgbaImage>,
    last: Option<RgbImage>,
}

pub fn plugin(picture: Option<PathBuf>, gif: Option<PathBuf>) -> impl Plugin {
    move |app: &mut App| {
        let size = if gif.is_some() { FILM } else { PICTURE };
        let mut images = app.world_mut().resource_mut::<Assets<Image>>();
        let format = TextureFormat::Rgba8UnormSrgb;
        let target = images.add(Image::new_target_texture(size.x, size.y, format, None));
        app.insert_resource(Film {
            picture: picture.clone(),
            gif: gif.clone(),
            target,
            frame: 0,
            after: 0,
            drawn: 0,
            began: None,
            ended: None,
            owed: 0,
            film: BTreeMap::new(),
            last: None,
        })
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
        .add_systems(PostStartup, draw_into_picture)
        .add_systems(
            Update,
            (film, end).chain().run_if(resource_exists::<Creature>),
        );
    }
}

fn draw_into_picture(
    camera: Single<(Entity, &mut Camera)>,
    film: Res<Film>,
    mut commands: Commands,
) {
    let (entity, mut camera) = camera.into_inner();
    camera.is_active = false;
    let target = RenderTarget::Image(film.target.clone().into());
    commands.entity(entity).insert(target);
}

/// Draws the frames that are filmed, those in which an arrow is shot, and the last ones: software renderers are slow.
fn film(
    mut film: ResMut<Film>,
    script: Res<Script>,
    mut camera: Single<&mut Camera>,
    mut commands: Commands,
) {
    film.began.get_or_insert_with(Instant::now);
    let frame = film.frame;
    film.frame += 1;
    film.after += u32::from(script.has_ended());
    let is_filmed = film.gif.is_some() && frame.is_multiple_of(EACH) && film.ended.is_none();
    let is_last = film.after == WARM + 1;
    let is_drawn = is_filmed || script.shoots_soon() || (1..=WARM + 1).contains(&film.after);
    camera.is_active = is_drawn;
    film.drawn += u32::from(is_drawn);
    if is_last {
        film.ended = Some(Instant::now());
    }
    if is_filmed || is_last {
        film.owed += 1;
        let shot = Screenshot::image(film.target.clone());
        commands.spawn(shot).observe(
            move |captured: On<ScreenshotCaptured>,
                  mut film: ResMut<Film>,
                  mut trouble: Trouble| {
                film.owed -= 1;
                match captured.image.clone().try_into_dynamic() {
                    Ok(image) if is_last => film.last = Some(image.to_rgb8()),
                    Ok(image) => {
                        film.film.insert(frame, image.to_rgba8());
                    }
                    Err(error) => trouble.end(error),
                }
            },
        );
    }
}

/// Writes the files when the last picture is there, and checks what was played.
fn end(
    mut film: ResMut<Film>,
    proof: Proof,
    mut exit: MessageWriter<AppExit>,
    mut trouble: Trouble,
) {
    let (Some(began), Some(ended)) = (film.began, film.ended) else {
        return;
    };
    if film.owed > 0 || film.last.is_none() {
        if ended.elapsed() > Duration::from_secs(PATIENCE) {
            trouble.end("the renderer returned no picture");
        }
        return;
    }
    let Some(last) = film.last.take() else {
        return;
    };
    let frames = std::mem::take(&mut film.film);
    let written = film.gif.as_ref().map_or(Ok(()), |file| {
        write(file, frames).map_err(|error| told(file, &*error))
    });
    let written = written.and_then(|()| {
        let save = |file: &PathBuf| last.save(file).map_err(|error| told(file, &error));
        film.picture.as_ref().map_or(Ok(()), save)
    });
    let (drawn, seconds) = (film.drawn, (ended - began).as_secs_f64());
    let done = written.and_then(|()| proof.check(last.pixels().map(|pixel| pixel.0)));
    match done {
        Ok(shown) => {
            println!("{shown}");
            println!(
                "{drawn} frames drawn and {} ticks in {seconds:.1} s",
                film.frame
            );
            exit.write(AppExit::Success);
        }
        Err(what) => trouble.end(what),
    }
    // Only once.
    film.ended = None;
}

fn told(file: &Path, error: &dyn core::error::Error) -> String {
    format!("{}: {error}", file.display())
}

fn write(file: &Path, frames: BTreeMap<u32, RgbaImage>) -> Result<(), Box<dyn core::error::Error>> {
    let mut encoder = GifEncoder::new_with_speed(File::create(file)?, 10);
    encoder.set_repeat(Repeat::Infinite)?;
    for image in frames.into_values() {
        let delay = Delay::from_numer_denom_ms(SHOWN, 1);
        encoder.encode_frame(Frame::from_parts(image, 0, 0, delay))?;
    }
    Ok(())
}
