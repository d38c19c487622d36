use std::path::PathBuf;

use thiserror::Error;

/// Why nothing is drawn.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RenderError {
    /// No GPU, and no software in its place.
    #[error(
        "no graphics adapter: install a driver with Vulkan, or Mesa's software Vulkan \
         (Debian, Ubuntu: apt-get install mesa-vulkan-drivers); {reason}"
    )]
    NoAdapter {
        /// What the graphics library says.
        reason: String,
    },
    /// The adapter cannot do what is needed.
    #[error("{adapter} cannot be used: {reason}")]
    Adapter {
        /// Its name.
        adapter: String,
        /// What the graphics library says.
        reason: String,
    },
    /// The device is gone: unplugged, reset, or its driver died. Make a new [`Gpu`](crate::Gpu).
    #[error("the graphics device was lost: {0}")]
    Lost(String),
    /// The device has no memory left.
    #[error("the graphics device is out of memory: draw smaller pictures, or fewer meshes")]
    OutOfMemory,
    /// The graphics library refused a command: a mistake in this crate, or limits of the device.
    #[error("the graphics device refused: {0}")]
    Refused(String),
    /// A mesh that cannot be drawn.
    #[error("mesh: {0}")]
    Mesh(String),
    /// A frame that cannot be drawn.
    #[error("frame: {0}")]
    Frame(String),
    /// A picture that cannot be written.
    #[error("cannot write {path}: {reason}")]
    Write {
        /// Where.
        path: PathBuf,
        /// Why.
        reason: String,
    },
}
