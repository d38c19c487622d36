//! How wrong is what one gets of an animated skin, and how long does it take? Ours and other ways side by side.
//!
//! `queries`: seeded sets of rays, spheres and points, at the walking giant, from the front, grazing, aimed at edges and at
//! vertices, 1.4 km from the origin, and at a ball of slivers. Each answer is held against all triangles in f64, of the
//! positions that f32 skinning gives in model space, moved to where the creature stands: so what a peer loses by world
//! coordinates in f32 counts, and what all lose by skinning does not. Leaks, which pass through the skin or stop short of
//! it by more than a hundredth of the distance, are counted apart, and are no part of the errors. Times are of warm
//! queries, medians of rounds. Fails if ours leaks.
//!
//! `motion`: a sphere that a limb swings into, or that rides on one, kept out of it by the thesis's averaged push-out,
//! sub-steps of it, speculative contacts, and sweeps: how deep it is in the limb at the end of ticks, how often the limb
//! passes through it, how far it drifts from its place on the skin, and what a tick costs, in the mean. The same of
//! whole climbers, which float, stand on ground, or stand on the limb or hold it: how deep the limb is in their core.
//!
//! `skinning`: influences cut to 4, 2 and 1, weights of 16 and 8 bits, positions of 16 bits: the error of a vertex, the
//! time and the bytes.
//!
//! Prints tables and writes them to `target/measure/accuracy_*.csv`, with plots beside them.
//!
//! `cargo bench --manifest-path peers/Cargo.toml --bench accuracy`, with `--features bullet,embree,fcl,physx` for those that are installed;
//! one part with `-- motion`, brief with `-- --test`.

mod motion;
mod queries;
mod skinning;
mod truth;

use std::error::Error;
use std::process::ExitCode;

use clamber_scenes::measure::is_brief;

type Part = fn(bool) -> Result<(), Box<dyn Error>>;

const PARTS: [(&str, Part); 3] = [
    ("queries", queries::run),
    ("motion", motion::run),
    ("skinning", skinning::run),
];

fn main() -> ExitCode {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let asked: Vec<&String> = asked
        .iter()
        .filter(|word| !word.starts_with("--"))
        .collect();
    for (name, run) in PARTS {
        if !asked.is_empty() && asked.iter().all(|word| *word != name) {
            continue;
        }
        if let Err(error) = run(is_brief()) {
            eprintln!("{name}: {error}");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}
