//! Plays the game by scripts, and gives it files that it must refuse. Draws off-screen, so it needs Vulkan.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

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

/// A file that the test writes.
fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// Runs the game with a script and further arguments.
fn play(script: &Path, arguments: &[&Path]) -> Output {
    let mut game = Command::new(env!("CARGO_BIN_EXE_clamber_bevy_app"));
    game.arg("--script").arg(script).args(arguments);
    game.output().unwrap()
}

/// Removes the file of an earlier run.
fn fresh(name: &str) -> PathBuf {
    let path = file(name);
    if path.exists() {
        fs::remove_file(&path).unwrap();
    }
    path
}

/// Asserts that the game drew something.
fn assert_drawn(path: &Path, output: &Output) {
    assert!(output.status.success(), "{output:?}");
    let bytes = fs::metadata(path).unwrap().len();
    assert!(bytes >= LEAST, "{} has {bytes} bytes", path.display());
}

/// The number that follows these words.
fn number(text: &str, before: &str) -> f64 {
    let after = text.split_once(before).unwrap().1;
    after.split_whitespace().next().unwrap().parse().unwrap()
}

/// The game itself checks the arrows' places.
#[test]
#[ignore = "takes minutes: draws hundreds of frames"]
fn the_hero_climbs_the_giant_and_two_arrows_stick() {
    let picture = fresh("game.png");
    let output = play(
        Path::new("climb.script"),
        &[Path::new("--screenshot"), &picture],
    );
    assert_drawn(&picture, &output);
    let said = String::from_utf8(output.stdout).unwrap();
    let (ride, high) = (
        number(&said, "on the creature for "),
        number(&said, "up to "),
    );
    assert!(ride >= RIDE, "{said}");
    assert!(high >= HIGH, "{said}");
    assert!(said.contains("\n2 arrows"), "{said}");
}

#[test]
#[ignore = "takes a minute: draws a second of frames"]
fn a_script_is_filmed() {
    let (script, film) = (file("short.script"), fresh("game.gif"));
    let lines = "{\"at\": 0, \"walk\": [0, 0, 1]}\n{\"at\": 1, \"end\": true}\n";
    fs::write(&script, lines).unwrap();
    let output = play(&script, &[Path::new("--film"), &film]);
    assert_drawn(&film, &output);
}

#[test]
#[ignore = "starts the renderer four times"]
fn files_that_cannot_be_climbed_are_refused_with_a_reason() {
    let lines = LINES.replace("BUFFER", &"A".repeat(44));
    for (name, content, reason) in [
        ("nothing.glb", None, "give a glTF"),
        ("broken.glb", Some("no glTF"), "cannot be loaded"),
        ("still.gltf", Some(STILL), "no skinned mesh"),
        (
            "lines.gltf",
            Some(lines.as_str()),
            "no mesh can be a surface",
        ),
    ] {
        let path = file(name);
        if let Some(content) = content {
            fs::write(&path, content).unwrap();
        }
        let picture = file("none.png");
        let output = play(
            Path::new("climb.script"),
            &[Path::new("--screenshot"), &picture, &path],
        );
        // Not a panic, whose exit code is 101.
        assert_eq!(output.status.code(), Some(1), "{name}: {output:?}");
        let said = String::from_utf8(output.stderr).unwrap();
        let line = said
            .lines()
            .find(|line| line.contains(path.to_str().unwrap()));
        assert!(
            line.is_some_and(|line| line.contains(reason)),
            "{name}: {said}"
        );
    }
}
