use thiserror::Error;

use crate::mesh::{MeshError, MeshId, PaletteError, PartId, TriangleId, VertexId};

/// Why a surface refused a palette, a point or an edit. Nothing was changed.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SurfaceError {
    /// The palette does not fit the mesh.
    #[error(transparent)]
    Palette(#[from] PaletteError),
    /// `world_from_model` is not finite, has no positive scale, or its rotation is not of unit
    /// length.
    #[error(
        "world_from_model must be finite, with a positive scale and a rotation of length 1 \
         (to 1e-5)"
    )]
    WorldFromModel,
    /// A tick has no length.
    #[error("the length of a tick must be positive and finite, found {0}")]
    Tick(f64),
    /// Over so short a tick velocities are larger than any f32.
    #[error("the length of a tick must be long enough for velocities that fit in f32, found {0}")]
    ShortTick(f64),
    /// A hit or anchor belongs to another mesh.
    #[error("the point lies on mesh {found}, not on {expected}")]
    ForeignMesh {
        /// The surface's.
        expected: MeshId,
        /// The point's.
        found: MeshId,
    },
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
    Mesh(#[from] MeshError),
}
