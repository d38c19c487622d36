use std::path::PathBuf;
use std::{fmt, io};

use clamber_surface::mesh::MeshError;
use clamber_surface::rig::RigError;
use thiserror::Error;

/// An error from loading a file: which file, and why.
///
/// The message includes the causes. So [`source`](std::error::Error::source) is always `None`, and a printed chain of
/// errors does not repeat them. The causes themselves are fields of [`GltfErrorKind`].
#[derive(Debug)]
#[non_exhaustive]
pub struct GltfError {
    /// Path of the document; `None` if it was loaded from bytes.
    pub path: Option<PathBuf>,
    /// The fault, and the object of the file that has it.
    pub kind: GltfErrorKind,
}

impl fmt::Display for GltfError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.path, &self.kind) {
            // The message of `Read` names the file already.
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
    /// The document, or a file that it names, cannot be read.
    #[error("cannot read {path}: {error}")]
    Read {
        /// Path of the file, or the path that the resolver was called with.
        path: PathBuf,
        /// The error of the system or of the resolver.
        error: io::Error,
    },
    /// A symbolic link leads out of the document's folder.
    #[error("{object}: its file {file} is a link to {target}, outside the document's folder")]
    OutsideFolder {
        /// The object that names the file, by kind and index.
        object: String,
        /// Path of the file in the document's folder.
        file: PathBuf,
        /// Path of the file that the link leads to.
        target: PathBuf,
    },
    /// The file has no bytes.
    #[error("the file is empty")]
    Empty,
    /// The file is neither GLB nor JSON, by its first bytes.
    #[error("neither GLB nor glTF")]
    NotGltf,
    /// A GLB is shorter than its header claims.
    #[error("ends after {found} of {claimed} bytes")]
    CutShort {
        /// Size of the file, bytes.
        found: usize,
        /// Size that the header claims, bytes; 12, the size of the header, if the header itself is cut.
        claimed: usize,
    },
    /// Not a glTF 2.0 file that can be read: broken JSON, a broken container, an index out of range, or a required
    /// extension that is not supported.
    #[error("not a valid glTF 2.0 file: {reason}")]
    Format {
        /// Description of the fault.
        reason: String,
    },
    /// An object of the file violates the specification, or a limit of this importer.
    #[error("{object}: {reason}")]
    Invalid {
        /// The object, by kind and index or name.
        object: String,
        /// Description of the object's fault.
        reason: String,
    },
    /// The file has no such skin.
    #[error("skin {wanted} was asked for, but the file has {found} skins")]
    NoSuchSkin {
        /// The index in [`LoadOptions::skin`](crate::LoadOptions::skin).
        wanted: usize,
        /// Number of skins in the file.
        found: usize,
    },
    /// The file has no such scene.
    #[error("scene {wanted} was asked for, but the file has {found} scenes")]
    NoSuchScene {
        /// The index in [`LoadOptions::scene`](crate::LoadOptions::scene).
        wanted: usize,
        /// Number of scenes in the file.
        found: usize,
    },
    /// The loaded scene shows no mesh, although the file has some.
    #[error("scene {scene} shows no mesh{}", other_scene(*other))]
    EmptyScene {
        /// Index of the scene: the one in the options, else the file's default scene, else the first.
        scene: usize,
        /// Index of the first scene that shows a mesh; `None` if no scene shows one.
        other: Option<usize>,
    },
    /// Meshes that are shown many times make more vertices than the options allow.
    #[error(
        "{object}: meshes that are shown more than once make over {limit} vertices, or twice as many triangles: \
         raise LoadOptions::max_repeated_vertices if that is meant"
    )]
    TooManyRepeats {
        /// The object that is shown too often, by kind and index.
        object: String,
        /// [`LoadOptions::max_repeated_vertices`](crate::LoadOptions::max_repeated_vertices).
        limit: usize,
    },
    /// The creature or the file has no triangles for collision.
    #[error("no mesh with triangles for collision in {object}")]
    NoTriangles {
        /// The creature, by its skins, or the file.
        object: String,
    },
    /// The joints do not form a valid skeleton.
    #[error("the joints of {object} make no skeleton: {error}")]
    Skeleton {
        /// The creature, by its skins, or the file.
        object: String,
        /// The fault of the joints.
        error: RigError,
    },
    /// The collision meshes do not form a valid collider mesh.
    #[error("the meshes of {object} make no collider: {error}")]
    Collider {
        /// The creature, by its skins, or the file.
        object: String,
        /// The fault of the meshes.
        error: MeshError,
    },
    /// The height in the options is not finite, or not greater than 0.
    #[error("cannot scale to a height of {wanted} m: it must be finite and greater than 0")]
    BadHeight {
        /// The height in the options, metres.
        wanted: f32,
    },
    /// The creature cannot be scaled to a height, since its collider has no height in the rest pose.
    #[error("cannot scale {object} to a height: in the rest pose its collider is {found} m tall")]
    NoHeight {
        /// The creature, by its skins, or the file.
        object: String,
        /// Height of the collider in the rest pose: 0, or not finite.
        found: f64,
    },
}

/// The end of the message about a scene without a mesh: which other scene shows one.
fn other_scene(other: Option<usize>) -> String {
    other.map_or_else(
        || ", and no other scene does: the file's meshes are in none".into(),
        |other| format!(", but scene {other} does: choose it with LoadOptions::with_scene"),
    )
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
