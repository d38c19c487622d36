use rapier3d::dynamics::RigidBodyHandle;
use thiserror::Error;

use crate::ObstacleId;

/// Why a body cannot be debris, or a tick cannot be taken.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum DebrisError {
    /// No such body in the set, or one that no force moves.
    #[error("body {0:?} does not exist, or is not dynamic")]
    NotDynamic(RigidBodyHandle),
    /// The body has no collider with an inside: none at all, or sensors, meshes and the like only.
    #[error("body {0:?} has no solid collider")]
    NotSolid(RigidBodyHandle),
    /// A tick must have a length.
    #[error("a tick must be longer than 0 s and finite, found {0} s")]
    Tick(f64),
    /// Two surfaces have the same id.
    #[error("obstacle {} is twice in the list of surfaces", .0.0)]
    TwiceListed(ObstacleId),
    /// A body is not finite, or farther from a surface than f32 reaches.
    #[error("body {body:?} is not finite, or out of reach of obstacle {}", .obstacle.0)]
    OutOfReach {
        /// Which body.
        body: RigidBodyHandle,
        /// Which surface.
        obstacle: ObstacleId,
    },
}
