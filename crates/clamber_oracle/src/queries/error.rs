use std::path::PathBuf;

use thiserror::Error;

/// Why queries cannot be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum QueryFileError {
    /// A file cannot be read.
    #[error("{}: {source}", .file.display())]
    Read {
        /// Its path.
        file: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
    /// A file's path does not say of what kind its queries are.
    #[error("{}: expected `edge-edge` or `vertex-face` in the path", .file.display())]
    Kind {
        /// Its path.
        file: PathBuf,
    },
    /// A row is no vertex.
    #[error("{}:{line}: {reason}", .file.display())]
    Row {
        /// The file's path.
        file: PathBuf,
        /// Number of the row, from 1.
        line: usize,
        /// What was expected and found.
        reason: RowError,
    },
    /// A file ends within a query.
    #[error("{}: {rows} rows are no whole number of queries of 8", .file.display())]
    Rows {
        /// Its path.
        file: PathBuf,
        /// How many rows it has.
        rows: usize,
    },
}

/// What is wrong with a row.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum RowError {
    /// Not as many columns as a row has.
    #[error("expected 7 columns, found {found}")]
    Columns {
        /// How many it has.
        found: usize,
    },
    /// A column is not an integer.
    #[error("column {column}: expected an integer, found `{found}`")]
    Integer {
        /// From 1.
        column: usize,
        /// What it holds.
        found: String,
    },
    /// A coordinate's second integer is 0.
    #[error("column {column}: a denominator of 0")]
    Denominator {
        /// From 1.
        column: usize,
    },
    /// The last column.
    #[error("column 7: expected 0 or 1, found `{found}`")]
    Label {
        /// What it holds.
        found: String,
    },
    /// The rows of one query differ in the last column.
    #[error("column 7 differs from that of the query's first row")]
    LabelDiffers,
    /// The query is too large or too small for f32.
    #[error("a query of extent {extent:e}, which f32 does not hold: expected 1e-30 to 1e30, or 0")]
    Extent {
        /// The largest side of the box of its points.
        extent: f64,
    },
}
