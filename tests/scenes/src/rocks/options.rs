use clap::Parser;

/// Rocks, stones and logs fall on the giant, ride on it, and roll off when it shakes.
///
/// Checks six times a second that no rock is inside the giant or under the ground, and at the end that none
/// is more than 2 cm deep in its skin. Prints a table, and exits with 1 if a check failed.
#[derive(Clone, Debug, Parser)]
#[command(name = "rocks", version)]
pub struct RocksOptions {
    /// Number of rocks.
    #[arg(long, default_value_t = 60)]
    pub rocks: usize,

    /// Seconds for which the giant shakes, after eight in which the rocks fall.
    #[arg(long, value_name = "SECONDS", default_value_t = 4.0)]
    pub shake: f64,

    /// Seed for the rocks' sizes and places; the same number gives the same result.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

impl RocksOptions {
    /// Parses the command line. For `--help` or a wrong argument it prints a message and exits.
    pub fn from_command_line() -> Self {
        Self::parse()
    }
}
