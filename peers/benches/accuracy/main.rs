//! How large is the error of answers on an animated skin, and how long do they take? The bench compares clamber with
//! other methods.
//!
//! `queries`: seeded sets of rays, spheres and points at the walking giant: from the front, grazing, aimed at edges and
//! at vertices, and 1.4 km from the origin; and at a ball of slivers. Each answer is compared with all triangles in
//! f64. The positions of the reference come from f32 skinning in model space, moved to the creature's place in f64. So
//! the error includes the loss of a peer by world coordinates in f32, and excludes the error of skinning, which all
//! have in common. Answers that pass through the skin or stop short of it by more than a hundredth of the query's reach
//! are counted separately, as leaks and false hits, and are not part of the errors. Times are medians of rounds of warm
//! queries. Fails if clamber has a leak or a false hit.
//!
//! `motion`: a limb swings into a sphere, or a sphere rides on a limb. The thesis's averaged push-out, sub-steps of it,
//! speculative contacts, and sweeps keep the sphere out of the limb. The bench measures the sphere's depth in the limb
//! at the end of ticks, how often the limb passes through it, its drift from its place on the skin, and the mean time
//! of a tick. It measures the same for whole climbers, which float, stand on ground, stand on the limb or hold it;
//! their depth is the depth of the limb in their core.
//!
//! `skinning`: influences cut to 4, 2 and 1, weights of 16 and 8 bits, positions of 16 bits. The bench measures the
//! error of a vertex, the time and the bytes.
//!
//! Prints tables and writes them to `target/measure/accuracy_*.csv`, with plots beside them.
//!
//! Run it with `cargo bench --manifest-path peers/Cargo.toml --bench accuracy`, and `--features
//! bullet,embree,fcl,physx` for the installed libraries; one part with `-- motion`, briefly with `-- --test`.

mod motion;
mod queries;
mod skinning;

use std::error::Error;
use std::process::ExitCode;

use clamber_scenes::measure::is_brief;

type Part = fn(bool) -> Result<(), Box<dyn Error>>;

/// The parts of the bench, by name.
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
