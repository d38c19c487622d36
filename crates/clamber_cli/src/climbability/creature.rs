//! The creature, as its file and its brain make it.

use std::sync::Arc;

use clamber_colossus::{Brain, CreatureKind, CreatureParts};
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::rig::{Clip, Skeleton, WeakPoint};

use super::{ClimbabilityError, ClimbabilityOptions};

/// Length of the brain's ticks, seconds: no number of the report depends on it.
const TICK: f64 = 1.0 / 60.0;

/// What the report looks at.
pub(super) struct Creature {
    pub(super) skeleton: Skeleton,
    pub(super) mesh: Arc<ColliderMesh>,
    pub(super) clips: Vec<Clip>,
    pub(super) weak_points: Vec<WeakPoint>,
    /// The triangles of each plate.
    pub(super) plates: Vec<Vec<TriangleId>>,
    /// Metres, if the options or the brain say so.
    pub(super) height: Option<f64>,
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
        // What the kind adds to them is no clip of the file: breath, which it plays on top of others.
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
