//! Without a window: arrows fly by themselves, and what a camera sees becomes a PNG.

use std::path::PathBuf;
use std::time::Duration;

use bevy::app::{PluginGroupBuilder, ScheduleRunnerPlugin};
use bevy::camera::RenderTarget;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::render_resource::TextureFormat;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::time::TimeUpdateStrategy;
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use bevy_clamber::prelude::*;

use crate::arrows::{Arrow, Bow};
use crate::creature::Creature;

/// Pixels.
const SIZE: UVec2 = UVec2::new(1280, 720);

/// Each frame is so many seconds of the scene, however long it takes.
const FRAME: f64 = 1.0 / 60.0;

/// One shot a frame.
const SHOTS: u32 = 80;

/// Frames after the last shot, which carry the arrows on.
const AFTER: u32 = 45;

/// Frames that are drawn; what uploads late is there in the last.
const DRAWN: u32 = 6;

/// Seconds to wait for the creature before it is given up.
const PATIENCE: u64 = 300;

pub fn no_window(defaults: impl PluginGroup) -> PluginGroupBuilder {
    defaults
        .set(WindowPlugin {
            primary_window: None,
            exit_condition: ExitCondition::DontExit,
            ..default()
        })
        .set(RenderPlugin {
            // Nothing is left out of the picture because it still compiles.
            synchronous_pipeline_compilation: true,
            ..default()
        })
        .disable::<WinitPlugin>()
        .add(ScheduleRunnerPlugin::run_loop(Duration::ZERO))
}

/// What is written where.
#[derive(Resource)]
struct Picture {
    path: PathBuf,
    target: Handle<Image>,
    frame: u32,
}

pub fn plugin(path: PathBuf) -> impl Plugin {
    move |app: &mut App| {
        let mut images = app.world_mut().resource_mut::<Assets<Image>>();
        let format = TextureFormat::Rgba8UnormSrgb;
        let target = images.add(Image::new_target_texture(SIZE.x, SIZE.y, format, None));
        app.insert_resource(Picture {
            path: path.clone(),
            target,
            frame: 0,
        })
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(
            FRAME,
        )))
        .add_systems(PostStartup, draw_into_picture)
        .add_systems(
            Update,
            (
                give_up.run_if(not(resource_exists::<Creature>)),
                play.run_if(resource_exists::<Creature>),
            ),
        );
    }
}

/// The camera sleeps until there is something to see: software renderers are slow.
fn draw_into_picture(
    camera: Single<(Entity, &mut Camera)>,
    picture: Res<Picture>,
    mut commands: Commands,
) {
    let (entity, mut camera) = camera.into_inner();
    camera.is_active = false;
    let target = RenderTarget::Image(picture.target.clone().into());
    commands.entity(entity).insert(target);
}

fn give_up(time: Res<Time<Real>>, mut exit: MessageWriter<AppExit>) {
    if time.elapsed() > Duration::from_secs(PATIENCE) {
        error!("no creature after {PATIENCE} s");
        exit.write(AppExit::error());
    }
}

/// A shot each frame, some time for the skin to move on, then the picture.
fn play(
    mut picture: ResMut<Picture>,
    mut camera: Single<&mut Camera>,
    creature: Res<Creature>,
    mut bow: Bow,
    mut commands: Commands,
) {
    let frame = picture.frame;
    picture.frame += 1;
    if frame < SHOTS {
        bow.shoot(shot(frame, &creature));
    }
    let last = SHOTS + AFTER;
    camera.is_active = frame + DRAWN >= last;
    if frame == last {
        commands
            .spawn(Screenshot::image(picture.target.clone()))
            .observe(write);
    }
}

/// From archers on both sides, at points spread evenly over the creature.
fn shot(index: u32, creature: &Creature) -> Ray3d {
    let half = creature.half_size;
    let share = (index as f32 + 0.5) / SHOTS as f32;
    let turn = index as f32 * core::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
    let spread = share.sqrt() * Vec2::from_angle(turn);
    let target = creature.center + half * Vec3::new(0.8 * spread.x, 0.9 * spread.y, 0.0);
    let side = if index.is_multiple_of(2) { -0.5 } else { 2.0 };
    let archer = target + creature.radius() * Vec3::new(side, 0.5, 2.0);
    let toward = Dir3::new(target - archer).unwrap_or(Dir3::NEG_Z);
    Ray3d::new(archer, toward)
}

/// Writes the picture, and checks what it shows: arrows that stick, and went along with the skin.
fn write(
    captured: On<ScreenshotCaptured>,
    picture: Res<Picture>,
    arrows: Query<(&Arrow, &GlobalTransform), With<SurfaceAnchor>>,
    mut exit: MessageWriter<AppExit>,
) {
    let carried =
        |(arrow, place): (&Arrow, &GlobalTransform)| place.translation().distance(arrow.hit);
    let farthest = arrows.iter().map(carried).fold(0.0, f32::max);
    println!(
        "{} arrows of {SHOTS} stick; the skin carried one of them {farthest:.2} m",
        arrows.iter().count()
    );
    let image = match captured.image.clone().try_into_dynamic() {
        Ok(image) => image.to_rgb8(),
        Err(error) => {
            error!("{error}");
            exit.write(AppExit::error());
            return;
        }
    };
    if let Err(error) = image.save(&picture.path) {
        error!("{}: {error}", picture.path.display());
        exit.write(AppExit::error());
    } else if arrows.is_empty() || farthest == 0.0 {
        error!("no arrow went along with the skin");
        exit.write(AppExit::error());
    } else {
        exit.write(AppExit::Success);
    }
}
