use std::path::PathBuf;

use crate::queries::QueryFileError;
use clamber_surface::mesh::MeshError;
use clamber_surface::surface::SurfaceError;
use thiserror::Error;

/// The reason why queries cannot be read or run.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CcdError {
    /// A file cannot be read.
    #[error(transparent)]
    File(#[from] QueryFileError),
    /// The library rejects a query.
    #[error("{}:{line}: {source}", .file.display())]
    Surface {
        /// The file's path.
        file: PathBuf,
        /// Number of the query's first row, from 1.
        line: usize,
        /// The library's reason.
        source: SurfaceError,
    },
    /// The stage's mesh cannot be built.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}
