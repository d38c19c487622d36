//! The collider mesh: the rest data that is skinned and queried.
//!
//! [`ColliderMesh::build`] makes an immutable mesh from plain slices. Surfaces share the mesh by `Arc`.

mod adjacency;
mod build;
pub(crate) mod clusters;
mod collider;
mod derived;
mod edit;
mod error;
pub(crate) mod hierarchy;
mod influences;
mod joint_balls;
mod lineage;
mod parts;
mod rig;
mod summary;
mod tag;
mod tags;
mod weights;

pub use build::{BuildReport, ColliderBuildOptions, CrackPolicy, MeshSource, Winding};
pub(crate) use collider::check_matrices;
pub use collider::{ColliderMesh, IslandId, PartId, TriangleId, VertexId};
pub(crate) use edit::Reclustered;
pub use error::{MeshError, PaletteError};
pub(crate) use joint_balls::{JointBall, JointBalls};
pub use lineage::MeshId;
pub use parts::Part;
pub use rig::Rig;
#[cfg(test)]
pub(crate) use summary::Summarizer;
pub use tag::{SurfaceKind, SurfaceTag};
pub use tags::SurfaceTags;
pub use weights::{Influence, normalize_influences};
