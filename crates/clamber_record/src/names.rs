//! Names of obstacles and of their parts, for the log.

use std::collections::BTreeMap;

use clamber_world::ObstacleId;

/// Names of obstacles, by id.
pub(crate) type ObstacleNames = BTreeMap<ObstacleId, String>;

/// A name for the log of the part of a creature that a joint moves, such as `giant (nape)`.
pub(crate) fn part_name(creature: &str, joint: Option<&str>) -> String {
    match joint {
        Some(joint) => format!("{creature} ({joint})"),
        None => creature.to_owned(),
    }
}

/// The name of an obstacle, or its number if it has no name.
pub(crate) fn name_of(names: &ObstacleNames, obstacle: ObstacleId) -> String {
    let name = names.get(&obstacle).cloned();
    name.unwrap_or_else(|| format!("obstacle {}", obstacle.0))
}
