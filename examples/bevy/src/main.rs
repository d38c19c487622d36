//! A small game: a giant walks through a valley. Grip its fur, climb it, and stand on its head.
//!
//! ```sh
//! cargo run --release
//! cargo run --release -- --height 10 path/to/Fox.glb
//! cargo run -- --script climb.script --screenshot game.png
//! ```

mod aim;
mod arrows;
mod body;
mod creature;
mod film;
mod giant;
mod hero;
mod hud;
mod overlay;
mod pause;
mod proof;
mod script;
mod stage;
mod trouble;
mod valley;

use std::path::PathBuf;

use avian3d::prelude::PhysicsPlugins;
use bevy::asset::UnapprovedPathMode;
use bevy::prelude::*;
use bevy_clamber::prelude::*;
use clap::Parser;

use crate::script::Script;

/// Climb a creature that walks through a valley.
///
/// Keys: WASD or arrows walk and climb, shift or the right mouse button grips, space jumps, the mouse looks, the left
/// mouse button shoots an arrow, R starts again, P pauses, F3 shows what the library does. Gamepads work, too.
#[derive(Parser)]
struct Arguments {
    /// The creature: any glTF or GLB file with a skinned mesh.
    #[arg(default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/colossus.glb"))]
    file: PathBuf,
    /// How high the creature is made, metres, from 1 to 200 [default: as it is in the file].
    #[arg(long, value_name = "METRES", value_parser = height)]
    height: Option<f32>,
    /// Plays this script in place of a player.
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
    /// Writes what the player does to this script.
    #[arg(long, value_name = "FILE", conflicts_with = "script")]
    record: Option<PathBuf>,
    /// Opens no window: plays the script, writes a picture of its end to this PNG file, and ends.
    #[arg(long, value_name = "PNG", requires = "script")]
    screenshot: Option<PathBuf>,
    /// Opens no window: plays the script, films it to this GIF file, and ends.
    #[arg(long, value_name = "GIF", requires = "script")]
    film: Option<PathBuf>,
}

fn height(text: &str) -> Result<f32, String> {
    let metres: f32 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (1.0..=200.0).contains(&metres) {
        Ok(metres)
    } else {
        Err("must be from 1 to 200".into())
    }
}

fn main() -> AppExit {
    let arguments = Arguments::parse();
    match run(arguments) {
        Ok(exit) => exit,
        Err(error) => {
            eprintln!("{error}");
            AppExit::error()
        }
    }
}

fn run(arguments: Arguments) -> Result<AppExit, String> {
    const ANOTHER: &str = "give a glTF or GLB file with a skinned mesh";
    let called = arguments.file.display().to_string();
    let file = arguments.file.canonicalize();
    let file = file.map_err(|error| format!("{called}: {error}; {ANOTHER}"))?;
    let script = arguments.script.as_deref().map(Script::read).transpose()?;
    // Bevy loads assets from one folder: the creature's, so that a glTF file finds the files that it refers to.
    let (Some(folder), Some(name)) = (file.parent(), file.file_name()) else {
        return Err(format!("{called} is not a file; {ANOTHER}"));
    };
    let defaults = DefaultPlugins.set(AssetPlugin {
        file_path: folder.to_string_lossy().into_owned(),
        unapproved_path_mode: UnapprovedPathMode::Forbid,
        ..default()
    });
    let mut app = App::new();
    if arguments.screenshot.is_some() || arguments.film.is_some() {
        app.add_plugins(film::no_window(defaults))
            .add_plugins(film::plugin(arguments.screenshot, arguments.film));
    } else {
        app.add_plugins((stage::window(defaults), pause::plugin));
    }
    app.add_plugins((
        PhysicsPlugins::default(),
        ClamberPlugins::default(),
        ClimberPlugin::default(),
        ClimberCameraPlugin,
    ));
    body::load(&mut app).map_err(|error| format!("the hero: {error}"))?;
    match script {
        Some(script) => app.add_plugins(script::plays(script)),
        None => app.add_plugins(ClimberControlsPlugin),
    };
    if let Some(file) = arguments.record {
        app.add_plugins(script::records(file)?);
    }
    app.add_plugins(creature::plugin(name.into(), arguments.height))
        .add_plugins((giant::plugin, hero::plugin, proof::plugin))
        .add_plugins((valley::plugin, stage::plugin, aim::plugin, arrows::plugin))
        .add_plugins((hud::plugin, overlay::plugin, trouble::plugin(called)));
    Ok(app.run())
}
