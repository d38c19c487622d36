//! Measures casts and sweeps, compared with parry's ball cast and with additive CCD.
//!
//! Spheres with radii of one and of ten mean edge lengths start near the skin of a walking giant of a million
//! triangles, and move by ten times their radius. parry casts the same balls against a mesh with the same positions;
//! the time to set these positions is not measured. On single triangles the sweeps are compared with additive CCD.
//! Prints a table and writes it to `target/measure/sweep.csv`: name, value, bound, holds. Fails if clamber misses a hit
//! of parry's.
//!
//! Run it with `cargo bench -p clamber_benches --bench sweep`; briefly with `-- --test`.

mod additive;
mod casts;
mod pairs;
mod parry;

/// Tolerance of casts and sweeps, metres.
pub(crate) const TOLERANCE: f64 = 1e-4;

use std::error::Error;
use std::process::ExitCode;

use clamber_scenes::measure::{Bound, Cells, exit_code, is_brief};

use casts::Field;

/// Sizes of a run of the bench.
struct Effort {
    brief: bool,
    vertices: usize,
    casts: usize,
    sheets: usize,
}

/// The full run.
const FULL: Effort = Effort {
    brief: false,
    vertices: 500_000,
    casts: 400,
    sheets: 50,
};

/// The brief run: with `-- --test`, and outside `cargo bench`.
const BRIEF: Effort = Effort {
    brief: true,
    vertices: 3_000,
    casts: 20,
    sheets: 10,
};

fn main() -> ExitCode {
    let effort = if is_brief() { BRIEF } else { FULL };
    exit_code(run(&effort))
}

fn run(effort: &Effort) -> Result<(), Box<dyn Error>> {
    let mut cells = Cells::default();
    let mut field = Field::new(effort.vertices)?;
    for (edges, bound) in [(10.0, Bound::Least(15.0)), (1.0, Bound::Least(1.0))] {
        field.measure(edges, effort.casts, bound, &mut cells)?;
    }
    pairs::measure(effort.sheets, &mut cells)?;
    cells.finish("sweep", effort.brief)
}
