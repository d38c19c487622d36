use std::path::PathBuf;

use clap::Parser;

/// Asks the library's sweeps continuous collision queries whose exact answers are known.
///
/// A file has eight rows a query, each a vertex as three fractions and whether the query's motion
/// touches: `x,over,y,over,z,over,0|1`. Its path says of what kind they are: `vertex-face` (the vertex
/// and the face's corners, at the start and then at the end) or `edge-edge` (the ends of one edge and
/// of the other, likewise). Radius and tolerance are each 1e-5 of the extent of a query. Exits with 1
/// if an answer is false, with 2 if a file cannot be read.
#[derive(Clone, Debug, Parser)]
#[command(name = "ccd_queries", version)]
pub struct CcdOptions {
    /// The .csv files.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,

    /// Print one JSON object instead of a table.
    #[arg(long)]
    pub json: bool,
}

impl CcdOptions {
    /// From the command line; prints help or what is wrong with it, and exits.
    pub fn from_command_line() -> Self {
        Self::parse()
    }
}
