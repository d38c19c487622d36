//! `examples/bevy_app`, which is no part of the workspace.

use cargo_metadata::Metadata;

use crate::build::owned;
use crate::run::{IGNORE_RUST_VERSION, cargo, cargo_output, cargo_refuses};
use crate::test_run::{self, Targets, TestRun};

const WORKSPACE: &str = "examples/bevy_app/Cargo.toml";

/// The options that the game is given.
const GIVEN: [&str; 3] = [SCRIPT, SCREENSHOT, FILMED];
const SCRIPT: &str = "--script";
const SCREENSHOT: &str = "--screenshot";
const FILMED: &str = "--film";

const PICTURE: &str = "target/bevy_app.png";
const FILM: &str = "target/bevy_app.gif";

/// What the hero of `climb.script` achieves at least: seconds on the giant, and metres above the ground. It does not
/// depend on the machine: a frame is a tick.
const RIDE: f64 = 8.0;
const HIGH: f64 = 12.0;

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

/// Its tests, and the game, played by scripts.
pub(crate) fn runs() -> Vec<TestRun> {
    vec![run(Targets::All), run(Targets::Program)]
}

fn run(targets: Targets) -> TestRun {
    let perform = match targets {
        Targets::Program => |_: &Metadata, _: &TestRun| play_all(),
        _ => test_run::test,
    };
    TestRun {
        workspace: WORKSPACE,
        targets: vec![targets],
        options: owned(&["--locked", IGNORE_RUST_VERSION, "--quiet"]),
        given: |_| GIVEN.to_vec(),
        perform,
        ..TestRun::default()
    }
}

/// The format, and all of its [`runs`].
pub(crate) fn check(metadata: &Metadata) -> Result<(), String> {
    format()?;
    runs()
        .iter()
        .try_for_each(|run| (run.perform)(metadata, run))
}

pub(crate) fn format() -> Result<(), String> {
    cargo(&["fmt", "--check", "--manifest-path", WORKSPACE])
}

/// Lets scripts play the game, and gives it files that it must refuse.
fn play_all() -> Result<(), String> {
    std::fs::create_dir_all("target").map_err(|error| format!("target: {error}"))?;
    play()?;
    film()?;
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

/// Climbs the giant, and draws a picture at the end. The game checks the arrows by itself.
fn play() -> Result<(), String> {
    remove(PICTURE)?;
    let script = "examples/bevy_app/climb.script";
    let said = cargo_output(&played(&[SCRIPT, script, SCREENSHOT, PICTURE]))?;
    print!("{said}");
    let number = |before: &str| {
        let rest = said.split_once(before).map(|(_, rest)| rest);
        let number = rest.and_then(|rest| rest.split_whitespace().next());
        number.and_then(|number| number.parse::<f64>().ok())
    };
    let (ride, high) = (number("on the creature for "), number("up to "));
    if ride.is_none_or(|ride| ride < RIDE) || high.is_none_or(|high| high < HIGH) {
        return Err(format!(
            "the hero should ride for {RIDE} s and climb to {HIGH} m"
        ));
    }
    if !said.contains("\n2 arrows") {
        return Err("two arrows should stick".into());
    }
    check_size(PICTURE)
}

/// A short film.
fn film() -> Result<(), String> {
    remove(FILM)?;
    let script = "target/short.script";
    let lines = "{\"at\": 0, \"walk\": [0, 0, 1]}\n{\"at\": 1, \"end\": true}\n";
    std::fs::write(script, lines).map_err(|error| format!("{script}: {error}"))?;
    cargo(&played(&[SCRIPT, script, FILMED, FILM]))?;
    check_size(FILM)
}

/// Removes what a run before has left.
fn remove(file: &str) -> Result<(), String> {
    if std::fs::exists(file).is_ok_and(|there| there) {
        std::fs::remove_file(file).map_err(|error| format!("{file}: {error}"))?;
    }
    Ok(())
}

fn check_size(file: &str) -> Result<(), String> {
    let bytes = std::fs::metadata(file)
        .map_err(|error| format!("{file}: {error}"))?
        .len();
    if bytes < LEAST {
        return Err(format!("{file} has {bytes} bytes: nothing is in it"));
    }
    Ok(())
}

/// Gives the app a file that it can do nothing with: it must say so, and end.
fn refuse(file: &str, content: Option<&str>, says: &str) -> Result<(), String> {
    if let Some(content) = content {
        std::fs::write(file, content).map_err(|error| format!("{file}: {error}"))?;
    }
    let script = [SCRIPT, "examples/bevy_app/climb.script"];
    let said = cargo_refuses(&played(
        &[&script[..], &[SCREENSHOT, "target/none.png", file]].concat(),
    ))?;
    let line = said.lines().find(|line| line.contains(file));
    if line.is_some_and(|line| line.contains(says)) {
        Ok(())
    } else {
        Err(format!(
            "the app should say of {file} that {says:?}; it said\n{said}"
        ))
    }
}

/// How cargo is called to play the game with these options.
fn played(options: &[&str]) -> Vec<String> {
    run(Targets::Program).arguments("run", options)
}
