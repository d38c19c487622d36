//! Loads the creature from its file and, if there is one, its brain's file.

use std::sync::Arc;

use clamber_colossus::{Brain, CreatureKind, CreatureParts};
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::rig::{Clip, Skeleton, WeakPoint};

use super::{ClimbabilityError, ClimbabilityOptions};

/// Tick length of the brain, seconds. No number of the report depends on it.
const TICK: f64 = 1.0 / 60.0;

/// The creature of the report.
pub(super) struct Creature {
    pub(super) skeleton: Skeleton,
    pub(super) mesh: Arc<ColliderMesh>,
    pub(super) clips: Vec<Clip>,
    pub(super) weak_points: Vec<WeakPoint>,
    /// The triangles of each plate.
    pub(super) plates: Vec<Vec<TriangleId>>,
    /// Height, metres, if the options or the brain give one.
    pub(super) height: Option<f64>,
    /// Height for which the clips were made, metres, if the options or the brain give one.
    pub(super) made_for: Option<f64>,
}

impl Creature {
    pub(super) fn load(options: &ClimbabilityOptions) -> Result<Self, ClimbabilityError> {
        let rig = clamber_gltf::load(&options.file)?;
        let Some(file) = &options.brain else {
            return Ok(Self {
                skeleton: rig.skeleton,
                mesh: rig.collider,
                clips: rig.clips,
                weak_points: rig.weak_points,
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
        // The kind may append a clip of its own: the breath, which it adds to other clips. The report leaves it out.
        let of_file = rig.clips.len();
        let parts = CreatureParts {
            skeleton: rig.skeleton,
            clips: rig.clips,
            mesh: rig.collider,
            materials: rig.collider_materials,
            weak_points: rig.weak_points,
        };
        let kind =
            CreatureKind::new(parts, brain).map_err(|error| ClimbabilityError::Colossus {
                file: file.clone(),
                error,
            })?;
        let body = &kind.brain().file().body;
        let plates = kind.plates().iter();
        Ok(Self {
            skeleton: kind.skeleton().clone(),
            mesh: Arc::clone(kind.mesh()),
            clips: kind.clips().clips().iter().take(of_file).cloned().collect(),
            weak_points: kind.weak_points().to_vec(),
            plates: plates.map(|plate| plate.triangles.clone()).collect(),
            height: options.height.or(body.height),
            made_for: options.made_for.or(body.made_for),
        })
    }
}
