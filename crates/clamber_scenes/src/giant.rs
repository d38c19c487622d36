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
    Ok(creature(&clamber_gltf::load(path())?))
}

/// The giant with so many vertices, or nearly: made from its collision mesh, or from what is to be
/// seen of it where more are asked for than that has.
///
/// # Errors
/// As [`giant`].
pub fn giant_of(vertices: usize) -> Result<Creature, CreatureError> {
    let rig = clamber_gltf::load(path())?;
    let (seen, _) = rig.visual_collider()?;
    let base = if seen.positions().len() <= vertices {
        &seen
    } else {
        &*rig.collider
    };
    Ok(Creature {
        name: format!("giant of {vertices} vertices"),
        collider: Arc::new(resample(base, vertices)?),
        ..creature(&rig)
    })
}

fn creature(rig: &Rig) -> Creature {
    let (skeleton, clips) = (rig.skeleton.clone(), rig.clips.clone());
    Creature {
        walk_speed: Some(WALK_SPEED),
        ..Creature::new("giant", skeleton, clips, rig.collider.clone())
    }
}
