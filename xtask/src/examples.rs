//! Every example once, briefly, as built for tests; the main one also as released, with equal
//! results.

use cargo_metadata::{Metadata, TargetKind};

use crate::run::{cargo, cargo_output};

/// What an example cannot do without.
const ARGUMENTS: [(&str, &[&str]); 2] = [
    ("inspect", &["assets/colossus.glb", "--poses", "2"]),
    ("seeds", &["target/fuzz-seeds"]),
];

pub(crate) fn run(metadata: &Metadata) -> Result<(), String> {
    for package in metadata.workspace_packages() {
        for target in &package.targets {
            if target.kind.contains(&TargetKind::Example) && target.name != "battle" {
                let run = ["run", "--quiet", "-p", &package.name, "--example"];
                let needed = ARGUMENTS.iter().find(|(name, _)| *name == target.name);
                let arguments = needed.map_or(&[][..], |(_, arguments)| *arguments);
                cargo(&[&run[..], &[&target.name, "--"], arguments].concat())?;
            }
        }
    }
    let slow = battle_hash(metadata, &[])?;
    let fast = battle_hash(metadata, &["--release"])?;
    if slow != fast {
        return Err(format!(
            "the battle's hash is {slow} in the development profile, {fast} in release"
        ));
    }
    println!("   battle: hash {fast} in both profiles");
    Ok(())
}

/// A battle of some seconds; gives its hash.
fn battle_hash(metadata: &Metadata, profile: &[&str]) -> Result<String, String> {
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
    cargo_output(&[&["run", "--quiet"], profile, &fight].concat())?;
    let path = folder.join("summary.json");
    let text = std::fs::read_to_string(&path).map_err(|e| format!("{path}: {e}"))?;
    let summary: serde_json::Value =
        serde_json::from_str(&text).map_err(|e| format!("{path}: {e}"))?;
    let hash = summary["hash"].as_str();
    Ok(hash
        .ok_or_else(|| format!("{path} has no hash"))?
        .to_owned())
}
