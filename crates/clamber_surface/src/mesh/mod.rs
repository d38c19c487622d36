//! The collider mesh: what is skinned and queried.
//!
//! [`ColliderMesh::build`] takes plain slices, as any importer or engine has them, and makes an
//! immutable mesh that surfaces share by `Arc`.

mod build;
pub(crate) mod clusters;
mod collider;
mod edit;
mod error;
pub(crate) mod hierarchy;
mod tag;
mod weights;

pub use build::{BuildOptions, BuildReport, Cracks, MeshSource, Winding};
pub use collider::{ColliderMesh, Part, PartId, TriangleId, VertexId};
pub(crate) use edit::Reclustered;
pub use error::MeshError;
pub use tag::{SurfaceKind, SurfaceTag};
pub use weights::{Influence, normalize_influences};
pub(crate) use weights::{WEIGHT_ONE, normalize};
