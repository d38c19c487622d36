//! Checks the main example as built for tests: it records a battle, fights it again and films it with equal
//! results. As released, with equal results, the battle is a golden run.

use cargo_metadata::Metadata;
use cargo_metadata::camino::Utf8Path;

use crate::examples::{Examples, build};
use crate::process::{note_skipped, refuses, run};
use crate::workspace::{files, read};

/// Options of the battle whose hash is compared.
const FIGHT: &str = "--seconds 12 --out target/xtask-battle";

/// Options that record the battle.
const RECORD: &str = "--record target/xtask-battle.mcap";

/// Recording that `replay` fights again, from its start.
const REPLAY: &str = "target/xtask-battle.mcap";

/// The same from a snapshot.
const REPLAY_FROM: &str = "target/xtask-battle.mcap --from 200";

/// Folder of the film's pictures.
const FRAMES: &str = "target/xtask-frames";

/// Options that film a second of the battle, 4 pictures a second, with all overlays.
const FILM: &str = "--width 320 --rows 180 \
    --overlay joints,contact,anchors,plan,ways,state --from 11 --rate 4 --camera chase \
    --frames target/xtask-frames --gif target/xtask-frames/battle.gif";

/// The options that these checks pass to the examples `battle` and `replay`.
pub(crate) fn given(name: &str) -> Vec<&'static str> {
    match name {
        "battle" => vec![FIGHT, RECORD, FILM],
        "replay" => vec![REPLAY, REPLAY_FROM],
        _ => Vec::new(),
    }
}

/// Checks all of this with the examples as built for tests.
pub(crate) fn check(examples: &Examples) -> Result<(), String> {
    let hash = fight(examples, "")?;
    record_and_replay(examples, examples, &hash)?;
    film(examples, &hash)
}

/// Checks that the battle has the same hash as released and as built for tests.
pub(crate) fn compare_builds(metadata: &Metadata) -> Result<(), String> {
    let tested = build(metadata, "{all} --example battle")?;
    let released = build(metadata, "{released} --example battle")?;
    let hash = fight(&released, "")?;
    equal(&hash, &fight(&tested, "")?, "as built for tests")?;
    println!("   battle: hash {hash} in both profiles");
    run(find(&released, "battle")?, "--out target/xtask-climb").map(drop)
}

/// Checks that a release build fights the recording of a development build again, and the other way round. Both are
/// without `deterministic`, as most users build it.
pub(crate) fn exchange_recordings(metadata: &Metadata) -> Result<(), String> {
    let examples = "-p clamber --features clamber/record --example battle --example replay";
    let plain = build(metadata, examples)?;
    let released = build(metadata, &format!("--release {examples}"))?;
    let hash = fight(&released, "")?;
    record_and_replay(&plain, &released, &hash)?;
    record_and_replay(&released, &plain, &hash)
}

/// Records a battle with one build, checks its hash, and fights it again with another build.
fn record_and_replay(from: &Examples, to: &Examples, hash: &str) -> Result<(), String> {
    equal(hash, &fight(from, RECORD)?, "if it is recorded")?;
    run(find(to, "replay")?, REPLAY)?;
    run(find(to, "replay")?, REPLAY_FROM).map(drop)
}

/// Films a battle with all overlays, and checks that the files exist and the hash is the same. It is skipped, with a
/// line in the summary, unless `CLAMBER_REQUIRE_GPU` is set.
fn film(examples: &Examples, hash: &str) -> Result<(), String> {
    if std::env::var_os("CLAMBER_REQUIRE_GPU").is_none() {
        note_skipped("SKIPPED film of a battle: no Vulkan, install mesa-vulkan-drivers");
        return Ok(());
    }
    refuses(
        find(examples, "battle")?,
        "--frames Cargo.toml/none",
        "Cargo.toml/none",
    )?;
    let folder = Utf8Path::new(FRAMES);
    if folder.exists() {
        std::fs::remove_dir_all(folder).map_err(|error| format!("{FRAMES}: {error}"))?;
    }
    equal(hash, &fight(examples, FILM)?, "when it is filmed")?;
    let files = files(folder)?;
    let count = |end| {
        files
            .iter()
            .filter(|file| file.extension() == Some(end))
            .count()
    };
    match (count("png"), count("gif")) {
        // The film has a picture at both ends of the second.
        (5, 1) => Ok(()),
        found => Err(format!(
            "{FRAMES} has {found:?} pictures and GIFs of a second, not (5, 1)"
        )),
    }
}

/// Runs a battle of some seconds with further options; returns its hash.
fn fight(examples: &Examples, more: &str) -> Result<String, String> {
    run(find(examples, "battle")?, &format!("{FIGHT} {more}"))?;
    let path = "target/xtask-battle/summary.json";
    let summary = serde_json::from_str(&read(path.into())?);
    let summary: serde_json::Value = summary.map_err(|error| format!("{path}: {error}"))?;
    let hash = summary["hash"].as_str().map(str::to_owned);
    hash.ok_or(format!("{path} has no hash"))
}

fn equal(hash: &str, other: &str, how: &str) -> Result<(), String> {
    let differs = || format!("the battle's hash is {hash}, and {other} {how}");
    (hash == other).then_some(()).ok_or_else(differs)
}

fn find<'a>(examples: &'a Examples, name: &str) -> Result<&'a str, String> {
    let binary = examples.get(name).map(String::as_str);
    binary.ok_or(format!("cargo built no example {name}"))
}
