use std::path::PathBuf;

use clap::Parser;

/// What the import finds in a creature's file, and how the creature fares in motion.
///
/// Loads the file as the library does, poses it at rest and in every clip, and compares skinning
/// with exact arithmetic, every query with brute force, and bounds with what they are to hold. Exits
/// with 1 if one of these fails, with 2 if the file cannot be loaded.
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

    /// Poses of each clip.
    #[arg(long, value_name = "COUNT", default_value_t = 30)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub poses: u32,

    /// Where the queries are: any number; the same one gives the same places.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

impl InspectOptions {
    /// The defaults for a file.
    pub fn of(file: PathBuf) -> Self {
        // Behind `--` a name may begin with a dash.
        Self::parse_from(["inspect".into(), "--".into(), file])
    }

    /// From the command line; prints help or what is wrong with it, and exits.
    pub fn from_command_line() -> Self {
        Self::parse()
    }
}
