use std::path::PathBuf;

use clap::Parser;

/// Tests the library's sweeps with continuous collision queries whose exact answers are known.
///
/// A file has eight rows for each query. A row is a vertex as three fractions, and whether the query's motion touches:
/// `x,over,y,over,z,over,0|1`. The file's path contains the kind of its queries: `vertex-face` (the vertex and the
/// face's corners, at the start and then at the end) or `edge-edge` (the ends of one edge and of the other, likewise).
/// Radius and tolerance are each 1e-5 of a query's extent. Exits with 1 if an answer is wrong or cannot be proved, with
/// 2 if a file cannot be read.
#[derive(Clone, Debug, Parser)]
#[command(name = "ccd_queries", version)]
pub struct CcdOptions {
    /// Query files (.csv).
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,

    /// Print one JSON object instead of a table.
    #[arg(long)]
    pub json: bool,
}
