//! The project's own giant, `assets/colossus.glb`, with any number of vertices.

use std::path::PathBuf;
use std::sync::Arc;

use clamber_gltf::Model;

use crate::resample::resample;
use crate::{Creature, SceneError};

/// Speed of the giant's walk, metres a second. `assets/giant/clips.py` sets it.
const WALK_SPEED: f64 = 5.0;

/// Path of the giant's file.
pub fn path() -> PathBuf {
    PathBuf::from(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../assets/colossus.glb"
    ))
}

/// Path of the giant's brain.
pub fn brain_path() -> PathBuf {
    path().with_extension("brain.json")
}

/// The giant, with the collider that its file has.
pub fn giant() -> Result<Creature, SceneError> {
    Ok(Creature {
        walk_speed: Some(WALK_SPEED),
        ..Creature::new("giant", model()?.rig)
    })
}

/// The whole content of the giant's file, visual meshes included.
pub fn model() -> Result<Model, SceneError> {
    Ok(clamber_gltf::load(path())?)
}

/// The giant with about so many vertices: its collider, closed as it is, with the longest edges halved or
/// the shortest ones collapsed. See [`resample`].
pub fn giant_of(vertices: usize) -> Result<Creature, SceneError> {
    let mut giant = giant()?;
    giant.rig.collider = Arc::new(resample(&giant.rig.collider, vertices)?);
    Ok(giant)
}
