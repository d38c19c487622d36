//! Loads the creature from its file and, if there is one, its brain's file.

use clamber_colossus::{Brain, CreatureKind};
use clamber_surface::mesh::{Rig, TriangleId};

use super::{ClimbabilityError, ClimbabilityOptions};

/// Tick length of the brain, seconds. No number of the report depends on it.
const TICK: f64 = 1.0 / 60.0;

/// The creature of the report.
pub(super) struct Creature {
    pub(super) rig: Rig,
    /// The triangles of each plate.
    pub(super) plates: Vec<Vec<TriangleId>>,
    /// Height, metres, if the options or the brain give one.
    pub(super) height: Option<f64>,
    /// Height for which the clips were made, metres, if the options or the brain give one.
    pub(super) made_for: Option<f64>,
}

impl Creature {
    pub(super) fn load(options: &ClimbabilityOptions) -> Result<Self, ClimbabilityError> {
        let rig = clamber_gltf::load(&options.file)?.rig;
        let Some(file) = &options.brain else {
            return Ok(Self {
                rig,
                plates: Vec::new(),
                height: options.height,
                made_for: options.made_for,
            });
        };
        let text = std::fs::read_to_string(file).map_err(|error| ClimbabilityError::Read {
            file: file.clone(),
            error,
        })?;
        let brain = Brain::from_json(&text, TICK).map_err(|error| ClimbabilityError::Brain {
            file: file.clone(),
            error,
        })?;
        let kind = CreatureKind::new(&rig, brain).map_err(|error| ClimbabilityError::Colossus {
            file: file.clone(),
            error,
        })?;
        let body = &kind.brain().file().body;
        let plates = kind.plates().iter();
        Ok(Self {
            rig: kind.rig(),
            plates: plates.map(|plate| plate.triangles.clone()).collect(),
            height: options.height.or(body.height),
            made_for: options.made_for.or(body.made_for),
        })
    }
}
