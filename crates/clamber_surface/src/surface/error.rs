use thiserror::Error;

use crate::mesh::{PartId, TriangleId, VertexId};
use crate::rig::JointId;

/// Why a surface refused a palette, a query or an edit. Nothing was changed.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SurfaceError {
    /// The palette has another number of matrices than the mesh has joints.
    #[error("the mesh has {expected} joints, the palette {found} matrices")]
    JointCount {
        /// As the mesh has.
        expected: usize,
        /// As the palette has.
        found: usize,
    },
    /// A matrix is not finite, or could move a vertex, one to be added among them, farther than 2^100
    /// from the origin.
    #[error("matrix {0} of the palette is not finite, or moves vertices beyond 2^100")]
    Palette(JointId),
    /// `world_from_model` is not finite, has no positive scale, or its rotation is not of unit
    /// length.
    #[error(
        "world_from_model must be finite, with a positive scale and a rotation of length 1 \
         (to 1e-5)"
    )]
    WorldFromModel,
    /// A number of a query is NaN or negative, or a tick has no length.
    #[error("{what} must be {range}, found {found}")]
    Query {
        /// Which number.
        what: &'static str,
        /// What it may be.
        range: &'static str,
        /// Its value.
        found: f64,
    },
    /// The point of a query is not finite.
    #[error("the point of a query must be finite")]
    Point,
    /// No such triangle, or it was removed.
    #[error("triangle {0} does not exist, or was removed")]
    Triangle(TriangleId),
    /// No such vertex, or it was removed.
    #[error("vertex {0} does not exist, or was removed")]
    Vertex(VertexId),
    /// No such part.
    #[error("part {0} does not exist")]
    Part(PartId),
    /// Barycentric coordinates must be finite, not negative, and add up to 1.
    #[error("barycentric coordinates must not be negative and add up to 1, found {0:?}")]
    Barycentric([f32; 3]),
    /// A vertex or a triangle could not be added.
    #[error(transparent)]
    Mesh(#[from] crate::mesh::MeshError),
}
