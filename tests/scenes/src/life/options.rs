use clap::Parser;

/// Lets the giant live in fast forward, with five riders that wander and climb, and tells what it did.
///
/// Exits with 1 if a state was never left, a state or an attack was never seen, or a foot stood off the ground.
#[derive(Parser, Clone, Debug)]
#[command(name = "life", version)]
pub struct LifeOptions {
    /// Minutes of its life.
    #[arg(long, default_value_t = 10.0, value_parser = minutes)]
    pub minutes: f64,

    /// Seed of all lots.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,

    /// The giant's brain [default: assets/colossus.brain.json].
    #[arg(long, value_name = "FILE")]
    pub brain: Option<std::path::PathBuf>,

    /// Print one line for each state that it enters.
    #[arg(long)]
    pub story: bool,
}

impl LifeOptions {
    /// The options in the program's arguments. Ends the program if they are wrong.
    pub fn from_command_line() -> Self {
        Self::parse()
    }
}

fn minutes(text: &str) -> Result<f64, String> {
    let found: f64 = text
        .parse()
        .map_err(|_| "is not a number of minutes".to_owned())?;
    if (0.1..=600.0).contains(&found) {
        Ok(found)
    } else {
        Err("must be from 0.1 to 600".into())
    }
}
