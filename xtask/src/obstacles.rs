//! Terrain and bodies of other engines, in Bevy: one scene in avian and in rapier, held against each other.

use cargo_metadata::Metadata;

use crate::run::{IGNORE_RUST_VERSION, cargo};

pub(crate) fn check(_: &Metadata) -> Result<(), String> {
    let engines = ["--features", "avian,rapier", IGNORE_RUST_VERSION];
    for what in [&["--test", "obstacles"][..], &["--doc"]] {
        let test = ["test", "--quiet", "-p", "bevy_clamber"];
        cargo(&[&test[..], what, &engines].concat())?;
    }
    Ok(())
}
