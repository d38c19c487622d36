use bevy_mesh::{PrimitiveTopology, VertexFormat};
use clamber_surface::mesh::MeshError;
use thiserror::Error;

/// Why a mesh asset does not become a collider.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ColliderError {
    /// The mesh has given its data to the renderer.
    #[error(
        "the mesh was moved to the render world; load it with RenderAssetUsages::MAIN_WORLD as well"
    )]
    MovedToRenderWorld,
    /// A vertex attribute that skinning needs.
    #[error("the mesh has no {0}")]
    Missing(&'static str),
    /// A vertex attribute in a format that has no meaning for it.
    #[error("{attribute} are {format:?}, which is not understood")]
    Format {
        /// Which one.
        attribute: &'static str,
        /// How it is stored.
        format: VertexFormat,
    },
    /// Positions are compressed relative to bounds that the mesh does not have.
    #[error("positions are compressed, but the mesh has no `final_aabb` to undo it")]
    NoBounds,
    /// No list or strip of triangles.
    #[error("a {0:?} has no triangles")]
    Topology(PrimitiveTopology),
    /// Attributes of different lengths.
    #[error("{positions} positions, but {found} {attribute}")]
    Length {
        /// Vertices of the mesh.
        positions: usize,
        /// Which attribute.
        attribute: &'static str,
        /// Its length.
        found: usize,
    },
    /// The triangles do not make a collider.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// `SkinnedMesh` has more joints than inverse bind poses.
    #[error("{joints} joints, but {inverse_bindposes} inverse bind poses")]
    InverseBindposes {
        /// Joints of `SkinnedMesh`.
        joints: usize,
        /// Matrices of its asset.
        inverse_bindposes: usize,
    },
    /// A joint is gone, has no `Transform`, or hangs under itself.
    #[error("joint {joint} is gone, has no Transform, or its parents have none")]
    Joint {
        /// Which one.
        joint: usize,
    },
    /// The joints share no parent: they are in several hierarchies.
    #[error("joint {joint} hangs in another hierarchy than joint 0")]
    Hierarchies {
        /// The first one that does.
        joint: usize,
    },
}

impl ColliderError {
    /// It may go away as entities get their transforms and parents.
    pub(crate) fn is_of_hierarchy(&self) -> bool {
        matches!(self, Self::Joint { .. } | Self::Hierarchies { .. })
    }
}
