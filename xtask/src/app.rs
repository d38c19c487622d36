//! Checks `examples/bevy`, which has a workspace of its own.

use cargo_metadata::Metadata;

use crate::build::owned;
use crate::run::{IGNORE_RUST_VERSION, cargo, cargo_output, cargo_refuses};
use crate::test_run::{self, Targets, TestRun};

/// Manifest of the app's workspace, from the root of the repository.
const WORKSPACE: &str = "examples/bevy/Cargo.toml";

/// Options that the checks pass to the game.
const GIVEN: [&str; 3] = [SCRIPT, SCREENSHOT, FILMED];

/// Option with the file of a script that plays the game.
const SCRIPT: &str = "--script";

/// Option with the file of a picture that the game draws at the end.
const SCREENSHOT: &str = "--screenshot";

/// Option with the file of a film of the game.
const FILMED: &str = "--film";

/// File of the picture that [`play`] has the game draw.
const PICTURE: &str = "target/bevy_app.png";

/// File of the film that [`film`] has the game record.
const FILM: &str = "target/bevy_app.gif";

/// Least time that the hero of `climb.script` spends on the giant, seconds. It does not depend on the machine: a frame
/// is a tick.
const RIDE: f64 = 8.0;

/// Least height that the hero of `climb.script` reaches above the ground, metres. It does not depend on the machine.
const HIGH: f64 = 12.0;

/// Least size of a picture or film, bytes. A picture of the giant has about a million, a picture of a single colour a
/// few thousand.
const LEAST: u64 = 200_000;

/// An empty scene, which the game must refuse.
const STILL: &str = r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{}]}"#;

/// A skinned mesh of lines, which the game must refuse. Its buffer is all zero and replaces the word `BUFFER`.
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

/// Runs the app's tests, then the game itself with scripts.
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

/// Checks the format and performs all [`runs`].
pub(crate) fn check(metadata: &Metadata) -> Result<(), String> {
    format()?;
    runs()
        .iter()
        .try_for_each(|run| (run.perform)(metadata, run))
}

pub(crate) fn format() -> Result<(), String> {
    cargo(&["fmt", "--check", "--manifest-path", WORKSPACE])
}

/// Plays the game by scripts, and gives it files that it must refuse.
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

/// Climbs the giant, and draws a picture at the end. The game itself checks the arrows' places.
fn play() -> Result<(), String> {
    remove(PICTURE)?;
    let script = "examples/bevy/climb.script";
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

/// Records a short film.
fn film() -> Result<(), String> {
    remove(FILM)?;
    let script = "target/short.script";
    let lines = "{\"at\": 0, \"walk\": [0, 0, 1]}\n{\"at\": 1, \"end\": true}\n";
    std::fs::write(script, lines).map_err(|error| format!("{script}: {error}"))?;
    cargo(&played(&[SCRIPT, script, FILMED, FILM]))?;
    check_size(FILM)
}

/// Removes the file of an earlier run.
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

/// Gives the app a file that it cannot use. It must print the reason and end with an error.
fn refuse(file: &str, content: Option<&str>, says: &str) -> Result<(), String> {
    if let Some(content) = content {
        std::fs::write(file, content).map_err(|error| format!("{file}: {error}"))?;
    }
    let script = [SCRIPT, "examples/bevy/climb.script"];
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

/// The arguments of cargo that play the game with these options.
fn played(options: &[&str]) -> Vec<String> {
    run(Targets::Program).arguments("run", options)
}
