//! Checks the main example as built for tests: it records a battle, fights it again and films it with equal results,
//! and refuses wrong options. As released, with equal results, the battle is a golden run.

use std::collections::BTreeMap;

use cargo_metadata::Metadata;
use cargo_metadata::camino::{Utf8Path, Utf8PathBuf};

use crate::build::{self, owned};
use crate::run::{note_skipped, program, refuses};
use crate::test_run::{Packages, Profile, Targets, TestRun};

/// Paths of the examples' binaries, by name.
type Examples = BTreeMap<String, Utf8PathBuf>;

/// Options of the battle whose hash is compared.
const FIGHT: [&str; 4] = ["--seconds", "12", "--out", "target/xtask-battle"];

/// File of the recording.
const RECORDING: &str = "target/xtask-battle.mcap";

/// Options that record the battle.
const RECORD: [&str; 2] = ["--record", RECORDING];

/// Options that fight the recorded battle again from tick 200.
const FROM: [&str; 2] = ["--from", "200"];

/// Value of the option `--overlay` with all overlays of a battle.
const OVERLAYS: &str = "joints,contact,anchors,plan,ways,state";

/// Folder of the film's pictures.
const FRAMES: &str = "target/xtask-frames";

/// Options that film a second of the battle, 4 pictures a second, with all overlays.
const FILM: [&str; 16] = [
    "--width",
    "320",
    "--rows",
    "180",
    "--overlay",
    OVERLAYS,
    "--from",
    "11",
    "--rate",
    "4",
    "--camera",
    "chase",
    "--frames",
    FRAMES,
    "--gif",
    "target/xtask-frames/battle.gif",
];

/// Options that a battle refuses, each with a part of the reason that it prints. Without the reason, a machine that
/// cannot draw would seem to refuse them.
const REFUSED: [(&[&str], &str); 6] = [
    (
        &["--rate", "0", "--frames", "target/none"],
        "from 0.01 to 60",
    ),
    (&["--from", "nan", "--frames", "target/none"], "from 0 to"),
    (
        &["--seconds", "1", "--from", "99", "--frames", "target/none"],
        "nothing to film",
    ),
    (&["--camera", "chase"], "--frames <DIR>"),
    (&["--overlay", "joints"], "--frames <DIR>"),
    (&["--record", "Cargo.toml/none"], "cannot write Cargo.toml"),
];

/// Options that these checks pass to the examples `battle` and `replay`.
pub(crate) fn given(name: &str) -> Vec<&'static str> {
    match name {
        "battle" => [&FIGHT[..], &RECORD, &FILM].concat(),
        "replay" => FROM.to_vec(),
        _ => Vec::new(),
    }
}

/// Checks all of this with the examples as built for tests.
pub(crate) fn check(examples: &Examples) -> Result<(), String> {
    let battle = find(examples, "battle")?;
    for (arguments, reason) in REFUSED {
        refuses(battle, arguments, reason)?;
    }
    let hash = fight(battle, &[])?;
    record(examples, &hash)?;
    replay(examples)?;
    film(battle, &hash)
}

/// Checks that the battle has the same hash as released and as built for tests.
pub(crate) fn compare_builds() -> Result<(), String> {
    let battle = || vec![Targets::Example("battle".into())];
    let tested = build::examples(&build::selection().of(battle()))?;
    let released = build::examples(&build::released().of(battle()))?;
    let fast = fight(find(&released, "battle")?, &[])?;
    let plain = fight(find(&tested, "battle")?, &[])?;
    if plain != fast {
        return Err(format!(
            "the battle's hash is {fast} in release, and {plain} as built for tests"
        ));
    }
    println!("   battle: hash {fast} in both profiles");
    program(find(&released, "battle")?, &["--out", "target/xtask-climb"])
}

/// Checks that a release build fights the recording of a development build again, and the other way round. Both are
/// without `deterministic`, as most users build it.
pub(crate) fn exchange_recordings(_: &Metadata) -> Result<(), String> {
    let build = |profile| {
        let example = |name: &str| Targets::Example(name.into());
        build::examples(&TestRun {
            profile,
            packages: Packages::Named(owned(&["clamber"])),
            features: owned(&["clamber/record"]),
            targets: vec![example("battle"), example("replay")],
            ..TestRun::default()
        })
    };
    let (plain, released) = (build(Profile::Dev)?, build(Profile::Release)?);
    let hash = fight(find(&released, "battle")?, &[])?;
    for [from, to] in [[&plain, &released], [&released, &plain]] {
        record(from, &hash)?;
        replay(to)?;
    }
    Ok(())
}

/// Records a battle and checks its hash.
fn record(build: &Examples, hash: &str) -> Result<(), String> {
    let recorded = fight(find(build, "battle")?, &RECORD)?;
    if recorded == hash {
        Ok(())
    } else {
        Err(format!(
            "the battle's hash is {hash}, and {recorded} if it is recorded"
        ))
    }
}

/// Fights the recorded battle again, from its start and from a snapshot.
fn replay(build: &Examples) -> Result<(), String> {
    let replay = find(build, "replay")?;
    program(replay, &[RECORDING])?;
    program(replay, &[&[RECORDING], &FROM[..]].concat())
}

fn find<'a>(
    examples: &'a BTreeMap<String, Utf8PathBuf>,
    name: &str,
) -> Result<&'a Utf8Path, String> {
    let binary = examples.get(name);
    Ok(binary.ok_or_else(|| format!("cargo built no example {name}"))?)
}

/// Films a battle with all overlays, and checks that the files exist and the hash is the same. It is skipped, with a
/// line in the summary, unless `CLAMBER_REQUIRE_GPU` is set.
fn film(battle: &Utf8Path, hash: &str) -> Result<(), String> {
    if std::env::var_os("CLAMBER_REQUIRE_GPU").is_none() {
        let line = "SKIPPED film of a battle: no Vulkan, install mesa-vulkan-drivers";
        println!("   {line}");
        note_skipped(line);
        return Ok(());
    }
    refuses(battle, &["--frames", "Cargo.toml/none"], "Cargo.toml/none")?;
    if Utf8Path::new(FRAMES).exists() {
        std::fs::remove_dir_all(FRAMES).map_err(|error| format!("{FRAMES}: {error}"))?;
    }
    let filmed = fight(battle, &FILM)?;
    if filmed != hash {
        return Err(format!(
            "the battle's hash is {hash}, and {filmed} when it is filmed"
        ));
    }
    let files = std::fs::read_dir(FRAMES).map_err(|error| format!("{FRAMES}: {error}"))?;
    let (mut stills, mut moving) = (0, 0);
    for file in files.filter_map(Result::ok) {
        match file.path().extension().and_then(|end| end.to_str()) {
            Some("png") => stills += 1,
            Some("gif") => moving += 1,
            _ => {}
        }
    }
    match (stills, moving) {
        // The film has a picture at both ends of the second.
        (5, 1) => Ok(()),
        _ => Err(format!(
            "a second of film is {stills} pictures and {moving} GIFs in {FRAMES}, not 5 and 1"
        )),
    }
}

/// Runs a battle of some seconds with further options; returns its hash.
fn fight(battle: &Utf8Path, more: &[&str]) -> Result<String, String> {
    program(battle, &[&FIGHT, more].concat())?;
    let path = "target/xtask-battle/summary.json";
    let text = std::fs::read_to_string(path).map_err(|e| format!("{path}: {e}"))?;
    let summary: serde_json::Value =
        serde_json::from_str(&text).map_err(|e| format!("{path}: {e}"))?;
    let hash = summary["hash"].as_str();
    Ok(hash
        .ok_or_else(|| format!("{path} has no hash"))?
        .to_owned())
}
