use bevy_mesh::{PrimitiveTopology, VertexFormat};
use clamber_surface::mesh::MeshError;
use thiserror::Error;

/// Why no collider can be built from a skinned mesh.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ColliderError {
    /// The mesh's data was moved to the render world.
    #[error(
        "the mesh was moved to the render world; load it with RenderAssetUsages::MAIN_WORLD as well"
    )]
    MovedToRenderWorld,
    /// A vertex attribute that skinning needs is missing.
    #[error("the mesh has no {0}")]
    Missing(&'static str),
    /// A vertex attribute has a format that is not supported.
    #[error("{attribute} are stored as {format:?}, which is not supported")]
    Format {
        /// The attribute.
        attribute: &'static str,
        /// Its format.
        format: VertexFormat,
    },
    /// Positions are compressed relative to bounds that the mesh does not have.
    #[error("positions are compressed, but the mesh has no `final_aabb` to decompress them")]
    NoBounds,
    /// The mesh is not a list or strip of triangles.
    #[error("the mesh is a {0:?}, which has no triangles")]
    Topology(PrimitiveTopology),
    /// Two vertex attributes have different lengths.
    #[error("{positions} positions, but {found} {attribute}")]
    Length {
        /// Number of positions.
        positions: usize,
        /// The other attribute.
        attribute: &'static str,
        /// Its length.
        found: usize,
    },
    /// `clamber_surface` refuses the mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// `SkinnedMesh` has more joints than inverse bind poses.
    #[error("{joints} joints, but {inverse_bindposes} inverse bind poses")]
    InverseBindposes {
        /// Number of joints of `SkinnedMesh`.
        joints: usize,
        /// Number of matrices in its asset.
        inverse_bindposes: usize,
    },
    /// A joint or one of its ancestors is gone or has no `Transform`, or the joint is its own ancestor.
    #[error("joint {joint} or one of its parents is gone, has no Transform, or forms a cycle")]
    Joint {
        /// Index of the joint in `SkinnedMesh`.
        joint: usize,
    },
    /// The joints are in several hierarchies, without a common root.
    #[error("joint {joint} is in another hierarchy than joint 0")]
    Hierarchies {
        /// Index of the first joint that is not in the hierarchy of joint 0.
        joint: usize,
    },
}

impl ColliderError {
    /// True for an error that may go away when entities get their transforms and parents.
    pub(crate) fn is_of_hierarchy(&self) -> bool {
        matches!(self, Self::Joint { .. } | Self::Hierarchies { .. })
    }

    /// True for an error that not all entities with the same mesh have.
    pub(crate) fn is_of_entity(&self) -> bool {
        self.is_of_hierarchy() || matches!(self, Self::InverseBindposes { .. })
    }
}
