//! `examples/bevy_app`, which is no part of the workspace.

use crate::run::{IGNORE_RUST_VERSION, cargo, cargo_refuses};

const MANIFEST: [&str; 2] = ["--manifest-path", "examples/bevy_app/Cargo.toml"];

/// One picture does not pay for optimised dependencies.
const FAST: [&str; 2] = ["--config", "profile.dev.package.\"*\".opt-level=0"];

const PICTURE: &str = "target/bevy_app.png";

/// Bytes that a picture has at least: the giant's has about a million, one of a single colour a few thousand.
const LEAST: u64 = 200_000;

/// A scene in which nothing is.
const STILL: &str = r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{}]}"#;

/// A skinned mesh of lines; its buffer, here `BUFFER`, is all zero.
const LINES: &str = r#"{
    "asset": {"version": "2.0"},
    "scenes": [{"nodes": [0, 1]}],
    "nodes": [{"mesh": 0, "skin": 0}, {}],
    "skins": [{"joints": [1]}],
    "meshes": [{"primitives": [{"mode": 1, "attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}]}],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 2, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0]},
        {"bufferView": 0, "componentType": 5121, "count": 2, "type": "VEC4"},
        {"bufferView": 0, "componentType": 5126, "count": 2, "type": "VEC4"}
    ],
    "bufferViews": [{"buffer": 0, "byteLength": 33}],
    "buffers": [{"byteLength": 33, "uri": "data:application/octet-stream;base64,BUFFER"}]
}"#;

/// Builds the app, lets it draw a picture, which it checks by itself, and gives it files that it must refuse.
pub(crate) fn check() -> Result<(), String> {
    cargo(&[&["fmt", "--check"][..], &MANIFEST].concat())?;
    std::fs::create_dir_all("target").map_err(|error| format!("target: {error}"))?;
    draw()?;
    let lines = LINES.replace("BUFFER", &"A".repeat(44));
    refuse("target/nothing.glb", None, "give a glTF")?;
    refuse("target/broken.glb", Some("no glTF"), "cannot be loaded")?;
    refuse("target/still.gltf", Some(STILL), "no skinned mesh")?;
    refuse(
        "target/lines.gltf",
        Some(&lines),
        "no mesh can be a surface",
    )
}

/// The giant with arrows. The app checks what is to be seen in the picture; here only that there is one.
fn draw() -> Result<(), String> {
    // That of a run before would do as well.
    if std::fs::exists(PICTURE).is_ok_and(|there| there) {
        std::fs::remove_file(PICTURE).map_err(|error| format!("{PICTURE}: {error}"))?;
    }
    cargo(&run(&["--screenshot", PICTURE]))?;
    let bytes = std::fs::metadata(PICTURE)
        .map_err(|error| format!("{PICTURE}: {error}"))?
        .len();
    if bytes < LEAST {
        return Err(format!("{PICTURE} has {bytes} bytes: nothing is in it"));
    }
    Ok(())
}

/// Gives the app a file that it can do nothing with: it must say so, and end.
fn refuse(file: &str, content: Option<&str>, says: &str) -> Result<(), String> {
    if let Some(content) = content {
        std::fs::write(file, content).map_err(|error| format!("{file}: {error}"))?;
    }
    let said = cargo_refuses(&run(&["--screenshot", "target/none.png", file]))?;
    let line = said.lines().find(|line| line.contains(file));
    if line.is_some_and(|line| line.contains(says)) {
        Ok(())
    } else {
        Err(format!(
            "the app should say of {file} that {says:?}; it said\n{said}"
        ))
    }
}

fn run<'a>(app: &[&'a str]) -> Vec<&'a str> {
    let run = ["run", "--locked", IGNORE_RUST_VERSION, "--quiet"];
    [&run[..], &FAST, &MANIFEST, &["--"], app].concat()
}
