//! A creature in a Bevy app without a window: its clip plays, a ray hits its skin, and an arrow that is attached there
//! follows it.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use bevy_app::{App, TaskPoolPlugin};
use bevy_asset::{AssetApp, AssetPlugin, Assets};
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::system::{RunSystemError, RunSystemOnce};
use bevy_math::{Dir3, Vec3};
use bevy_mesh::Mesh;
use bevy_mesh::skinning::SkinnedMeshInverseBindposes;
use bevy_shape::Ray3d;
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use bevy_transform::components::{GlobalTransform, Transform};
use clamber_gltf::Rig;
use clap::Parser;

const COLOSSUS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/colossus.glb");

/// Ticks per second, Bevy's default.
const RATE: f64 = 64.0;

/// Maximum number of updates to wait for the colliders.
const PATIENCE: usize = 1_000_000;

/// Sticks an arrow in an animated creature, without a window, and follows the arrow.
#[derive(Parser)]
struct Arguments {
    /// The creature, a .glb or .gltf file.
    #[arg(default_value = COLOSSUS)]
    file: PathBuf,
    /// The clip to play [default: one with "walk" in its name, else the first].
    #[arg(long)]
    clip: Option<String>,
    /// Seconds to follow the arrow, from 0 to 3600.
    #[arg(long, default_value_t = 3.0, value_parser = seconds)]
    seconds: f64,
}

fn seconds(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (0.0..=3600.0).contains(&seconds) {
        Ok(seconds)
    } else {
        Err("must be from 0 to 3600".into())
    }
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(seen) => {
            print!("{seen}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("bevy_headless: {error}");
            ExitCode::FAILURE
        }
    }
}

type Error = Box<dyn std::error::Error>;

/// Converts Bevy's error, which is not a `std::error::Error`.
fn not_run(error: RunSystemError) -> Error {
    error.to_string().into()
}

fn run(arguments: &Arguments) -> Result<String, Error> {
    let rig = clamber_gltf::load(&arguments.file)?;
    let clip = clip(&rig, arguments.clip.as_deref())?;
    let mut app = app();
    let creature = spawn(&mut app, rig, clip.clone())?;
    wait(&mut app, &creature)?;

    // An eye that looks at the creature from the right, at a distance of about its size.
    let (low, high) = bounds(&app, &creature);
    let size = (high - low).length();
    let eye = (low + high) / 2.0 + Vec3::new(1.0, 0.3, 0.2) * size;
    let (hit, arrow) = app
        .world_mut()
        .run_system_once_with(shoot, (eye, (low + high) / 2.0))
        .map_err(not_run)??;
    let mut seen = String::new();
    let clip = clip.as_deref().unwrap_or("nothing");
    writeln!(seen, "{}: plays {clip}", arguments.file.display())?;
    writeln!(
        seen,
        "{} surfaces, from {low:.2} to {high:.2}",
        creature.meshes.len()
    )?;
    let (tag, point, distance) = (hit.tag, hit.point, hit.distance);
    writeln!(
        seen,
        "the ray from {eye:.2} hits {tag:?} at {point:.2}, {distance:.2} away"
    )?;

    let (mut before, mut way, mut fastest, mut worst) = (point, 0.0f32, 0.0f32, 0.0f32);
    let ticks = (arguments.seconds * RATE) as usize;
    for _ in 0..ticks {
        app.update();
        let place = app.world().get::<GlobalTransform>(arrow);
        let place = place.ok_or("the arrow is gone")?.translation();
        // Each frame is one tick, so queries see the pose that is drawn.
        let skin = app.world_mut().run_system_once_with(nearest, place);
        let skin = skin.map_err(not_run)?;
        worst = worst.max(skin.ok_or("the skin is gone")?.distance);
        way += (place - before).length();
        fastest = fastest.max((place - before).length() * RATE as f32);
        before = place;
    }
    writeln!(
        seen,
        "in {ticks} ticks the arrow moved {way:.3}, at up to {fastest:.3} a second, and was at most {worst:.1e} off \
         the skin"
    )?;
    assert!(worst <= 1e-5 * size, "the arrow left the skin: {worst}");
    if arguments.file.as_os_str() == COLOSSUS && arguments.clip.is_none() && ticks > 0 {
        assert!(way > 0.0, "the giant walks, but the arrow stands still");
    }
    Ok(seen)
}

/// The clip to play; `None` if the creature has none.
fn clip(rig: &Rig, wanted: Option<&str>) -> Result<Option<String>, Error> {
    let names: Vec<&str> = rig.clips.iter().map(|clip| clip.name.as_str()).collect();
    let walks = |name: &&&str| name.to_lowercase().contains("walk");
    let own = names.iter().find(walks).or(names.first()).copied();
    match wanted {
        Some(wanted) if names.contains(&wanted) => Ok(Some(wanted.to_owned())),
        Some(wanted) => Err(format!("no clip {wanted:?}; there are {names:?}").into()),
        None => Ok(own.map(str::to_owned)),
    }
}

/// An app without a window or a renderer, each update of which is one tick.
fn app() -> App {
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        TimePlugin,
        TransformPlugin,
        AssetPlugin::default(),
        ClamberPlugins::default(),
        RigPlayerPlugin::default(),
    ))
    .init_asset::<Mesh>()
    .init_asset::<SkinnedMeshInverseBindposes>()
    .insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
    app.finish();
    app.cleanup();
    app
}

/// The creature, with a surface of each of its meshes.
fn spawn(app: &mut App, rig: Rig, clip: Option<String>) -> Result<SpawnedRig, Error> {
    let add =
        move |mut commands: Commands,
              mut meshes: ResMut<Assets<Mesh>>,
              mut inverse_bindposes: ResMut<Assets<SkinnedMeshInverseBindposes>>| {
            let assets = RigAssets::new(rig.clone(), &mut meshes, &mut inverse_bindposes)?;
            let spawned = assets.spawn(&mut commands, Transform::IDENTITY);
            if let Some(clip) = &clip {
                commands
                    .entity(spawned.root)
                    .insert(RigPlayer::new(clip.clone()));
            }
            for mesh in &spawned.meshes {
                // The clip plays in the fixed loop.
                commands.entity(*mesh).insert(SkinnedCollider::each_tick());
            }
            Ok::<_, bevy_clamber::TooManyJoints>(spawned)
        };
    Ok(app.world_mut().run_system_once(add).map_err(not_run)??)
}

/// Updates the app until every surface is built.
fn wait(app: &mut App, creature: &SpawnedRig) -> Result<(), Error> {
    for _ in 0..PATIENCE {
        app.update();
        let mut built = 0;
        for mesh in &creature.meshes {
            match app.world().get::<ColliderStatus>(*mesh) {
                Some(ColliderStatus::Ready) => built += 1,
                Some(ColliderStatus::Failed(error)) => return Err(error.to_string().into()),
                _ => {}
            }
        }
        if built == creature.meshes.len() {
            return Ok(());
        }
        std::thread::yield_now();
    }
    Err("the colliders were not built in time".into())
}

/// Lowest and highest corner of a box around the skin.
fn bounds(app: &App, creature: &SpawnedRig) -> (Vec3, Vec3) {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let mut positions = Vec::new();
    for mesh in &creature.meshes {
        if let Some(surface) = app.world().get::<PosedSurface>(*mesh) {
            surface.skin_all(&mut positions);
            for position in &positions {
                let place = surface.world_from_model().transform_point_f32(*position);
                low = low.min(place.as_vec3());
                high = high.max(place.as_vec3());
            }
        }
    }
    (low, high)
}

/// Attaches an arrow to the skin that is nearest to an eye. The ray aims a little towards the creature's middle: the
/// nearest point itself may be a corner that sticks out, which a ray could miss.
fn shoot(
    In((eye, middle)): In<(Vec3, Vec3)>,
    surfaces: SurfaceQuery,
    mut commands: Commands,
) -> Result<(EntityHit, Entity), String> {
    let all = SurfaceFilter::default();
    let nearest = surfaces.closest_point(eye, f32::INFINITY, &all);
    let nearest = nearest.ok_or("there is no skin")?;
    let target = nearest.point.lerp(middle, 0.05);
    let toward = Dir3::new(target - eye).map_err(|_| "the eye is on the skin")?;
    let hit = surfaces.cast_ray(Ray3d::new(eye, toward), f32::INFINITY, &all);
    let hit = hit.ok_or("the ray misses the skin that it is aimed at")?;
    // No hit is nearer than the closest point.
    assert!(
        hit.distance >= nearest.distance * 0.9999,
        "{hit:?} {nearest:?}"
    );
    let anchor = surfaces
        .anchor_at(&hit)
        .map_err(|error| error.to_string())?;
    Ok((hit, commands.spawn(anchor).id()))
}

fn nearest(point: In<Vec3>, surfaces: SurfaceQuery) -> Option<EntityHit> {
    surfaces.closest_point(*point, f32::INFINITY, &SurfaceFilter::default())
}
