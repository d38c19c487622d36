//! A brain's file: its states, what leads from one to another, and what can never happen.

use std::sync::Arc;

use clamber_colossus::{Brain, CreatureKind, CreatureParts};
use clamber_gltf::load;

use super::{InspectError, InspectOptions};

/// Prints a brain. Returns true if all of it can happen.
pub(super) fn print(options: &InspectOptions) -> Result<bool, InspectError> {
    let file = || options.file.clone();
    let text = std::fs::read_to_string(&options.file).map_err(|error| InspectError::Read {
        file: file(),
        error,
    })?;
    let brain = Brain::from_json(&text, 1.0 / f64::from(options.rate)).map_err(|error| {
        InspectError::Brain {
            file: file(),
            error,
        }
    })?;
    let report = match &options.creature {
        Some(creature) => {
            let rig = load(creature)?;
            let parts = CreatureParts {
                skeleton: rig.skeleton,
                clips: rig.clips,
                mesh: Arc::clone(&rig.collider),
                weak_points: rig.weak_points,
            };
            let kind = CreatureKind::new(parts, brain).map_err(|error| InspectError::Colossus {
                file: file(),
                error,
            })?;
            kind.report()
        }
        None => brain.report(),
    };
    print!("{report}");
    if options.creature.is_none() {
        println!(
            "joints, clips and markers were not looked for: name the creature's file by --creature"
        );
    }
    Ok(report.never.is_empty())
}
