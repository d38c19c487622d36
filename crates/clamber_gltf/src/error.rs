use std::path::PathBuf;
use std::{fmt, io};

use clamber_surface::mesh::MeshError;
use clamber_surface::rig::RigError;
use thiserror::Error;

/// Which file could not be loaded, and why.
///
/// Its text says all, causes included; [`source`](std::error::Error::source) is always `None`, so that a chain of
/// errors prints nothing twice. The causes themselves are fields of [`GltfErrorKind`].
#[derive(Debug)]
#[non_exhaustive]
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

impl std::error::Error for GltfError {}

/// Why a file could not be loaded.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum GltfErrorKind {
    /// The file, or one it names, cannot be read.
    #[error("cannot read {path}: {error}")]
    Read {
        /// Which file: a path, or what a resolver was asked for.
        path: PathBuf,
        /// Why.
        error: io::Error,
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
    /// The file has no bytes.
    #[error("the file is empty")]
    Empty,
    /// The file begins like neither of the two formats.
    #[error("neither GLB nor glTF")]
    NotGltf,
    /// A GLB ends early.
    #[error("ends after {found} of {claimed} bytes")]
    CutShort {
        /// Bytes that there are.
        found: usize,
        /// Bytes that the header claims; the header's own 12 where it is cut itself.
        claimed: usize,
    },
    /// Not glTF 2.0: broken JSON, a broken container, or an index that points nowhere.
    #[error("not a valid glTF 2.0 file: {reason}")]
    Format {
        /// Why.
        reason: String,
    },
    /// An object of the file breaks the specification.
    #[error("{object}: {reason}")]
    Invalid {
        /// Which object, by kind and index or name.
        object: String,
        /// Why.
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
    #[error("the joints of {object} make no skeleton: {error}")]
    Skeleton {
        /// Which skins, or the file.
        object: String,
        /// Why.
        error: RigError,
    },
    /// The primitives do not make a collider mesh.
    #[error("the meshes of {object} make no collider: {error}")]
    Collider {
        /// Which skins, or the file.
        object: String,
        /// Why.
        error: MeshError,
    },
    /// The height asked for is not finite, or not greater than 0.
    #[error("a height of {wanted} m was asked for, which no creature can have")]
    BadHeight {
        /// Metres asked for.
        wanted: f32,
    },
    /// A creature cannot be scaled to a height: its collider has none in the rest pose.
    #[error("the collider of {object} is {found} m tall, and cannot be scaled to a height")]
    NoHeight {
        /// Which skins, or the file.
        object: String,
        /// Its height in the rest pose: 0, or not finite.
        found: f64,
    },
}

impl GltfErrorKind {
    pub(crate) fn invalid(object: impl Into<String>, reason: impl ToString) -> Self {
        Self::Invalid {
            object: object.into(),
            reason: reason.to_string(),
        }
    }

    pub(crate) fn format(reason: impl ToString) -> Self {
        Self::Format {
            reason: reason.to_string(),
        }
    }
}
