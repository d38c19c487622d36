//! Every example once, briefly, as built for tests; the main one also filmed, and with options that it has to refuse.
//! As released and recorded, with equal results, it is a golden run.

use std::collections::BTreeMap;
use std::path::PathBuf;

use cargo_metadata::Metadata;
use cargo_metadata::camino::{Utf8Path, Utf8PathBuf};

use crate::build;
use crate::run::{note_skipped, program, refuses};

/// What an example cannot do without.
const ARGUMENTS: [(&str, &[&str]); 3] = [
    (
        "rides",
        &[
            "assets/colossus.glb",
            "--seconds",
            "10",
            "--out",
            "target/rides-brief",
        ],
    ),
    ("seeds", &["target/fuzz-seeds"]),
    ("soak", &["--minutes", "0.2", "--out", "target/soak-brief"]),
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

/// A vertex that falls through a face, in the form of the query files.
const QUERY: &str = "\
    1,4,1,1,1,4,1\n0,1,0,1,0,1,1\n1,1,0,1,0,1,1\n0,1,0,1,1,1,1\n\
    1,4,-1,1,1,4,1\n0,1,0,1,0,1,1\n1,1,0,1,0,1,1\n0,1,0,1,1,1,1\n";

pub(crate) fn run(metadata: &Metadata) -> Result<(), String> {
    let queries = query_files(metadata)?;
    let examples = build::examples(&build::selection())?;
    for (name, binary) in &examples {
        if ["battle", "replay"].contains(&name.as_str()) {
            continue;
        }
        let needed = ARGUMENTS.iter().find(|(needing, _)| needing == name);
        let arguments = needed.map_or(&[][..], |(_, arguments)| *arguments);
        let files = queries.iter().map(String::as_str);
        let files: Vec<&str> = files.filter(|_| name == "ccd_queries").collect();
        program(binary, &[arguments, &files].concat())?;
    }
    let battle = find(&examples, "battle")?;
    for (arguments, reason) in REFUSED {
        refuses(battle, arguments, reason)?;
    }
    let hash = battle_hash(metadata, battle, &[])?;
    film(metadata, battle, &hash)
}

/// The battle as released has the hash that it has as built for tests, recorded or not; what is recorded can be fought
/// again.
pub(crate) fn compare_builds(metadata: &Metadata) -> Result<(), String> {
    let tested = build::examples(&build::selection())?;
    let released = build::examples(&[&build::RELEASED[..], &["--example", "battle"]].concat())?;
    let fast = battle_hash(metadata, find(&released, "battle")?, &[])?;
    let plain = battle_hash(metadata, find(&tested, "battle")?, &[])?;
    if plain != fast {
        return Err(format!(
            "the battle's hash is {fast} in release, and {plain} as built for tests"
        ));
    }
    println!("   battle: hash {fast} in both profiles");
    let recording = record(metadata, &tested, &fast)?;
    replay(&tested, &recording)?;
    let folder = metadata.target_directory.join("xtask-climb");
    program(find(&released, "battle")?, &["--out", folder.as_str()])
}

/// What one build records, the other fights again.
pub(crate) fn exchange_recordings(metadata: &Metadata) -> Result<(), String> {
    let tested = build::examples(&build::selection())?;
    let released = ["--release", "-p", "clamber", "--features", "clamber/record"];
    let named = ["--example", "battle", "--example", "replay"];
    let released = build::examples(&[&released[..], &named].concat())?;
    let hash = battle_hash(metadata, find(&released, "battle")?, &[])?;
    for [from, to] in [[&tested, &released], [&released, &tested]] {
        replay(to, &record(metadata, from, &hash)?)?;
    }
    Ok(())
}

/// Records a battle, which must have this hash; gives the file.
fn record(
    metadata: &Metadata,
    build: &BTreeMap<String, Utf8PathBuf>,
    hash: &str,
) -> Result<Utf8PathBuf, String> {
    let recording = metadata.target_directory.join("xtask-battle.mcap");
    let recorded = ["--record", recording.as_str()];
    let recorded = battle_hash(metadata, find(build, "battle")?, &recorded)?;
    if recorded == hash {
        Ok(recording)
    } else {
        Err(format!(
            "the battle's hash is {hash}, and {recorded} if it is recorded"
        ))
    }
}

/// Fights a recorded battle again, all of it and from a snapshot.
fn replay(build: &BTreeMap<String, Utf8PathBuf>, recording: &Utf8Path) -> Result<(), String> {
    let replay = find(build, "replay")?;
    program(replay, &[recording.as_str()])?;
    program(replay, &[recording.as_str(), "--from", "200"])
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
fn film(metadata: &Metadata, battle: &Utf8Path, hash: &str) -> Result<(), String> {
    if std::env::var_os("CLAMBER_REQUIRE_GPU").is_none() {
        let line = "SKIPPED film of a battle: no Vulkan, install mesa-vulkan-drivers";
        println!("   {line}");
        note_skipped(line);
        return Ok(());
    }
    refuses(battle, &["--frames", "Cargo.toml/none"], "Cargo.toml/none")?;
    let frames = metadata.target_directory.join("xtask-frames");
    let gif = frames.join("battle.gif");
    if frames.exists() {
        std::fs::remove_dir_all(&frames).map_err(|error| format!("{frames}: {error}"))?;
    }
    let overlays = "joints,capsules,spheres,clusters,contact,anchors,sweeps,rocks,state";
    let size = ["--width", "320", "--rows", "180", "--overlay", overlays];
    let when = ["--from", "11", "--rate", "4", "--camera", "chase"];
    let to = ["--frames", frames.as_str(), "--gif", gif.as_str()];
    let filmed = battle_hash(metadata, battle, &[&size[..], &when, &to].concat())?;
    if filmed != hash {
        return Err(format!(
            "the battle's hash is {hash}, and {filmed} when it is filmed"
        ));
    }
    let files = std::fs::read_dir(&frames).map_err(|error| format!("{frames}: {error}"))?;
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
            "a second of film is {stills} pictures and {moving} GIFs in {frames}, not 5 and 1"
        )),
    }
}

/// The query files of the test data, or where there is none a file of one query.
fn query_files(metadata: &Metadata) -> Result<Vec<String>, String> {
    let Some(data) = std::env::var_os("CLAMBER_TEST_DATA") else {
        let file = metadata.target_directory.join("xtask-vertex-face.csv");
        std::fs::write(&file, QUERY).map_err(|error| format!("{file}: {error}"))?;
        return Ok(vec![file.into_string()]);
    };
    let (mut files, mut folders) = (Vec::new(), vec![PathBuf::from(data).join("ccd")]);
    while let Some(folder) = folders.pop() {
        let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
        for entry in std::fs::read_dir(&folder).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "csv") {
                files.push(path.to_string_lossy().into_owned());
            }
        }
    }
    files.sort();
    Ok(files)
}

/// A battle of some seconds, with these options beside; gives its hash.
fn battle_hash(metadata: &Metadata, battle: &Utf8Path, more: &[&str]) -> Result<String, String> {
    let folder = metadata.target_directory.join("xtask-battle");
    let fight = ["--seconds", "12", "--out", folder.as_str()];
    program(battle, &[&fight, more].concat())?;
    let path = folder.join("summary.json");
    let text = std::fs::read_to_string(&path).map_err(|e| format!("{path}: {e}"))?;
    let summary: serde_json::Value =
        serde_json::from_str(&text).map_err(|e| format!("{path}: {e}"))?;
    let hash = summary["hash"].as_str();
    Ok(hash
        .ok_or_else(|| format!("{path} has no hash"))?
        .to_owned())
}
