//! A window with an animated creature: click on it, and arrows stick in its skin and follow it.
//!
//! ```sh
//! cargo run -- ../../assets/colossus.glb --clip walk
//! cargo run -- --screenshot arrows.png
//! ```

mod aim;
mod arrows;
mod creature;
mod orbit;
mod picture;
mod proof;
mod stage;
mod trouble;

use std::path::PathBuf;

use bevy::asset::UnapprovedPathMode;
use bevy::prelude::*;
use bevy_clamber::prelude::*;
use clap::Parser;

/// Shows an animated creature to shoot arrows at: left button shoots, right button and wheel move the camera.
#[derive(Parser)]
struct Arguments {
    /// The creature: any glTF or GLB file with a skinned mesh.
    #[arg(default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/colossus.glb"))]
    file: PathBuf,
    /// The animation to play; if the file has none of this name, its first one.
    #[arg(long, default_value = "walk")]
    clip: String,
    /// Opens no window: shoots some arrows by itself, writes a picture to this PNG file, and ends.
    #[arg(long, value_name = "PNG")]
    screenshot: Option<PathBuf>,
}

fn main() -> AppExit {
    let arguments = Arguments::parse();
    let called = arguments.file.display().to_string();
    let file = match arguments.file.canonicalize() {
        Ok(file) => file,
        Err(error) => {
            eprintln!("{called}: {error}; give a glTF or GLB file with a skinned mesh");
            return AppExit::error();
        }
    };
    // Bevy loads assets from one folder: the creature's, so that a glTF file finds the files that it refers to.
    let (Some(folder), Some(name)) = (file.parent(), file.file_name()) else {
        eprintln!("{called} is not a file; give a glTF or GLB file with a skinned mesh");
        return AppExit::error();
    };
    let defaults = DefaultPlugins.set(AssetPlugin {
        file_path: folder.to_string_lossy().into_owned(),
        unapproved_path_mode: UnapprovedPathMode::Forbid,
        ..default()
    });
    let mut app = App::new();
    match &arguments.screenshot {
        None => app.add_plugins((stage::window(defaults), orbit::plugin)),
        Some(picture) => app.add_plugins((
            picture::no_window(defaults),
            picture::plugin(picture.clone()),
        )),
    };
    app.add_plugins((ClamberPlugins::default(), arrows::plugin, stage::plugin))
        .add_plugins((aim::plugin, trouble::plugin(called)))
        .add_plugins(creature::plugin(name.into(), arguments.clip))
        .run()
}
