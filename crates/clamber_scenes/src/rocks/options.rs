use clap::Parser;

/// Rocks, stones and logs fall on the giant, ride on it, and roll off when it shakes.
///
/// Checks six times a second that none is inside the giant or under the ground, and in the end that none
/// is more than 2 cm deep in its skin. Ends with a table, and exits with 1 if a check failed.
#[derive(Clone, Debug, Parser)]
#[command(name = "rocks", version)]
pub struct RocksOptions {
    /// How many.
    #[arg(long, default_value_t = 60)]
    pub rocks: usize,

    /// Seconds that it shakes, after five in which they fall.
    #[arg(long, value_name = "SECONDS", default_value_t = 4.0)]
    pub shake: f64,

    /// Which rocks, and where they fall: any number; the same one gives the same end.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

impl RocksOptions {
    /// From the command line; prints help or what is wrong with it, and exits.
    pub fn from_command_line() -> Self {
        Self::parse()
    }
}
