//! The project's own giant, `assets/colossus.glb`, at any number of vertices.

use std::path::PathBuf;
use std::sync::Arc;

use clamber_gltf::Rig;

use crate::resample::resample;
use crate::{Creature, CreatureError};

/// Metres a second that the giant's walk covers; `assets/giant/clips.py` makes it so.
const WALK_SPEED: f64 = 5.0;

/// Where the giant's file is.
pub fn path() -> PathBuf {
    PathBuf::from(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../assets/colossus.glb"
    ))
}

/// The giant as its file has it.
///
/// # Errors
/// [`CreatureError`] if its file is missing or broken.
pub fn giant() -> Result<Creature, CreatureError> {
    Ok(creature(&rig()?))
}

/// All of its file, with what is to be seen.
///
/// # Errors
/// As [`giant`].
pub fn rig() -> Result<Rig, CreatureError> {
    Ok(clamber_gltf::load(path())?)
}

/// The giant with so many vertices, or nearly: its collision mesh with longest edges halved or
/// shortest ones drawn together, closed as that is.
///
/// # Errors
/// As [`giant`].
pub fn giant_of(vertices: usize) -> Result<Creature, CreatureError> {
    let giant = giant()?;
    Ok(Creature {
        collider: Arc::new(resample(&giant.collider, vertices)?),
        ..giant
    })
}

fn creature(rig: &Rig) -> Creature {
    let (skeleton, clips) = (rig.skeleton.clone(), rig.clips.clone());
    Creature {
        walk_speed: Some(WALK_SPEED),
        ..Creature::new("giant", skeleton, clips, rig.collider.clone())
    }
}
