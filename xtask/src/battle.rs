//! The main example: recorded, fought again and filmed as built for tests, with equal results, and with options that it
//! has to refuse. As released, with equal results, it is a golden run.

use std::collections::BTreeMap;

use cargo_metadata::Metadata;
use cargo_metadata::camino::{Utf8Path, Utf8PathBuf};

use crate::build::{self, owned};
use crate::run::{note_skipped, program, refuses};
use crate::test_run::{Packages, Profile, Targets, TestRun};

/// The binaries of examples by name.
type Examples = BTreeMap<String, Utf8PathBuf>;

/// The battle whose hash is compared.
const FIGHT: [&str; 4] = ["--seconds", "12", "--out", "target/xtask-battle"];

/// Where it is recorded.
const RECORDING: &str = "target/xtask-battle.mcap";
const RECORD: [&str; 2] = ["--record", RECORDING];

/// The tick at which it is fought again.
const FROM: [&str; 2] = ["--from", "200"];

/// All that can be drawn over a battle.
const OVERLAYS: &str = "joints,capsules,spheres,clusters,contact,anchors,sweeps,rocks,state";

const FRAMES: &str = "target/xtask-frames";

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

/// Options that a battle refuses, and a part of the reason that it gives. Without it a machine that cannot draw would
/// seem to refuse them.
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

/// What it and the example `replay` are given here.
pub(crate) fn given(name: &str) -> Vec<&'static str> {
    match name {
        "battle" => [&FIGHT[..], &RECORD, &FILM].concat(),
        "replay" => FROM.to_vec(),
        _ => Vec::new(),
    }
}

/// Everything, as built for tests.
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

/// The battle as released has the hash that it has as built for tests.
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

/// Without `deterministic`, as most users have it: what one build records, the other fights again.
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

/// Records a battle, which must have this hash.
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

/// Fights the recorded battle again, all of it and from a snapshot.
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

/// Films a battle with all that can be drawn over it: pictures are there, and the battle is the same. Without a
/// graphics device, says that it does not.
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
        // Both ends of the second are seen.
        (5, 1) => Ok(()),
        _ => Err(format!(
            "a second of film is {stills} pictures and {moving} GIFs in {FRAMES}, not 5 and 1"
        )),
    }
}

/// A battle of some seconds, with these options beside; gives its hash.
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
