//! A duel as a recording, and its replay.

use std::error::Error;
use std::path::Path;
use std::sync::Arc;

use clamber_climber::ClimberInput;
use clamber_colossus::CreatureKind;
use clamber_fight::Order;
use clamber_record::{
    ArenaInfo, ArenaRecorder, ArenaRecording, ArenaReplay, RecordOptions, SceneryView,
};
use clamber_surface::geometry::Similarity;
use clamber_world::{Obstacle, ObstacleId};
use glam::Vec3;

use super::{Duel, GROUND};

/// Names of the players.
const PLAYERS: [&str; 2] = ["rider", "archer"];

/// Half the length of the drawn ground's sides, metres.
const DRAWN: f32 = 100.0;

/// Steps a duel anew with the inputs and orders of all its ticks, and records it to a file. Gives the fingerprint of
/// the last tick.
///
/// A peer of a rollback session calls it at the end: only then all of its inputs are certain.
pub fn record(
    kind: &Arc<CreatureKind>,
    steps: impl IntoIterator<Item = (Vec<ClimberInput>, Vec<Order>)>,
    path: &Path,
) -> Result<u64, Box<dyn Error>> {
    let Duel { mut arena, ground } = Duel::new(kind)?;
    let mut info = ArenaInfo::of(&arena);
    info.creatures = vec!["giant".to_owned()];
    info.fighters = PLAYERS.map(str::to_owned).to_vec();
    info.settings = [("scene".to_owned(), "duel".to_owned())].into();
    let mut recorder = ArenaRecorder::create(path, &info, &arena, RecordOptions::waiting())?;
    recorder.name(GROUND, "ground");
    let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
    recorder.scenery(&SceneryView {
        name: "ground",
        world_from_own: Similarity::IDENTITY,
        points: &corners.map(|(x, z)| Vec3::new(x, 0.0, z) * DRAWN),
        triangles: &[[0, 1, 2], [0, 2, 3]],
        color: [0.45, 0.5, 0.35],
    })?;
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &ground)];
    for (inputs, orders) in steps {
        Duel::step(&mut arena, &ground, &inputs, &orders)?;
        recorder.tick(&arena, &inputs, &orders, &terrain)?;
    }
    recorder.finish()?;
    Ok(arena.fingerprint())
}

/// Fights a recorded duel again, from the last saved state at or before a tick, or from the first tick.
pub fn replay(
    recording: &ArenaRecording,
    from: Option<u64>,
) -> Result<ArenaReplay, Box<dyn Error>> {
    let scene = recording.info().settings.get("scene");
    if scene.is_none_or(|scene| scene != "duel") {
        return Err("this is a recording of another scene than a duel".into());
    }
    let Duel { mut arena, ground } = Duel::new(&Duel::kind()?)?;
    Ok(recording.replay(&mut arena, from, |arena, inputs, orders| {
        Duel::step(arena, &ground, inputs, orders)
    })?)
}
