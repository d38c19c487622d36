//! The main job: a climber climbs a walking, stomping, shaking creature from the ground to its head, and rocks fall on it.
//!
//! `cargo run --release --example battle -- --help` lists the options. The scene itself, its script
//! and its checks are `clamber_scenes::battle`; with `--features render` it can be filmed.

#[cfg(all(feature = "render", feature = "gltf", feature = "rapier"))]
mod film;
#[cfg(all(feature = "render", feature = "gltf", feature = "rapier"))]
mod overlays;

use std::path::PathBuf;
use std::process::ExitCode;

use clamber_scenes::battle::{self, BattleError, BattleOptions, Summary};
use clap::Parser;

/// A climber climbs a giant of stone and fur from the ground to its head, or rides on a creature, while it stomps,
/// shakes and is struck by rocks. Prints what came of it, checks it, and writes a summary and a timeline.
#[derive(Debug, Parser)]
#[command(name = "battle", version)]
struct Options {
    #[command(flatten)]
    battle: BattleOptions,
    #[command(flatten)]
    film: FilmOptions,
}

/// How the battle is filmed.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Filming, with --features render")]
struct FilmOptions {
    /// Folder for pictures: 00000.png, 00001.png and so on.
    #[arg(long, value_name = "DIR")]
    frames: Option<PathBuf>,

    /// File for a moving picture of half the size.
    #[arg(long, value_name = "FILE")]
    gif: Option<PathBuf>,

    /// Writes pictures to standard output, bare: four bytes a pixel, red, green, blue, opacity.
    #[arg(long)]
    raw: bool,

    /// Where the camera is.
    #[arg(long, value_enum, default_value = "orbit")]
    camera: CameraKind,

    /// What is drawn over the pictures, with commas between.
    #[arg(long, value_enum, value_delimiter = ',', value_name = "WHAT")]
    overlay: Vec<OverlayKind>,

    /// Pictures for a second of the battle.
    #[arg(long, value_name = "COUNT", default_value_t = 15)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=60))]
    rate: u32,

    /// Seconds of the battle that pass before filming begins.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0)]
    from: f64,

    /// Pixels along a row.
    #[arg(long, value_name = "PIXELS", default_value_t = 1280)]
    width: u32,

    /// Rows of pixels.
    #[arg(long, value_name = "PIXELS", default_value_t = 720)]
    rows: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum CameraKind {
    /// Circles around the creature.
    Orbit,
    /// Follows the climber.
    Chase,
    /// Stands in the valley and turns after the creature.
    Fixed,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum OverlayKind {
    /// The skeleton.
    Joints,
    /// Capsules around the parts.
    Capsules,
    /// Spheres around the parts.
    Spheres,
    /// The skin's clusters: orange if skinned in this tick, else blue.
    Clusters,
    /// The triangle under the climber, and the way it came.
    Contact,
    /// A material point on each part, and the one under the climber, with their velocities.
    Anchors,
    /// How climber and rocks moved in this tick, and where they touched something.
    Sweeps,
    /// The pieces of skin that the physics engine has for the rocks.
    Rocks,
    /// Text: time, what the climber does, its strength and health, shake, speeds, what was skinned.
    State,
}

fn main() -> ExitCode {
    let options = Options::parse();
    let summary = match run(&options) {
        Ok(summary) => summary,
        Err(error) => {
            eprintln!("battle: {error}");
            return ExitCode::from(2);
        }
    };
    let table = format!("{summary}  written to {}", options.battle.out.display());
    if options.film.raw {
        // Standard output has the pictures.
        eprintln!("{table}");
    } else {
        println!("{table}");
    }
    if summary.holds() {
        ExitCode::SUCCESS
    } else {
        eprintln!("battle: a check failed");
        ExitCode::FAILURE
    }
}

fn run(options: &Options) -> Result<Summary, BattleError> {
    let film = &options.film;
    if film.frames.is_none() && film.gif.is_none() && !film.raw {
        return battle::run(&options.battle);
    }
    filmed(options)
}

#[cfg(all(feature = "render", feature = "gltf", feature = "rapier"))]
fn filmed(options: &Options) -> Result<Summary, BattleError> {
    let failed = |error: Box<dyn std::error::Error + Send + Sync>| BattleError::Watching(error);
    let mut film = film::Film::new(&options.battle, &options.film).map_err(failed)?;
    battle::run_watched(&options.battle, |battle| film.watch(battle).map_err(failed))
}

#[cfg(not(all(feature = "render", feature = "gltf", feature = "rapier")))]
fn filmed(_: &Options) -> Result<Summary, BattleError> {
    Err(BattleError::Watching(
        "built without pictures: add `--features render` to the command, before `--`".into(),
    ))
}
