use std::path::PathBuf;
use std::{fmt, io};

use clamber_surface::mesh::MeshError;
use clamber_surface::rig::RigError;
use thiserror::Error;

/// Which file could not be loaded, and why.
#[derive(Debug)]
pub struct GltfError {
    /// The document; `None` if it came as bytes.
    pub path: Option<PathBuf>,
    /// Which of its objects is wrong, and in what way.
    pub kind: GltfErrorKind,
}

impl fmt::Display for GltfError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.path, &self.kind) {
            // Names the file itself.
            (_, GltfErrorKind::Read { .. }) | (None, _) => write!(f, "{}", self.kind),
            (Some(path), kind) => write!(f, "{}: {kind}", path.display()),
        }
    }
}

impl std::error::Error for GltfError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.kind.source()
    }
}

/// Why a file could not be loaded.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum GltfErrorKind {
    /// The file, or one it names, cannot be read.
    #[error("cannot read {path}: {source}")]
    Read {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A symbolic link leads out of the document's folder.
    #[error("{object}: its file {file} is a link out of the document's folder, to {target}")]
    OutsideFolder {
        /// Which object names the file, by kind and index.
        object: String,
        /// The file in the document's folder.
        file: PathBuf,
        /// Where it really is.
        target: PathBuf,
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
    /// There is nothing to touch.
    #[error("no mesh with triangles for collision in {object}")]
    NoTriangles {
        /// Which skins, or the file.
        object: String,
    },
    /// The joints do not make a skeleton.
    #[error("the joints of {object} make no skeleton: {source}")]
    Skeleton {
        /// Which skins, or the file.
        object: String,
        /// Why.
        source: RigError,
    },
    /// The primitives do not make a collider mesh.
    #[error("the meshes of {object} make no collider: {source}")]
    Collider {
        /// Which skins, or the file.
        object: String,
        /// Why.
        source: MeshError,
    },
}

impl GltfErrorKind {
    pub(crate) fn invalid(object: impl Into<String>, reason: impl ToString) -> Self {
        Self::Invalid {
            object: object.into(),
            reason: reason.to_string(),
        }
    }
}
