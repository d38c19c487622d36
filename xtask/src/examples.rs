//! Every example once, briefly, as built for tests; the main one also as released and recorded, with equal
//! results, and what was recorded fought again.

use std::path::PathBuf;

use cargo_metadata::{Metadata, TargetKind};

use crate::run::{cargo, cargo_output};

/// What an example cannot do without.
const ARGUMENTS: [(&str, &[&str]); 2] = [
    ("inspect", &["assets/colossus.glb", "--poses", "2"]),
    ("seeds", &["target/fuzz-seeds"]),
];

/// A vertex that falls through a face, in the form of the query files.
const QUERY: &str = "\
    1,4,1,1,1,4,1\n0,1,0,1,0,1,1\n1,1,0,1,0,1,1\n0,1,0,1,1,1,1\n\
    1,4,-1,1,1,4,1\n0,1,0,1,0,1,1\n1,1,0,1,0,1,1\n0,1,0,1,1,1,1\n";

pub(crate) fn run(metadata: &Metadata) -> Result<(), String> {
    let queries = query_files(metadata)?;
    for package in metadata.workspace_packages() {
        for target in &package.targets {
            let apart = ["battle", "replay"].contains(&target.name.as_str());
            if target.kind.contains(&TargetKind::Example) && !apart {
                let run = ["run", "--quiet", "-p", &package.name, "--example"];
                let needed = ARGUMENTS.iter().find(|(name, _)| *name == target.name);
                let arguments = needed.map_or(&[][..], |(_, arguments)| *arguments);
                let files = queries.iter().map(String::as_str);
                let files: Vec<&str> = files.filter(|_| target.name == "ccd_queries").collect();
                cargo(&[&run[..], &[&target.name, "--"], arguments, &files].concat())?;
            }
        }
    }
    let slow = battle_hash(metadata, &[], &[])?;
    let fast = battle_hash(metadata, &["--release"], &[])?;
    if slow != fast {
        return Err(format!(
            "the battle's hash is {slow} in the development profile, {fast} in release"
        ));
    }
    println!("   battle: hash {fast} in both profiles");
    let recording = metadata.target_directory.join("xtask-battle.mcap");
    let recorded = battle_hash(
        metadata,
        &["--features", "record"],
        &["--record", recording.as_str()],
    )?;
    if recorded != fast {
        return Err(format!(
            "the battle's hash is {fast}, and {recorded} when it is recorded"
        ));
    }
    // Recorded in the development profile, fought again as released.
    let replay = ["run", "--quiet", "--release", "--features", "record"];
    let file = ["--example", "replay", "--", recording.as_str()];
    cargo(&[&replay[..], &file].concat())?;
    cargo(&[&replay[..], &file, &["--from", "200"]].concat())
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

/// A battle of some seconds, built so and with these options beside; gives its hash.
fn battle_hash(metadata: &Metadata, profile: &[&str], more: &[&str]) -> Result<String, String> {
    let folder = metadata.target_directory.join("xtask-battle");
    let fight = [
        "--example",
        "battle",
        "--",
        "--seconds",
        "5",
        "--out",
        folder.as_str(),
    ];
    cargo_output(&[&["run", "--quiet"], profile, &fight, more].concat())?;
    let path = folder.join("summary.json");
    let text = std::fs::read_to_string(&path).map_err(|e| format!("{path}: {e}"))?;
    let summary: serde_json::Value =
        serde_json::from_str(&text).map_err(|e| format!("{path}: {e}"))?;
    let hash = summary["hash"].as_str();
    Ok(hash
        .ok_or_else(|| format!("{path} has no hash"))?
        .to_owned())
}
