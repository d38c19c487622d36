use std::io;
use std::path::PathBuf;

use clamber_surface::mesh::MeshError;
use clamber_surface::rig::RigError;
use thiserror::Error;

/// Why a file could not be loaded.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum GltfError {
    /// The file, or one it names, cannot be read.
    #[error("cannot read {path}: {source}")]
    Read {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Not glTF 2.0: no JSON, a broken container, or an index that points nowhere.
    #[error("not a valid glTF 2.0 file: {0}")]
    Format(#[from] gltf::Error),
    /// An object of the file breaks the specification.
    #[error("{object}: {reason}")]
    Invalid {
        /// Which object, by kind and index or name.
        object: String,
        /// What is wrong with it.
        reason: String,
    },
    /// The file has no such skin.
    #[error("skin {wanted} was asked for, but the file has {found} skins")]
    NoSuchSkin {
        /// Index asked for.
        wanted: usize,
        /// How many there are.
        found: usize,
    },
    /// No triangles are attached to the skin.
    #[error("no mesh with triangles is attached to skin {skin}")]
    NoSkinnedMesh {
        /// Index of the skin.
        skin: usize,
    },
    /// The joints do not make a skeleton.
    #[error("the joints of skin {skin} make no skeleton: {source}")]
    Skeleton {
        /// Index of the skin.
        skin: usize,
        /// Why.
        source: RigError,
    },
    /// The primitives do not make a collider mesh.
    #[error("the primitives of skin {skin} make no collider: {source}")]
    Collider {
        /// Index of the skin.
        skin: usize,
        /// Why.
        source: MeshError,
    },
}

impl GltfError {
    pub(crate) fn invalid(object: impl Into<String>, reason: impl ToString) -> Self {
        Self::Invalid {
            object: object.into(),
            reason: reason.to_string(),
        }
    }
}
