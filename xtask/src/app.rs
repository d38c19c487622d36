//! `examples/bevy_app`, which is no part of the workspace.

use crate::run::{IGNORE_RUST_VERSION, cargo};

const MANIFEST: [&str; 2] = ["--manifest-path", "examples/bevy_app/Cargo.toml"];

/// Builds the app and lets it draw a picture, which it checks by itself.
pub(crate) fn check() -> Result<(), String> {
    cargo(&[&["fmt", "--check"][..], &MANIFEST].concat())?;
    // One picture does not pay for optimised dependencies.
    let fast = ["--config", "profile.dev.package.\"*\".opt-level=0"];
    let run = ["run", "--locked", IGNORE_RUST_VERSION];
    let draw = ["--", "--screenshot", "target/bevy_app.png"];
    std::fs::create_dir_all("target").map_err(|error| format!("target: {error}"))?;
    cargo(&[&run[..], &fast, &MANIFEST, &draw].concat())
}
