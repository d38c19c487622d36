use std::path::PathBuf;

use clap::Parser;

/// Reports what the import finds in a creature's file, and measures the creature in every clip.
///
/// Loads the file as the library does, poses the creature at rest and in every clip, and compares
/// skinning with exact arithmetic, every query with brute force, and bounds with the vertices that they must
/// hold. Exits with 1 if a comparison fails, with 2 if the file cannot be loaded.
#[derive(Clone, Debug, Parser)]
#[command(name = "inspect", version)]
pub struct InspectOptions {
    /// A .glb or .gltf file.
    pub file: PathBuf,

    /// Print one JSON object instead of a table.
    #[arg(long)]
    pub json: bool,

    /// Index of a skin of the creature to inspect [default: the creature with the most triangles].
    #[arg(long, value_name = "INDEX")]
    pub skin: Option<usize>,

    /// Number of poses of each clip.
    #[arg(long, value_name = "COUNT", default_value_t = 30)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub poses: u32,

    /// Seed for the places of the queries; the same number gives the same places.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

impl InspectOptions {
    /// The default options for a file.
    pub fn of(file: PathBuf) -> Self {
        // After `--` a file's name may begin with a dash.
        Self::parse_from(["inspect".into(), "--".into(), file])
    }

    /// Parses the command line. For `--help` or a wrong argument it prints a message and exits.
    pub fn from_command_line() -> Self {
        Self::parse()
    }
}
