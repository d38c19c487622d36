use std::path::PathBuf;

use thiserror::Error;

/// An error from opening a device, drawing, or writing a picture.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RenderError {
    /// There is neither a GPU nor a software driver.
    #[error(
        "no graphics adapter: install a Vulkan driver, or Mesa's software Vulkan \
         (Debian, Ubuntu: apt-get install mesa-vulkan-drivers); {reason}"
    )]
    NoAdapter {
        /// Message of the graphics library.
        reason: String,
    },
    /// The adapter has no device with the required limits.
    #[error("{adapter} cannot be used: {reason}")]
    Adapter {
        /// Name of the adapter.
        adapter: String,
        /// Message of the graphics library.
        reason: String,
    },
    /// The device was lost: it was unplugged or reset, or its driver crashed. Make a new [`Gpu`](crate::Gpu).
    #[error("the graphics device was lost: {0}")]
    Lost(String),
    /// The device has no memory left.
    #[error("the graphics device is out of memory: draw smaller pictures, or fewer meshes")]
    OutOfMemory,
    /// The graphics library refused a command: a bug in this crate, or a limit of the device.
    #[error("the graphics library refused a command: {0}")]
    Refused(String),
    /// The mesh cannot be drawn: its data is invalid, or too large for the device.
    #[error("mesh: {0}")]
    Mesh(String),
    /// The frame or its size is invalid, or too large for the device.
    #[error("frame: {0}")]
    Frame(String),
    /// The picture cannot be written.
    #[error("cannot write {path}: {reason}")]
    Write {
        /// Path of the file.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
}
