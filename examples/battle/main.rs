//! A climber fights a giant that hunts it and shakes it off, from the ground to its head, while rocks fall.
//!
//! `cargo run --release --example battle -- --help` lists the options. The scene, its script and its checks are in
//! `clamber_scenes::battle`. With `--features render`, the example can film the battle.

#[cfg(all(feature = "render", feature = "gltf", feature = "rapier"))]
mod chase;
#[cfg(all(feature = "render", feature = "gltf", feature = "rapier"))]
mod colors;
#[cfg(all(feature = "render", feature = "gltf", feature = "rapier"))]
mod effects;
#[cfg(all(feature = "render", feature = "gltf", feature = "rapier"))]
mod film;
#[cfg(all(feature = "render", feature = "gltf", feature = "rapier"))]
mod overlays;
#[cfg(all(feature = "render", feature = "gltf", feature = "rapier"))]
mod plans;

use std::path::PathBuf;
use std::process::ExitCode;

use clamber_scenes::battle::{self, BattleError, BattleOptions, Summary, TICK};
use clap::{ArgGroup, CommandFactory, Parser, error::ErrorKind};

/// A climber fights a giant of stone and fur, which notices, hunts and strikes it, and shakes once it is climbed. Or
/// the climber rides on a creature that walks and shakes. Rocks fall on both. Prints and checks the results, and writes
/// a summary and a timeline.
#[derive(Debug, Parser)]
#[command(name = "battle", version)]
struct Options {
    #[command(flatten)]
    battle: BattleOptions,

    /// Fights this number of battles, with this seed and the next ones, each until the creature is dead. Prints a line
    /// for each, and writes no files.
    #[arg(long, value_name = "COUNT", conflicts_with = "pictures")]
    #[arg(value_parser = clap::value_parser!(u64).range(1..=10_000))]
    fights: Option<u64>,

    #[command(flatten)]
    film: FilmOptions,
}

/// Options for filming the battle.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Filming, with --features render")]
#[command(group = ArgGroup::new("pictures").multiple(true))]
struct FilmOptions {
    /// Folder for pictures: 00000.png, 00001.png and so on.
    #[arg(long, value_name = "DIR", group = "pictures")]
    frames: Option<PathBuf>,

    /// File for an animated GIF of half the size.
    #[arg(long, value_name = "FILE", group = "pictures")]
    gif: Option<PathBuf>,

    /// Writes raw pictures to standard output: four bytes a pixel, red, green, blue, opacity.
    #[arg(long, group = "pictures")]
    raw: bool,

    /// How the camera moves.
    #[arg(long, value_enum, default_value = "orbit", requires = "pictures")]
    camera: CameraKind,

    /// Overlays that are drawn over the pictures, separated by commas.
    #[arg(
        long,
        value_enum,
        value_delimiter = ',',
        value_name = "WHAT",
        requires = "pictures"
    )]
    overlay: Vec<OverlayKind>,

    /// Pictures per second of the battle, from 0.01 to 60: 0.25 is one in four seconds.
    #[arg(
        long,
        value_name = "COUNT",
        default_value_t = 15.0,
        requires = "pictures"
    )]
    #[arg(value_parser = rate, allow_negative_numbers = true)]
    rate: f64,

    /// Seconds of the battle before filming begins.
    #[arg(
        long,
        value_name = "SECONDS",
        default_value_t = 0.0,
        requires = "pictures"
    )]
    #[arg(value_parser = from, allow_negative_numbers = true)]
    from: f64,

    /// Width of a picture, pixels.
    #[arg(
        long,
        value_name = "PIXELS",
        default_value_t = 1280,
        requires = "pictures"
    )]
    width: u32,

    /// Height of a picture, rows of pixels.
    #[arg(
        long,
        value_name = "PIXELS",
        default_value_t = 720,
        requires = "pictures"
    )]
    rows: u32,
}

fn rate(text: &str) -> Result<f64, String> {
    within(text, 0.01, 60.0)
}

fn from(text: &str) -> Result<f64, String> {
    within(text, 0.0, 1e6)
}

fn within(text: &str, least: f64, most: f64) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if (least..=most).contains(&number) => Ok(number),
        Ok(_) => Err(format!("must be from {least} to {most}")),
        Err(error) => Err(error.to_string()),
    }
}

impl FilmOptions {
    fn is_wanted(&self) -> bool {
        self.frames.is_some() || self.gif.is_some() || self.raw
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum CameraKind {
    /// Circles around the creature.
    Orbit,
    /// Follows the climber, outside of fur; in stabs near the giant's face, it shows both.
    Chase,
    /// Beside the climber, near enough to see its hands.
    Close,
    /// Stands in the valley and turns towards the creature.
    Fixed,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum OverlayKind {
    /// The skeleton.
    Joints,
    /// Clusters of the skin: orange if they were skinned in this tick, else blue.
    Clusters,
    /// The triangle under the climber, and the climber's path.
    Contact,
    /// A material point on each part, and the climber's own point, with their velocities.
    Anchors,
    /// The motion of climber and rocks in this tick, and their contacts.
    Sweeps,
    /// The pieces of skin that the physics engine holds as colliders for the rocks.
    Rocks,
    /// The soles of the creature's feet: blue where they stand, orange in the air.
    Feet,
    /// The way that the bot follows, with a yellow dot for each rest and magenta ones for its goal.
    Plan,
    /// The skin, coloured by the time from there to the bot's goal: from red to blue, which is half a minute or more.
    Ways,
    /// Text: the creature's state, moods and senses.
    Brain,
    /// Text: time, the climber's action, stamina and health, shake, speeds, share of vertices skinned, rocks.
    State,
}

fn main() -> ExitCode {
    let options = Options::parse();
    let (from, seconds) = (options.film.from, options.battle.seconds());
    if options.film.is_wanted() && from > seconds {
        let reason =
            format!("nothing to film: the battle ends after {seconds} s, and --from is {from}");
        Options::command()
            .error(ErrorKind::ValueValidation, reason)
            .exit();
    }
    if let Some(count) = options.fights {
        return siege(&options.battle, count);
    }
    let summary = match run(&options) {
        Ok(summary) => summary,
        Err(error) => {
            eprintln!("battle: {error}");
            return ExitCode::from(2);
        }
    };
    let table = format!("{summary}  written to {}", written(&options));
    if options.film.raw {
        // Standard output is used for the pictures.
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

/// Fights many battles, and prints the result of each.
fn siege(options: &BattleOptions, count: u64) -> ExitCode {
    let bar = indicatif::ProgressBar::new(count);
    let fights = battle::fight_all(options, count, |done| bar.set_position(done));
    bar.finish_and_clear();
    let fights = match fights {
        Ok(fights) => fights,
        Err(error) => {
            eprintln!("battle: {error}");
            return ExitCode::from(2);
        }
    };
    println!("{}", battle::HEADING);
    for fight in &fights {
        println!("{fight}");
    }
    let count =
        |is: &dyn Fn(&battle::Fight) -> bool| fights.iter().filter(|fight| is(fight)).count();
    let killed = fights.iter().filter(|fight| fight.tally.killed > 0);
    let times = killed.map(|fight| fight.tally.killed as f64 * TICK);
    let mean = times.clone().sum::<f64>() / times.clone().count().max(1) as f64;
    println!(
        "of {} fights: {} came to the highest weak point, {} killed the creature, after {mean:.1} s on average",
        fights.len(),
        count(&|fight| fight.arrived.is_some()),
        times.count(),
    );
    ExitCode::SUCCESS
}

/// The paths of all results.
fn written(options: &Options) -> String {
    let (battle, film) = (&options.battle, &options.film);
    let asked = [&battle.record, &film.frames, &film.gif];
    let paths = std::iter::once(&battle.out).chain(asked.into_iter().flatten());
    let paths: Vec<String> = paths.map(|path| path.display().to_string()).collect();
    paths.join(", ")
}

fn run(options: &Options) -> Result<Summary, BattleError> {
    if options.film.is_wanted() {
        filmed(options)
    } else {
        battle::run(&options.battle)
    }
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
        "built without rendering: add `--features render` to the command, before `--`".into(),
    ))
}
