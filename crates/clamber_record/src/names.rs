//! Names of obstacles and of their parts, for the log.

use clamber_climber::ClimberState;
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::rig::JointId;
use clamber_world::ObstacleId;

/// Names of obstacles, by id.
pub(crate) type ObstacleNames = Vec<(ObstacleId, String)>;

/// An obstacle, and the joint of its skin that a climber is on at the end of a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Part {
    obstacle: ObstacleId,
    joint: JointId,
}

impl Part {
    /// The part that a climber is on; `None` without a support, or if the support's key names no triangle of `mesh`.
    /// The support may be on another obstacle: see [`Part::is_on`].
    pub(crate) fn of(state: &ClimberState, mesh: &ColliderMesh) -> Option<Self> {
        let at = state.support?.attachment;
        let triangle = u32::try_from(at.material.key).ok()?;
        Some(Self {
            obstacle: at.obstacle,
            joint: mesh.joint_of(TriangleId(triangle))?,
        })
    }

    pub(crate) fn is_on(&self, obstacle: ObstacleId) -> bool {
        self.obstacle == obstacle
    }

    /// A name for the log, such as `giant (nape)`. `joint` gives the name of a joint.
    pub(crate) fn name<'a>(
        &self,
        creature: &str,
        joint: impl FnOnce(JointId) -> Option<&'a str>,
    ) -> String {
        match joint(self.joint).filter(|name| !name.is_empty()) {
            Some(joint) => format!("{creature} ({joint})"),
            None => creature.to_owned(),
        }
    }
}

/// The name of an obstacle, or its number if it has no name.
pub(crate) fn name_of(names: &[(ObstacleId, String)], obstacle: ObstacleId) -> String {
    let named = names.iter().find(|(id, _)| *id == obstacle);
    named.map_or_else(
        || format!("obstacle {}", obstacle.0),
        |(_, name)| name.clone(),
    )
}
