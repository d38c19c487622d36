//! Runs the app without a window: arrows fly by themselves, a pointer presses once, and the camera's picture is written
//! as a PNG and checked.

use std::path::PathBuf;
use std::time::Duration;

use bevy::app::{PluginGroupBuilder, ScheduleRunnerPlugin};
use bevy::camera::{NormalizedRenderTarget, RenderTarget};
use bevy::picking::pointer::{Location, PointerAction, PointerButton, PointerId, PointerInput};
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::render_resource::TextureFormat;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::time::TimeUpdateStrategy;
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;

use crate::arrows::{Arrow, Bow};
use crate::creature::Creature;
use crate::proof::Proof;
use crate::trouble::Trouble;

/// Size of the picture, pixels.
const SIZE: UVec2 = UVec2::new(1280, 720);

/// Seconds of the scene per frame, however long the frame takes.
const FRAME: f64 = 1.0 / 60.0;

/// Number of shots, one a frame.
const SHOTS: u32 = 80;

/// Frames after the last shot, which carry the arrows on.
const AFTER: u32 = 45;

/// Number of frames that are drawn, so that late uploads are in the last one.
const DRAWN: u32 = 6;

/// The frame in which a pointer presses. It and the frame before are drawn, since pointers hit only entities that a
/// camera sees. The arrow is there one frame later.
const PRESS: u32 = SHOTS + AFTER - 3;

/// Frames to wait for the picture: the renderer is a few behind.
const PATIENCE: u32 = 600;

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

/// The picture to write, and the progress of the scene.
#[derive(Resource)]
struct Picture {
    path: PathBuf,
    target: Handle<Image>,
    frame: u32,
    /// Where the pointer has pressed, pixels, and the arrow that was shot there.
    pressed: Option<(Vec2, Option<Entity>)>,
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
            pressed: None,
        })
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(
            FRAME,
        )))
        .add_systems(PostStartup, draw_into_picture)
        .add_systems(
            Update,
            (play, press).chain().run_if(resource_exists::<Creature>),
        );
    }
}

/// Draws into an image. The camera is inactive until the last frames, because software renderers are slow.
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

/// Shoots an arrow each frame, lets the skin move for a while, then takes the picture.
fn play(
    mut picture: ResMut<Picture>,
    mut camera: Single<&mut Camera>,
    creature: Res<Creature>,
    mut bow: Bow,
    mut commands: Commands,
    mut trouble: Trouble,
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
    if frame == last + PATIENCE {
        trouble.end("the renderer returned no picture");
    }
}

/// Presses on the visible arrow that is nearest to the middle of the picture, since there is skin.
fn press(
    mut picture: ResMut<Picture>,
    camera: Single<(&Camera, &GlobalTransform)>,
    arrows: Query<&GlobalTransform, With<Arrow>>,
    news: Query<Entity, Added<Arrow>>,
    mut step: ResMut<TimeUpdateStrategy>,
    mut pointer: MessageWriter<PointerInput>,
) {
    // `play` has already increased the number.
    let frame = picture.frame - 1;
    if frame == PRESS + 1
        && let Some((_, arrow)) = &mut picture.pressed
    {
        *arrow = news.iter().next();
    }
    if frame != PRESS {
        return;
    }
    let (camera, place) = *camera;
    let middle = 0.5 * SIZE.as_vec2();
    let seen = arrows
        .iter()
        .filter_map(|arrow| camera.world_to_viewport(place, arrow.translation()).ok())
        .min_by(|a, b| a.distance(middle).total_cmp(&b.distance(middle)));
    let Some(position) = seen else {
        return;
    };
    picture.pressed = Some((position, None));
    // From here on the scene stands still, so that the arrow must be where the pointer was.
    *step = TimeUpdateStrategy::ManualDuration(Duration::ZERO);
    let location = Location {
        target: NormalizedRenderTarget::Image(picture.target.clone().into()),
        position,
    };
    for action in [
        PointerAction::Move { delta: Vec2::ZERO },
        PointerAction::Press(PointerButton::Primary),
    ] {
        pointer.write(PointerInput::new(
            PointerId::Mouse,
            location.clone(),
            action,
        ));
    }
}

/// The ray of a shot, by archers on both sides, at points that are spread evenly over the creature.
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

/// Writes the picture, and checks what it shows.
fn write(
    captured: On<ScreenshotCaptured>,
    picture: Res<Picture>,
    proof: Proof,
    mut exit: MessageWriter<AppExit>,
    mut trouble: Trouble,
) {
    let image = match captured.image.clone().try_into_dynamic() {
        Ok(image) => image.to_rgb8(),
        Err(error) => return trouble.end(error),
    };
    if let Err(error) = image.save(&picture.path) {
        return trouble.end(format_args!("{}: {error}", picture.path.display()));
    }
    let pixels = image.pixels().map(|pixel| pixel.0);
    match proof.check(pixels, picture.pressed) {
        Ok(shown) => {
            println!("{}: {shown}", picture.path.display());
            exit.write(AppExit::Success);
        }
        Err(what) => trouble.end(what),
    }
}
