use thiserror::Error;

use crate::mesh::{MeshError, MeshId, PaletteError, PartId, TriangleId, VertexId};

/// The reason why a surface rejects a palette, a point or an edit. The call changed nothing.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SurfaceError {
    /// The palette does not fit the mesh.
    #[error(transparent)]
    Palette(#[from] PaletteError),
    /// `world_from_model` is not finite, its scale is not positive, or its rotation is not of unit length.
    #[error(
        "world_from_model must be finite, with a positive scale and a rotation of length 1 \
         (to 1e-5)"
    )]
    WorldFromModel,
    /// The length of a tick is not positive and finite.
    #[error("the length of a tick must be positive and finite, found {0}")]
    Tick(f64),
    /// The tick is so short that velocities do not fit in f32.
    #[error("the length of a tick must be long enough for velocities that fit in f32, found {0}")]
    ShortTick(f64),
    /// A hit or anchor belongs to another mesh.
    #[error("the point lies on mesh {found}, not on {expected}")]
    ForeignMesh {
        /// The surface's mesh.
        expected: MeshId,
        /// The point's mesh.
        found: MeshId,
    },
    /// The triangle does not exist, or was removed.
    #[error("triangle {0} does not exist, or was removed")]
    Triangle(TriangleId),
    /// The vertex does not exist, or was removed.
    #[error("vertex {0} does not exist, or was removed")]
    Vertex(VertexId),
    /// The part does not exist.
    #[error("part {0} does not exist")]
    Part(PartId),
    /// Barycentric coordinates are not finite, are negative, or do not add up to 1.
    #[error("barycentric coordinates must be finite, not negative, and add up to 1, found {0:?}")]
    Barycentric([f32; 3]),
    /// A vertex or a triangle could not be added.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}
