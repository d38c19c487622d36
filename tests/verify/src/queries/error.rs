use std::path::PathBuf;

use thiserror::Error;

/// An error from reading queries.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum QueryFileError {
    /// A file cannot be read.
    #[error("{}: {source}", .file.display())]
    Read {
        /// Path of the file.
        file: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// The path of a file does not contain the kind of its queries.
    #[error("{}: expected `edge-edge` or `vertex-face` in the path", .file.display())]
    Kind {
        /// Path of the file.
        file: PathBuf,
    },
    /// A row, or the query that begins with it, is not valid.
    #[error("{}:{line}: {reason}", .file.display())]
    Row {
        /// Path of the file.
        file: PathBuf,
        /// Number of the row, from 1.
        line: usize,
        /// The expected and the found content.
        reason: RowError,
    },
    /// A file ends within a query.
    #[error("{}: {rows} rows, not a multiple of the 8 rows of a query", .file.display())]
    Rows {
        /// Path of the file.
        file: PathBuf,
        /// Number of rows in the file.
        rows: usize,
    },
}

/// Why a row is not valid.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum RowError {
    /// The row does not have 7 columns.
    #[error("expected 7 columns, found {found}")]
    Columns {
        /// Number of columns in the row.
        found: usize,
    },
    /// A column is not an integer.
    #[error("column {column}: expected an integer, found `{found}`")]
    Integer {
        /// Number of the column, from 1.
        column: usize,
        /// Text of the column.
        found: String,
    },
    /// The denominator of a coordinate is 0.
    #[error("column {column}: a denominator of 0")]
    Denominator {
        /// Number of the column, from 1.
        column: usize,
    },
    /// The last column is neither 0 nor 1.
    #[error("column 7: expected 0 or 1, found `{found}`")]
    Label {
        /// Text of the column.
        found: String,
    },
    /// The rows of one query differ in the last column.
    #[error("column 7 differs from column 7 of the query's first row")]
    LabelDiffers,
    /// The query is too large or too small for f32.
    #[error("a query of extent {extent:e} does not fit f32: expected 1e-30 to 1e30, or 0")]
    Extent {
        /// The largest side of the bounding box of its points.
        extent: f64,
    },
}
