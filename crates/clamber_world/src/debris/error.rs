use rapier3d::dynamics::RigidBodyHandle;
use thiserror::Error;

use crate::ObstacleId;

/// An error of [`Debris`](crate::Debris): a body cannot be debris, or a tick cannot be run.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum DebrisError {
    /// The body does not exist, or is not dynamic.
    #[error("body {0:?} does not exist, or is not dynamic")]
    NotDynamic(RigidBodyHandle),
    /// The body has no solid collider: it has no collider, or only sensors and shapes without an inside, such as
    /// meshes.
    #[error("body {0:?} has no solid collider")]
    NotSolid(RigidBodyHandle),
    /// The length of a tick is not positive and finite.
    #[error("a tick must be longer than 0 s and finite, found {0} s")]
    Tick(f64),
    /// Two surfaces have the same id.
    #[error("obstacle {} is twice in the list of surfaces", .0.0)]
    TwiceListed(ObstacleId),
    /// The pose of a body is not finite, or farther from a surface than f32 can represent.
    #[error("body {body:?} is not finite, or out of reach of obstacle {}", .obstacle.0)]
    OutOfReach {
        /// The body.
        body: RigidBodyHandle,
        /// The surface's id.
        obstacle: ObstacleId,
    },
}
