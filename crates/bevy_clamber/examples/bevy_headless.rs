//! A creature in a Bevy app without a window: its clip plays, and a climber drops on it and holds on.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use bevy_app::{App, TaskPoolPlugin};
use bevy_asset::{AssetApp, AssetPlugin, Assets};
use bevy_clamber::events::{ClimberGrabbed, ClimberLanded, ClimberShakenOff};
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::system::{RunSystemError, RunSystemOnce};
use bevy_math::Vec3;
use bevy_mesh::Mesh;
use bevy_mesh::skinning::SkinnedMeshInverseBindposes;
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use bevy_transform::components::Transform;
use clamber_gltf::Model;
use clamber_surface::mesh::Rig;
use clap::Parser;

const COLOSSUS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/colossus.glb");

/// Ticks per second, Bevy's default.
const RATE: f64 = 64.0;

/// Maximum number of updates to wait for the colliders.
const PATIENCE: usize = 1_000_000;

/// Drops a climber on an animated creature, without a window, and tells what happens. It holds on to any skin.
#[derive(Parser)]
struct Arguments {
    /// The creature, a .glb or .gltf file.
    #[arg(default_value = COLOSSUS)]
    file: PathBuf,
    /// The clip to play [default: one with "walk" in its name, else the first].
    #[arg(long)]
    clip: Option<String>,
    /// How much larger the creature is than in its file, 0.001 to 1000. Climbers are 1.7 m tall.
    #[arg(long, default_value_t = 1.0, value_parser = scale)]
    scale: f32,
    /// Seconds to watch, from 0 to 3600.
    #[arg(long, default_value_t = 5.0, value_parser = seconds)]
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

fn scale(text: &str) -> Result<f32, String> {
    let scale: f32 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (0.001..=1000.0).contains(&scale) {
        Ok(scale)
    } else {
        Err("must be from 0.001 to 1000".into())
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
    let model = clamber_gltf::load(&arguments.file)?;
    let clip = clip(&model.rig, arguments.clip.as_deref())?;
    let mut app = app();
    let creature = spawn(&mut app, model, clip.clone(), arguments.scale)?;
    wait(&mut app, &creature)?;
    let (low, top) = bounds(&app, &creature);
    let climber = (
        Climber::colossus_climber(),
        ClimberInput {
            grip: true,
            ..ClimberInput::default()
        },
        Transform::from_translation(top + Vec3::Y * 1.5),
    );
    let climber = app.world_mut().spawn(climber).id();

    let mut seen = String::new();
    let clip = clip.as_deref().unwrap_or("nothing");
    writeln!(
        seen,
        "{}: plays {clip}, {} surfaces, from {low:.2} m up to {top:.2}",
        arguments.file.display(),
        creature.meshes.len()
    )?;
    let (mut ridden, mut way, mut before) = (0, 0.0, None);
    let ticks = (arguments.seconds * RATE) as usize;
    for tick in 0..ticks {
        app.update();
        let happened = std::mem::take(&mut app.world_mut().resource_mut::<Happened>().0);
        for what in happened {
            writeln!(seen, "{:6.2} s: {what}", tick as f64 / RATE)?;
        }
        let state = app.world().get::<ClimberState>(climber);
        let state = state.ok_or("the climber is gone")?;
        ridden += usize::from(state.support.is_some());
        let moved = before.map_or(0.0, |before| state.position.distance(before));
        way += if state.support.is_some() { moved } else { 0.0 };
        before = Some(state.position);
        if state.position.y < f64::from(low) - 50.0 {
            break;
        }
    }
    writeln!(
        seen,
        "on the creature for {:.2} of {:.2} s, which carried the climber {way:.2} m",
        ridden as f64 / RATE,
        arguments.seconds
    )?;
    if arguments.file.as_os_str() == COLOSSUS && arguments.clip.is_none() && ticks > 128 {
        assert!(ridden * 2 > ticks && way > 1.0, "the giant carries nobody");
    }
    Ok(seen)
}

/// What happened to the climber since the last update.
#[derive(Resource, Default)]
struct Happened(Vec<String>);

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
        ClimberPlugin::default(),
        RigPlayerPlugin::default(),
    ))
    .init_asset::<Mesh>()
    .init_asset::<SkinnedMeshInverseBindposes>()
    .insert_resource(DefaultClimberRule(ClimberRule::new(|at| {
        at.usual().with_grip(true)
    })))
    .init_resource::<Happened>()
    .add_observer(|what: On<ClimberLanded>, mut happened: ResMut<Happened>| {
        let landed = format!("landed at {:.1} m/s", what.speed);
        happened.0.push(landed);
    })
    .add_observer(|what: On<ClimberGrabbed>, mut happened: ResMut<Happened>| {
        happened.0.push(format!("holds on at {:.2}", what.point));
    })
    .add_observer(
        |what: On<ClimberShakenOff>, mut happened: ResMut<Happened>| {
            let shaken = format!("is shaken off at {:.1} m/s²", what.shake);
            happened.0.push(shaken);
        },
    );
    app.finish();
    app.cleanup();
    app
}

/// The creature, with a surface of each of its meshes.
fn spawn(
    app: &mut App,
    model: Model,
    clip: Option<String>,
    scale: f32,
) -> Result<SpawnedRig, Error> {
    let add =
        move |mut commands: Commands,
              mut meshes: ResMut<Assets<Mesh>>,
              mut inverse_bindposes: ResMut<Assets<SkinnedMeshInverseBindposes>>| {
            let assets = RigAssets::new(model.clone(), &mut meshes, &mut inverse_bindposes)?;
            let spawned = assets.spawn(&mut commands, Transform::from_scale(Vec3::splat(scale)));
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

/// Updates the app until every surface is built, and then for one tick, which poses them. No time passes before, so
/// that the creature is at the start of its clip however long this takes.
fn wait(app: &mut App, creature: &SpawnedRig) -> Result<(), Error> {
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
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
            app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
            app.update();
            return Ok(());
        }
        std::thread::yield_now();
    }
    Err("the colliders were not built in time".into())
}

/// The height of the lowest point of the skin, and its highest point.
fn bounds(app: &App, creature: &SpawnedRig) -> (f32, Vec3) {
    let (mut low, mut top) = (f32::INFINITY, Vec3::NEG_INFINITY);
    let mut positions = Vec::new();
    for mesh in &creature.meshes {
        if let Some(surface) = app.world().get::<PosedSurface>(*mesh) {
            surface.skin_all(&mut positions);
            for position in &positions {
                let place = surface.world_from_model().transform_point_f32(*position);
                let place = place.as_vec3();
                low = low.min(place.y);
                top = if place.y > top.y { place } else { top };
            }
        }
    }
    (low, top)
}
